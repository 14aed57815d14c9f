// Normally distributed random numbers. Functions without bindings.
#ifndef PATINA_LIB_GAUSSIAN_GLSL
#define PATINA_LIB_GAUSSIAN_GLSL

// Two independent values of the standard normal distribution from two uniform in [0, 1) (Box and Muller, 1958). Of
// multiples of 2^-24, as lib/math/random.glsl gives them, none comes to more than 5.77.
vec2 gaussians(vec2 uniform_numbers) {
    const float radius = sqrt(-2.0 * log(1.0 - uniform_numbers.x));
    const float angle = 6.28318530717959 * uniform_numbers.y;
    return radius * vec2(cos(angle), sin(angle));
}

#endif
