#version 300 es
// A lamp's mark in the HTML viewer: a bright disc with a dark rim.
precision highp float;

out vec4 pixel;

void main() {
    float radius = length(gl_PointCoord - 0.5);
    if (radius > 0.5) discard;
    pixel = radius > 0.38 ? vec4(0.15, 0.15, 0.15, 1.0) : vec4(1.0, 0.85, 0.3, 1.0);
}
