#include "reconstruction/lights/find_windows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <glm/gtc/constants.hpp>

#include "engine/core/luminance.h"
#include "reconstruction/far_field.h"

namespace patina {
namespace {

constexpr double kCell_m = double{gpu::kSurroundingsCellM};
constexpr int kKeyCells = 1024;  // along each axis, after which keys begin anew
constexpr double kLeastArea_m2 = 0.02, kLeastSide_m = 0.1;
constexpr double kLeastFilled = 0.6;       // of the rectangle
constexpr double kMostDepth = 0.5;         // of its shorter side: how far its cells lie before and behind its plane
constexpr double kLeastClipped = 0.1;      // of its cells
constexpr double kNear_m = 2;              // surfaces that tell which side is inside
constexpr double kInPlane_m = kCell_m;     // nearer to a window's plane on average, surfaces tell no side
constexpr double kBesideLamp_m = kCell_m;  // and its radius: what shines there is the lamp
constexpr size_t kMostWindows = 64;
constexpr int kTurnSteps = 90;  // of a right angle
constexpr int kPowerSteps = 32;

using Place = std::array<int, 3>;  // of a cell, which also orders them

struct Cell {
    glm::dvec3 middle_m;
    glm::dvec3 radiance;
    bool clipped, low;  // `low`: low exposure shows it
};
using Cells = std::map<Place, Cell>;  // so that their order in the table does not matter

/// The one of a key's places that is nearest to another.
Place place_near(uint32_t key, glm::dvec3 near_m) {
    Place place{};
    for (int axis = 0; axis < 3; ++axis) {
        const int low = static_cast<int>(key >> (10 * axis) & 1023u);
        place[static_cast<size_t>(axis)] =
            low + kKeyCells * static_cast<int>(std::lround((near_m[axis] / kCell_m - low) / kKeyCells));
    }
    return place;
}

glm::dvec3 middle_of(const Place& place) { return kCell_m * (glm::dvec3(place[0], place[1], place[2]) + 0.5); }

bool is_clipped(const gpu::SurroundingsLight& light, glm::dvec3 radiance) {
    return light.low.samples == 0 && std::max({radiance.r, radiance.g, radiance.b}) > double{gpu::kNearlyClipped};
}

/// Of all that touch one of them, by side, edge or corner; they leave `openings`.
std::vector<Cell> take_touching(Cells& openings) {
    std::vector<Cell> taken;
    std::vector<Place> next{openings.begin()->first};
    while (!next.empty()) {
        const Place at = next.back();
        next.pop_back();
        const auto found = openings.find(at);
        if (found == openings.end()) continue;
        taken.push_back(found->second);
        openings.erase(found);
        for (int around = 0; around < 27; ++around)
            next.push_back({at[0] + around % 3 - 1, at[1] + around / 3 % 3 - 1, at[2] + around / 9 - 1});
    }
    return taken;
}

glm::dvec3 mean_place(std::span<const Cell> openings) {
    glm::dvec3 sum(0);
    for (const Cell& opening : openings) sum += opening.middle_m;
    return sum / static_cast<double>(openings.size());
}

/// Of the plane through their middle that they lie nearest to: the eigenvector of their scatter with the least
/// eigenvalue, by power iteration on what is left of its trace.
glm::dvec3 normal_through(std::span<const Cell> openings, glm::dvec3 middle_m) {
    glm::dmat3 scatter(0);
    for (const Cell& opening : openings) {
        const glm::dvec3 off_m = opening.middle_m - middle_m;
        scatter += glm::outerProduct(off_m, off_m);
    }
    const glm::dmat3 rest = (scatter[0][0] + scatter[1][1] + scatter[2][2]) * glm::dmat3(1) - scatter;
    glm::dmat3 power = rest;
    for (int step = 0; step < kPowerSteps; ++step) {
        power = power * power;
        const double size = std::max({glm::length(power[0]), glm::length(power[1]), glm::length(power[2])});
        if (!(size > 0)) return {0, 0, 1};
        power /= size;
    }
    const std::array columns{power[0], power[1], power[2]};
    return glm::normalize(
        *std::ranges::max_element(columns, {}, [](glm::dvec3 column) { return glm::length(column); }));
}

struct Rectangle {
    glm::dvec3 u, v;         // unit length
    glm::dvec2 low, high;    // of the cells' middles along these, from their mean
    double area_m2 = 1e300;  // of the middles' box
};

Rectangle box_along(std::span<const Cell> openings, glm::dvec3 middle_m, glm::dvec3 u, glm::dvec3 v) {
    Rectangle box{u, v, glm::dvec2(0), glm::dvec2(0)};
    for (const Cell& opening : openings) {
        const glm::dvec3 off_m = opening.middle_m - middle_m;
        const glm::dvec2 at(glm::dot(off_m, u), glm::dot(off_m, v));
        box.low = glm::min(box.low, at);
        box.high = glm::max(box.high, at);
    }
    box.area_m2 = (box.high.x - box.low.x) * (box.high.y - box.low.y);
    return box;
}

/// The smallest box in the plane.
Rectangle smallest_box(std::span<const Cell> openings, glm::dvec3 middle_m, glm::dvec3 normal) {
    const glm::dvec3 aside = std::abs(normal.x) < 0.8 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 a = glm::normalize(glm::cross(aside, normal)), b = glm::cross(normal, a);
    Rectangle smallest{};
    for (int step = 0; step < kTurnSteps; ++step) {
        const double angle = glm::half_pi<double>() * step / kTurnSteps;
        const glm::dvec3 u = std::cos(angle) * a + std::sin(angle) * b;
        const Rectangle box = box_along(openings, middle_m, u, glm::cross(normal, u));
        if (box.area_m2 < smallest.area_m2) smallest = box;
    }
    return smallest;
}

/// How much of a box its cells fill, seen along its normal, 0 to 1.
double filled_share(std::span<const Cell> openings, glm::dvec3 middle_m, const Rectangle& box) {
    const glm::dvec2 size_m = box.high - box.low + kCell_m;
    const glm::ivec2 squares = glm::max(glm::ivec2(glm::round(size_m / kCell_m)), 1);
    std::set<std::pair<int, int>> filled;
    for (const Cell& opening : openings) {
        const glm::dvec3 off_m = opening.middle_m - middle_m;
        const glm::dvec2 at = glm::dvec2(glm::dot(off_m, box.u), glm::dot(off_m, box.v)) - box.low + kCell_m / 2;
        const glm::ivec2 square = glm::min(glm::ivec2(at / size_m * glm::dvec2(squares)), squares - 1);
        filled.emplace(square.x, square.y);
    }
    return static_cast<double>(filled.size()) / (static_cast<double>(squares.x) * squares.y);
}

double depth_of(std::span<const Cell> openings, glm::dvec3 middle_m, glm::dvec3 normal) {
    double squares = 0;
    for (const Cell& opening : openings) {
        const double off_m = glm::dot(opening.middle_m - middle_m, normal);
        squares += off_m * off_m;
    }
    return 2 * std::sqrt(squares / static_cast<double>(openings.size()));
}

/// Which way is inside, along a window's normal.
glm::dvec3 inwards(glm::dvec3 normal, glm::dvec3 middle_m, const Cells& surface, glm::dvec3 inside_m) {
    double before_m = 0;
    size_t count = 0;
    for (const auto& [place, cell] : surface) {
        const glm::dvec3 off_m = cell.middle_m - middle_m;
        if (glm::dot(off_m, off_m) > kNear_m * kNear_m) continue;
        before_m += glm::dot(off_m, normal);
        ++count;
    }
    const bool told = std::abs(before_m) > kInPlane_m * static_cast<double>(count);
    return (told ? before_m : glm::dot(inside_m - middle_m, normal)) < 0 ? -normal : normal;
}

/// Their rectangle; nothing where they fill none.
std::optional<AreaLight> window_of(std::span<const Cell> openings, const Cells& surface, glm::dvec3 inside_m) {
    const glm::dvec3 middle_m = mean_place(openings);
    const glm::dvec3 normal = inwards(normal_through(openings, middle_m), middle_m, surface, inside_m);
    const Rectangle box = smallest_box(openings, middle_m, normal);
    const glm::dvec2 size_m = box.high - box.low + kCell_m / 2;  // on average a border lies in the middle of a cell
    const double side_m = std::min(size_m.x, size_m.y);
    if (size_m.x * size_m.y < kLeastArea_m2 || side_m < kLeastSide_m ||
        filled_share(openings, middle_m, box) < kLeastFilled ||
        depth_of(openings, middle_m, normal) > kMostDepth * side_m)
        return std::nullopt;
    const glm::dvec2 middle = (box.low + box.high) / 2.0;
    AreaLight window{.center_m = middle_m + middle.x * box.u + middle.y * box.v,
                     .half_u_m = size_m.x / 2 * box.u,
                     .half_v_m = size_m.y / 2 * box.v};
    const auto count = static_cast<double>(openings.size());
    double clipped = 0;
    for (const Cell& opening : openings) {
        window.radiance += opening.radiance / count;
        clipped += opening.clipped ? 1 / count : 0;
    }
    window.clipped = clipped > kLeastClipped;
    return window;
}

double area_of(const AreaLight& window) { return 4 * glm::length(glm::cross(window.half_u_m, window.half_v_m)); }

bool is_lamp(const Cell& cell, std::span<const Light> lamps) {
    return std::ranges::any_of(lamps, [&](const Light& lamp) {
        return glm::distance(cell.middle_m, lamp.position_m) < lamp.radius_m + kBesideLamp_m;
    });
}

}  // namespace

std::vector<AreaLight> find_windows(std::span<const gpu::SurroundingsCell> cells, glm::dvec3 inside_m,
                                    std::span<const Light> lamps) {
    Cells surface, openings;
    for (const gpu::SurroundingsCell& cell : cells) {
        const glm::vec4 radiance = cell.key == 0 ? glm::vec4(0) : mean_radiance(cell.light);
        if (radiance.a == 0) continue;
        const Place place = place_near(cell.key, inside_m);
        const bool opens = 2 * cell.openings > cell.light.usual.samples + cell.light.low.samples;
        (opens ? openings : surface)
            .emplace(place, Cell{middle_of(place), glm::dvec3(radiance), is_clipped(cell.light, glm::dvec3(radiance)),
                                 cell.light.low.samples > 0});
    }
    if (surface.empty()) return {};
    double usual = 0;
    for (const auto& [place, cell] : surface) usual += luminance(cell.radiance) / static_cast<double>(surface.size());
    // Other gaps in the depth are dark or shiny surfaces that gave no reading.
    std::erase_if(openings, [&](const auto& entry) {
        const Cell& cell = entry.second;
        return luminance(cell.radiance) < usual || !(cell.low || cell.clipped) || is_lamp(cell, lamps);
    });
    std::vector<AreaLight> windows;
    while (!openings.empty()) {
        const auto window = window_of(take_touching(openings), surface, inside_m);
        if (window) windows.push_back(*window);
    }
    std::ranges::stable_sort(windows, std::greater(), area_of);
    windows.resize(std::min(windows.size(), kMostWindows));
    return windows;
}

}  // namespace patina
