#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Adds up the groups' normal equations, and moves the pose by their solution. One workgroup; every sum has a fixed
// shape. Jacobi's rotations give eigenvalues and eigenvectors of the 6 x 6 matrix; along those that the surface does
// not resist, the pose stays as it was predicted (Zhang, Kaess and Singh 2016).
#include "shared/tracking/tracking.h"

layout(local_size_x = kSolveMotionGroup) in;
layout(std430, binding = 0) readonly buffer Sums { float sums[]; };  // kTrackSums per group
layout(std430, binding = 1) buffer State { TrackState state; };
layout(push_constant) uniform Push { SolveMotionParams params; };

// Four sweeps of five; each sweep squares what is left beside the diagonal, once that is small.
const uint kRounds = 20u;
const uint kLast = kRounds & 1u;

shared float total[kTrackSums];
shared float matrix[2][6][6];   // before and after a round; in the end [kLast], whose diagonal holds the eigenvalues
shared float vectors[2][6][6];  // column i of [kLast] belongs to eigenvalue i
shared float motion[6];         // metres along x, y, z; radians around them, times the lever

// Where the upper triangle keeps row i, column j >= i.
uint entry_of(uint i, uint j) { return kTrackMatrix + i * (11u - i) / 2u + j; }

void add_up_groups() {
    const uint lane = gl_LocalInvocationIndex;
    if (lane < kTrackSums) {
        float sum = 0.0;
        for (uint group = 0u; group < params.groups; ++group) sum += sums[group * kTrackSums + lane];
        total[lane] = sum;
    }
    barrier();
}

// With which row and column each is rotated: in five rounds, three pairs each, every one meets every other.
uint partner_of(uint i, uint round_of_five) {
    return i == 5u ? round_of_five : i == round_of_five ? 5u : (2u * round_of_five + 5u - i) % 5u;
}

// The shares of its own and of its partner's column that become column i, by the rotation that makes their common entry
// zero.
vec2 shares_of(uint now, uint i, uint partner) {
    const uint p = min(i, partner), q = max(i, partner);
    const float beside = matrix[now][p][q];
    const float theta = (matrix[now][q][q] - matrix[now][p][p]) / (beside == 0.0 ? 1.0 : 2.0 * beside);
    const float t = (theta < 0.0 ? -1.0 : 1.0) / (abs(theta) + sqrt(theta * theta + 1.0));
    const float c = inversesqrt(t * t + 1.0);
    return beside == 0.0 ? vec2(1.0, 0.0) : vec2(c, i == p ? -t * c : t * c);
}

void rotate(uint now, uint i, uint j, uint round_of_five) {
    const uint pi = partner_of(i, round_of_five), pj = partner_of(j, round_of_five);
    const vec2 si = shares_of(now, i, pi), sj = shares_of(now, j, pj);
    const float own = sj.x * matrix[now][i][j] + sj.y * matrix[now][i][pj];
    const float other = sj.x * matrix[now][pi][j] + sj.y * matrix[now][pi][pj];
    matrix[1u - now][i][j] = si.x * own + si.y * other;
    vectors[1u - now][i][j] = sj.x * vectors[now][i][j] + sj.y * vectors[now][i][pj];
}

void find_eigenvectors() {
    const uint k = gl_LocalInvocationIndex, i = k / 6u, j = k % 6u;
    if (k < 36u) {
        matrix[0][i][j] = total[entry_of(min(i, j), max(i, j))] / total[kTrackWeight];
        vectors[0][i][j] = i == j ? 1.0 : 0.0;
    }
    barrier();
    for (uint round = 0u; round < kRounds; ++round) {
        if (k < 36u) rotate(round & 1u, i, j, round % 5u);
        barrier();
    }
}

// Along each eigenvector by its share of the right side over its eigenvalue. Returns how many were held.
uint solve() {
    uint held = 0u;
    for (uint i = 0u; i < 6u; ++i) motion[i] = 0.0;
    for (uint e = 0u; e < 6u; ++e) {
        float along = 0.0;
        for (uint i = 0u; i < 6u; ++i) along += vectors[kLast][i][e] * total[kTrackRight + i];
        const bool resisted = matrix[kLast][e][e] >= params.held_share;
        held += resisted ? 0u : 1u;
        const float step = resisted ? -along / (total[kTrackWeight] * matrix[kLast][e][e]) : 0.0;
        for (uint i = 0u; i < 6u; ++i) motion[i] += step * vectors[kLast][i][e];
    }
    return held;
}

void tell_eigenvalues() {
    float sorted[6];
    [[unroll]] for (uint i = 0u; i < 6u; ++i) sorted[i] = matrix[kLast][i][i];
    [[unroll]] for (uint pass = 0u; pass < 5u; ++pass) {
        [[unroll]] for (uint i = 0u; i < 5u; ++i) {
            const float low = min(sorted[i], sorted[i + 1u]), high = max(sorted[i], sorted[i + 1u]);
            sorted[i] = low;
            sorted[i + 1u] = high;
        }
    }
    state.eigenvalues_low = vec4(sorted[0], sorted[1], sorted[2], sorted[3]);
    state.eigenvalues_high = vec2(sorted[4], sorted[5]);
}

vec4 product(vec4 a, vec4 b) {
    return vec4(a.w * b.xyz + b.w * a.xyz + cross(a.xyz, b.xyz), a.w * b.w - dot(a.xyz, b.xyz));
}
vec3 turned(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }

void move_pose() {
    const vec3 along = vec3(motion[0], motion[1], motion[2]);
    const vec3 around = vec3(motion[3], motion[4], motion[5]) / state.lever_m;
    const float angle = length(around);
    const vec4 turn = vec4(angle > 1e-12 ? around * (sin(0.5 * angle) / angle) : vec3(0.0), cos(0.5 * angle));
    const vec3 center = vec3(0.0, 0.0, state.center_m);
    const vec3 moved = center + along + turned(turn, state.translation_m.xyz - center);
    state.step_m = length(moved - state.translation_m.xyz);
    state.step_rad = angle;
    state.translation_m = vec4(moved, 0.0);
    state.rotation = normalize(product(turn, state.rotation));
}

void tell_sums() {
    const float readings = max(total[kTrackReadings], 1.0), pairs = max(total[kTrackPairs], 1e-6);
    state.readings = total[kTrackReadings];
    state.pairs = total[kTrackPairs];
    state.sigmas = sqrt(total[kTrackSquares] / pairs);
    state.mean_depth_m = total[kTrackDepth] / readings;
    state.shades = total[kTrackShades];
    state.shade_error = sqrt(total[kTrackShadeSquares] / max(total[kTrackShades], 1e-6));
}

void main() {
    add_up_groups();
    const bool enough = total[kTrackPairs] >= params.least_readings;
    if (enough) find_eigenvectors();
    if (gl_LocalInvocationIndex != 0u) return;
    tell_sums();
    if (!enough) {
        state.solutions = 0.0;
        return;
    }
    state.held = float(solve());
    state.solutions += 1.0;
    tell_eigenvalues();
    move_pose();
    if (total[kTrackShades] >= params.least_readings)
        state.gain = total[kTrackShadeProduct] / max(total[kTrackShadeOwn], 1e-6);
}
