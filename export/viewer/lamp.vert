#version 300 es
// A lamp's mark in the HTML viewer.
layout(location = 0) in vec3 world_m;

uniform mat4 clip_from_world;
uniform float size_px;

void main() {
    gl_Position = clip_from_world * vec4(world_m, 1.0);
    gl_PointSize = size_px;
}
