#include "tests/reference/reflectance/smooth_irradiance.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace patina::reference {

namespace {

using Cell = std::tuple<int, int, int>;

Cell cell_beside(glm::ivec3 cell, int x, int y, int z) { return {cell.x + x, cell.y + y, cell.z + z}; }

double brightness(glm::dvec3 rgb) { return (rgb.r + rgb.g + rgb.b) / 3; }

}  // namespace

std::vector<GatheredRays> smooth_irradiance(const std::vector<GatheringPlace>& places, double edge_m) {
    std::map<Cell, const GatheringPlace*> by_cell;
    for (const GatheringPlace& place : places) by_cell[cell_beside(place.cell, 0, 0, 0)] = &place;
    std::vector<GatheredRays> smooth;
    for (const GatheringPlace& place : places) {
        glm::dvec3 light(0);
        double met = 0, missed = 0;
        std::vector<GatheredRays> all;
        for (int x = -1; x <= 1; ++x) {
            for (int y = -1; y <= 1; ++y) {
                for (int z = -1; z <= 1; ++z) {
                    const auto beside = by_cell.find(cell_beside(place.cell, x, y, z));
                    if (beside == by_cell.end()) continue;
                    const GatheringPlace& other = *beside->second;
                    if (glm::dot(place.normal, other.normal) < 0.9) continue;
                    if (std::abs(glm::dot(place.normal, other.point_m - place.point_m)) > edge_m) continue;
                    light += double(other.rays.met) * other.rays.mean;
                    met += other.rays.met;
                    missed += other.rays.missed;
                    all.push_back(other.rays);
                }
            }
        }
        const double mean = brightness(light) / std::max(met, 1.0);
        double error2 = 0;  // of the mean, from how far its parts differ from it
        for (const GatheredRays& rays : all)
            error2 += std::pow(rays.met * (brightness(rays.mean) - mean) / std::max(met, 1.0), 2);
        const double relative2 = mean > 0 ? error2 / (mean * mean) : 0;
        const double worth = std::clamp(relative2 > 0 ? 0.25 / relative2 : 192.0, 8.0, 192.0);
        const double kept = std::min(worth / std::max(met + missed, 1.0), 1.0);
        smooth.push_back({met > 0 ? light / met : glm::dvec3(0), static_cast<uint32_t>(std::lround(kept * met)),
                          static_cast<uint32_t>(std::lround(kept * missed))});
    }
    return smooth;
}

}  // namespace patina::reference
