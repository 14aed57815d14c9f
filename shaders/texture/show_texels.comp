#version 460
#extension GL_GOOGLE_include_directive : require
// A view in which surface that pictures show reflects with the albedo that they tell. One invocation per pixel.

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const bool kPictured = false;             // under the light that the pictures were taken under
layout(binding = 0, rgba16f) uniform readonly image2D seen;       // diffuse, or albedo; a: 0 where no picture shows it
layout(binding = 1, rgba16f) uniform readonly image2D elsewhere;  // what is shown there
layout(binding = 2, rgba16f) uniform readonly image2D rgb;        // picture_kd x light, and highlights
layout(binding = 3, rgba16f) uniform readonly image2D picture_kd;
layout(binding = 4, rgba16f) uniform readonly image2D light;
layout(binding = 5, rgba16f) uniform writeonly image2D shown_rgb;

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(shown_rgb)))) return;
    const vec4 own = imageLoad(seen, pixel);
    const vec3 shine = imageLoad(light, pixel).rgb;
    const vec3 highlight = max(imageLoad(rgb, pixel).rgb - imageLoad(picture_kd, pixel).rgb * shine, 0.0);
    const vec3 diffuse = kPictured ? own.rgb : own.rgb * shine;
    imageStore(shown_rgb, pixel,
               own.a > 0.0 ? vec4(max(diffuse + highlight, 0.0), 1.0)
               : kPictured ? imageLoad(elsewhere, pixel)
                           : imageLoad(rgb, pixel));
}
