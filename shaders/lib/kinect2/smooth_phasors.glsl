#ifndef PATINA_LIB_KINECT2_SMOOTH_PHASORS_GLSL
#define PATINA_LIB_KINECT2_SMOOTH_PHASORS_GLSL
#extension GL_EXT_control_flow_attributes : require

// A joint bilateral filter over 3 x 3 pixels for the phasors of three frequencies: each frequency's neighbours weigh by
// a Gaussian and by how well their phase agrees with the centre's.

const float kGauss[3] = {0.1195716, 0.1131098, 0.1069973};  // centre, side, corner

// The three frequencies' phasors at one pixel.
struct Phasors {
    vec3 along, across;
    vec3 square;   // of the lengths
    vec3 inverse;  // of the lengths; 0 where a length is 0
};

struct PhasorRow {
    Phasors columns[3];
};

struct Smoothed {
    vec3 along, across;
    vec3 distances;  // half of 1 - cosine of the angles to the neighbours, summed
};

Phasors make_phasors(vec3 along, vec3 across) {
    Phasors p;
    p.along = along;
    p.across = across;
    p.square = along * along + across * across;
    p.inverse = mix(vec3(0.0), inversesqrt(p.square), greaterThan(p.square, vec3(0.0)));
    return p;
}

// A neighbour at the distance d in phase weighs exp2(exponent * d) times the Gaussian; one whose squared length is
// below min_square does not weigh. A pixel that is dark itself takes what is around it, whatever its phase.
Smoothed smooth_phasors(PhasorRow rows[3], float exponent, float min_square) {
    const Phasors center = rows[1].columns[1];
    const bvec3 bright = greaterThanEqual(center.square, vec3(min_square));
    const vec3 own_exponent = mix(vec3(0.0), vec3(exponent), bright);
    const vec3 own_min_square = mix(vec3(0.0), vec3(min_square), bright);
    Smoothed sums = Smoothed(kGauss[0] * center.along, kGauss[0] * center.across, vec3(0.0));
    vec3 weights = vec3(kGauss[0]);
    [[unroll]] for (int y = 0; y < 3; ++y) {
        [[unroll]] for (int x = 0; x < 3; ++x) {
            if (x == 1 && y == 1) continue;
            const Phasors near = rows[y].columns[x];
            const vec3 projection = center.along * near.along + center.across * near.across;
            const vec3 inverse = center.inverse * near.inverse;
            // Where a length is 0 there is no angle; it counts as 0.
            const vec3 apart = mix(vec3(0.0), 0.5 - 0.5 * projection * inverse, greaterThan(inverse, vec3(0.0)));
            const vec3 counts = vec3(greaterThanEqual(near.square, own_min_square));
            const vec3 weight = counts * kGauss[abs(x - 1) + abs(y - 1)] * exp2(own_exponent * apart);
            sums.distances += counts * apart;
            sums.along += weight * near.along;
            sums.across += weight * near.across;
            weights += weight;
        }
    }
    sums.along /= weights;
    sums.across /= weights;
    return sums;
}

#endif
