#version 300 es
// A quantised vertex (ViewerVertex) of the HTML viewer.
layout(location = 0) in vec3 at;           // 0 to 1 between the corners of the box
layout(location = 1) in uint material_in;  // row of `materials`
layout(location = 2) in vec2 octahedral;
layout(location = 3) in uvec2 look;  // place in the page, or colour

uniform mat4 clip_from_world;
uniform vec3 low_m, size_m;  // the box
uniform bool has_page;

out vec3 world_m, normal, color;
out vec2 place;
flat out int material;

vec3 linear_color(vec3 code) {
    return mix(code / 12.92, pow((code + 0.055) / 1.055, vec3(2.4)), greaterThan(code, vec3(0.04045)));
}

void main() {
    world_m = low_m + at * size_m;
    normal = vec3(octahedral, 1.0 - abs(octahedral.x) - abs(octahedral.y));
    if (normal.z < 0.0) {
        vec2 folded = 1.0 - abs(normal.yx);
        normal.xy = vec2(normal.x < 0.0 ? -folded.x : folded.x, normal.y < 0.0 ? -folded.y : folded.y);
    }
    place = vec2(look) / 65535.0;
    color = has_page ? vec3(0.0) : linear_color(vec3(look.x >> 8u, look.x & 255u, look.y >> 8u) / 255.0);
    material = int(material_in);
    gl_Position = clip_from_world * vec4(world_m, 1.0);
}
