// Sums over a group of kMeanShiftGroup invocations, all of which call it.

shared vec4 partial[kMeanShiftGroup];

vec4 sum_of_group(vec4 own) {
    const uint lane = gl_LocalInvocationIndex;
    partial[lane] = own;
    barrier();
    for (uint reach = kMeanShiftGroup / 2u; reach > 0u; reach /= 2u) {
        if (lane < reach) partial[lane] += partial[lane + reach];
        barrier();
    }
    const vec4 sum = partial[0];
    barrier();
    return sum;
}
