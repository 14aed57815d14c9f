#include "scenes/description/draws.h"

#include <cmath>

namespace patina::scenes {
namespace {

/// The finaliser of SplitMix64 (Steele, Lea, Flood 2014).
uint64_t mixed(uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

constexpr uint64_t kGolden = 0x9e3779b97f4a7c15u;

}  // namespace

Draws::Draws(uint64_t seed, std::string_view subject, uint64_t index) : key_(mixed(seed + kGolden)) {
    for (const char c : subject) key_ = mixed(key_ ^ static_cast<uint8_t>(c));
    key_ = mixed(key_ ^ mixed(index + kGolden));
}

uint64_t Draws::next() { return mixed(key_ + ++count_ * kGolden); }

double Draws::between(double low, double high) {
    return low + (high - low) * (static_cast<double>(next() >> 11) * 0x1p-53);
}

double Draws::factor(double most) { return std::exp(between(-std::log(most), std::log(most))); }

size_t Draws::below(size_t count) { return next() % count; }

glm::dvec3 Draws::in_ball() {
    for (;;) {
        const double x = between(-1, 1), y = between(-1, 1), z = between(-1, 1);  // in this order
        if (const glm::dvec3 p(x, y, z); glm::dot(p, p) <= 1) return p;
    }
}

}  // namespace patina::scenes
