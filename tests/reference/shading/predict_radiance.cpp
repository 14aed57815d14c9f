#include "tests/reference/shading/predict_radiance.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "tests/reference/lighting/lamp_emission.h"

namespace patina::reference {

namespace {

/// Linear from 1 at `all` to 0 at `none`.
double fall(double value, double all, double none) { return std::clamp((value - none) / (all - none), 0.0, 1.0); }

/// A record near the point.
struct NearRecord {
    const ShadedRecord* record;
    double weight;     ///< of its surface; 0: it is another one
    double share;      ///< in trilinear interpolation; below 0 where it has none
    double distance2;  ///< from its voxel's centre, in voxels
};

/// The records of 2^3 voxels around the point, or, with margin 1, of 4^3.
std::vector<NearRecord> near_records(const ShadedScene& scene, glm::dvec3 point_m, glm::dvec3 normal, int margin) {
    std::vector<NearRecord> result;
    const glm::dvec3 at = point_m / scene.voxel_m - 0.5;
    const glm::ivec3 low(glm::floor(at));
    for (int z = low.z - margin; z <= low.z + 1 + margin; ++z) {
        for (int y = low.y - margin; y <= low.y + 1 + margin; ++y) {
            for (int x = low.x - margin; x <= low.x + 1 + margin; ++x) {
                const auto found = scene.records.find({x, y, z});
                if (found == scene.records.end()) continue;
                const ShadedRecord& record = found->second;
                if (glm::dot(record.normal, normal) <= -0.5) continue;
                const glm::dvec3 away = at - glm::dvec3(x, y, z), shares = 1.0 - glm::abs(away);
                const double off = std::abs(glm::dot(record.normal, away) - record.offset_vox);
                const double weight = fall(glm::dot(record.normal, normal), 0.75, 0.25) * fall(off, 0.5, 1.0);
                const bool inside = glm::all(glm::greaterThanEqual(shares, glm::dvec3(0)));
                result.push_back({&record, weight, inside ? shares.x * shares.y * shares.z : -1, glm::dot(away, away)});
            }
        }
    }
    return result;
}

bool is_known(const ShadedRecord& record) { return record.certainty != glm::dvec3(0); }

/// The nearest of the point's own surface, or, where there is none, of another.
template <class Wanted>
const ShadedRecord* nearest(const std::vector<NearRecord>& all, const Wanted& wanted) {
    const ShadedRecord* best = nullptr;
    double least = std::numeric_limits<double>::max();
    for (const NearRecord& neighbour : all) {
        const double distance2 = neighbour.distance2 + (neighbour.weight > 0 ? 0 : 100);
        if (!wanted(*neighbour.record) || distance2 >= least) continue;
        least = distance2;
        best = neighbour.record;
    }
    return best;
}

/// kd and how sure it is, by channel.
struct Albedo {
    glm::dvec3 kd{0};
    glm::dvec3 weight{0};
};

Albedo mean_kd(const std::vector<NearRecord>& around) {
    glm::dvec3 sum(0), weights(0);
    double shares = 0;
    for (const NearRecord& neighbour : around) {
        const double share = neighbour.weight * neighbour.share;
        const glm::dvec3 weight = share * neighbour.record->certainty;
        sum += weight * neighbour.record->kd;
        weights += weight;
        shares += share;
    }
    return {sum / glm::max(weights, 1e-20), weights / std::max(shares, 1e-20)};
}

/// The albedo of the surface around, of the records that know it.
std::optional<glm::dvec3> mean_around(const std::vector<NearRecord>& near) {
    glm::dvec3 sum(0);
    double shares = 0;
    for (const NearRecord& neighbour : near) {
        if (!neighbour.record->around) continue;
        const double share = neighbour.weight * neighbour.share;
        sum += share * *neighbour.record->around;
        shares += share;
    }
    return shares > 0 ? std::optional(sum / shares) : std::nullopt;
}

/// The share of the surface around the point that light i reaches; nothing where no record knows.
std::optional<double> share_lit(const std::vector<NearRecord>& around, size_t i) {
    double lit = 0, all = 0;
    for (const NearRecord& neighbour : around) {
        if (!neighbour.record->marched) continue;
        const double weight = neighbour.weight * neighbour.share;
        all += weight;
        if (neighbour.record->reached >> i & 1) lit += weight;
    }
    return all > 0 ? std::optional(lit / all) : std::nullopt;
}

}  // namespace

std::map<uint32_t, glm::dvec3> average_segments(const std::map<std::array<int, 3>, ShadedRecord>& records) {
    std::map<uint32_t, Albedo> sums;
    for (const auto& [voxel, record] : records) {
        if (record.label == 0) continue;
        const glm::dvec3 weight = glm::round(record.certainty * 3.0) / 3.0;
        sums[record.label].kd += weight * record.kd;
        sums[record.label].weight += weight;
    }
    std::map<uint32_t, glm::dvec3> means;
    for (const auto& [label, sum] : sums) {
        if (std::min({sum.weight.r, sum.weight.g, sum.weight.b}) >= 3) means[label] = sum.kd / sum.weight;
    }
    return means;
}

ShadedPoint predict_radiance(const ShadedScene& scene, glm::dvec3 point_m, glm::dvec3 normal, glm::dvec3 viewer_m) {
    std::vector<NearRecord> around = near_records(scene, point_m, normal, 0);
    std::erase_if(around, [](const NearRecord& n) { return n.weight == 0; });
    const std::vector<NearRecord> farther = near_records(scene, point_m, normal, 1);
    const bool filled =
        std::none_of(around.begin(), around.end(), [](const NearRecord& n) { return is_known(*n.record); });
    const ShadedRecord* fill = filled ? nearest(farther, is_known) : nullptr;
    const auto labelled = [](const ShadedRecord& record) { return record.label != 0; };
    const ShadedRecord* segment = nearest(around, labelled);
    if (!segment && filled) segment = nearest(farther, labelled);

    ShadedPoint result;
    if (segment) result.label = segment->label;
    if (scene.materials.count(result.label)) result.gloss = scene.materials.at(result.label);
    const auto whole = scene.segment_kd.find(result.label);
    const bool has_segment = whole != scene.segment_kd.end();
    const std::optional<glm::dvec3> alike = fill ? std::nullopt : mean_around(around);
    if (filled && !fill && !has_segment && !alike) return result;
    result.known = true;
    const Albedo own = fill ? Albedo{fill->kd, fill->certainty} : mean_kd(around);
    result.kd = own.kd;
    if (alike || has_segment) {
        // Inverse variances: of kd, in units of 0.05 squared; of voxels about their segment's mean, 0.1; and about the
        // albedo around, 0.015.
        const glm::dvec3 sure = own.weight / glm::max(1.0 - own.weight, 1e-3);
        const double weight = alike ? 0.05 * 0.05 / (0.015 * 0.015) : 0.25;
        result.kd = (sure * own.kd + weight * (alike ? *alike : whole->second)) / (sure + weight);
    }
    result.rgb = scene.ambient * result.kd;
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        const glm::dvec3 offset = scene.lights[i].position_m - point_m;
        const glm::dvec3 to_light = glm::normalize(offset);
        double lit = 1;
        if (scene.shadows)
            lit = share_lit(around, i).value_or(fill && fill->marched ? double(fill->reached >> i & 1) : 1);
        const Ward material{result.kd, result.gloss.ks, std::max(result.gloss.alpha, 0.01)};
        const glm::dvec3 facing =
            emitted(scene.lights[i].intensity, scene.lights[i].axis, to_light) / glm::dot(offset, offset);
        result.rgb += lit * ward(material, normal, to_light, glm::normalize(viewer_m - point_m)) * facing *
                      std::max(glm::dot(normal, to_light), 0.0);
    }
    return result;
}

}  // namespace patina::reference
