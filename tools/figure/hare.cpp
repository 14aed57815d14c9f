#include "tools/figure/hare.h"

#include <cmath>

#include "tools/figure/distance.h"
#include "tools/figure/polygonise.h"

namespace patina::figure {
namespace {

/// The same place on the figure's right side (x > 0): most of it is symmetric. Not rounded at x = 0, where only solids
/// whose surface crosses the plane at right angles lie.
glm::dvec3 mirrored(glm::dvec3 p) { return {std::abs(p.x), p.y, p.z}; }

double torso(glm::dvec3 p) {
    const double rump = ellipsoid(p, {0, 0.30, -0.12}, {0.32, 0.30, 0.36});
    const double chest = ellipsoid(p, {0, 0.60, 0.05}, {0.215, 0.31, 0.20});
    const double tail = sphere(p, {0, 0.22, -0.52}, 0.115);
    return join(join(rump, chest, 0.18), tail, 0.04);
}

double hind_leg(glm::dvec3 q) {
    const double thigh = ellipsoid(q, {0.25, 0.23, 0.05}, {0.135, 0.215, 0.25});
    const double foot = ellipsoid(q, {0.27, 0.062, 0.29}, {0.088, 0.062, 0.20});
    return join(thigh, foot, 0.05);
}

double front_leg(glm::dvec3 q) {
    const double leg = rod(q, {0.115, 0.52, 0.17}, {0.10, 0.10, 0.30}, 0.082, 0.058);
    const double paw = ellipsoid(q, {0.10, 0.055, 0.34}, {0.07, 0.055, 0.10});
    return join(leg, paw, 0.05);
}

double head(glm::dvec3 p) {
    const glm::dvec3 q = mirrored(p);
    double solid = ellipsoid(p, {0, 1.005, 0.13}, {0.165, 0.16, 0.185});
    solid = join(solid, sphere(q, {0.075, 0.945, 0.21}, 0.085), 0.06);                  // cheeks
    solid = join(solid, ellipsoid(p, {0, 0.955, 0.285}, {0.075, 0.06, 0.075}), 0.05);   // muzzle
    solid = join(solid, ellipsoid(p, {0, 0.985, 0.343}, {0.034, 0.026, 0.026}), 0.02);  // nose
    solid = join(solid, sphere(q, {0.108, 1.045, 0.232}, 0.046), 0.025);                // eyes
    return solid;
}

/// A leaf between two points, hollowed towards +z.
double leaf(glm::dvec3 p, glm::dvec3 low, glm::dvec3 high, double width, double thickness) {
    const glm::dvec3 up = glm::normalize(high - low);
    const glm::dvec3 side = glm::normalize(glm::cross(up, glm::dvec3(0, 0, 1)));
    const glm::dvec3 front = glm::cross(side, up);
    const glm::dvec3 from_middle = p - (low + high) / 2.0;
    const glm::dvec3 local(glm::dot(from_middle, side), glm::dot(from_middle, up), glm::dot(from_middle, front));
    const double length = glm::distance(low, high) / 2;
    const double solid = ellipsoid(local, glm::dvec3(0), {width, length, thickness});
    const double hollow = ellipsoid(local, {0, -0.01, thickness}, {0.6 * width, 0.75 * length, 0.75 * thickness});
    return carve(solid, hollow, 0.035);
}

double ears(glm::dvec3 p) {
    const double straight = leaf(p, {0.065, 1.06, 0.08}, {0.17, 1.56, -0.02}, 0.08, 0.045);
    const double lower = leaf(p, {-0.065, 1.06, 0.08}, {-0.17, 1.42, 0.02}, 0.08, 0.045);
    const double tip = ellipsoid(p, {-0.235, 1.33, 0.045}, {0.062, 0.115, 0.036});
    return std::min(straight, join(lower, tip, 0.05));
}

double scarf(glm::dvec3 p) {
    const glm::dvec3 axis = glm::normalize(glm::dvec3(0.05, 1, 0.22));
    const double ring = torus(p, {0, 0.835, 0.085}, axis, 0.15, 0.052);
    const double end = rod(p, {0.09, 0.80, 0.22}, {0.13, 0.56, 0.255}, 0.042, 0.05);
    return join(ring, end, 0.035);
}

}  // namespace

double hare(glm::dvec3 p) {
    const glm::dvec3 q = mirrored(p);
    double solid = join(torso(p), hind_leg(q), 0.035);
    solid = join(solid, front_leg(q), 0.04);
    solid = join(solid, join(head(p), ears(p), 0.04), 0.06);
    return join(solid, scarf(p), 0.04);
}

scenes::TriangleMesh make_hare() {
    constexpr glm::dvec3 kLow(-0.56, -0.04, -0.72), kHigh(0.56, 1.64, 0.62);  // around it with some air
    constexpr double kCell = 0.0215;                                          // about 20 000 triangles
    return polygonise(hare, kLow, kHigh, kCell);
}

}  // namespace patina::figure
