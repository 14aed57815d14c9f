// Parts that the shaders of layers have in common: where there is surface, and how it stands out from what lies beside
// it. The includer declares DrawLayerParams params, and the images position_m, normal and picture.

const vec3 kNoSurface = vec3(0.11, 0.11, 0.12);  // encoded for sRGB, as all pictures are
const vec3 kNoValue = vec3(0.22);                // of surface whose value is not known

// How bright a surface is drawn that is seen along `view`, where colours alone would make it flat.
float relief(vec3 direction, vec3 view) {
    const float facing = direction == vec3(0.0) ? 1.0 : abs(dot(direction, normalize(view)));
    return mix(1.0, facing, params.camera_m.w);
}

void draw(ivec2 pixel, vec4 point, vec3 direction, vec3 encoded) {
    const vec3 shaded = encoded * relief(direction, point.xyz - params.camera_m.xyz);
    imageStore(picture, pixel, vec4(point.w > 0.0 ? shaded : kNoSurface, 1.0));
}
