// Directions as points of a square: the octahedron's eight faces unfolded (Meyer et al. 2010, "On floating-point
// normal vectors"). Functions without bindings.
#ifndef PATINA_LIB_OCTAHEDRAL_GLSL
#define PATINA_LIB_OCTAHEDRAL_GLSL

vec2 fold(vec2 point) { return (1.0 - abs(point.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(point, vec2(0.0))); }

// A direction of any length but 0 to [-1, 1]^2.
vec2 to_octahedral(vec3 direction) {
    const vec3 d = direction / (abs(direction.x) + abs(direction.y) + abs(direction.z));
    return d.z >= 0.0 ? d.xy : fold(d.xy);
}

// Its inverse, of unit length.
vec3 from_octahedral(vec2 point) {
    const float z = 1.0 - abs(point.x) - abs(point.y);
    const float folded = max(-z, 0.0);
    return normalize(
        vec3(point.x - (point.x >= 0.0 ? folded : -folded), point.y - (point.y >= 0.0 ? folded : -folded), z));
}

// Where a direction lies in a map of edge x edge texels, row by row.
uint octahedral_texel(vec3 direction, uint edge) {
    const vec2 at = (to_octahedral(direction) * 0.5 + 0.5) * float(edge);
    const uvec2 texel = min(uvec2(max(at, 0.0)), uvec2(edge - 1u));
    return texel.y * edge + texel.x;
}

#endif
