#include "reconstruction/session/detail.h"

#include <algorithm>

#include <fmt/format.h>

#include "engine/core/error.h"
#include "reconstruction/api/access.h"
#include "reconstruction/session/choices.h"

namespace patina {

namespace {

// Fine: something on a table, which fills the view, and is sampled twice as densely as fine voxels. Of a room, 5 % of
// the readings are nearer than 1 m; its median is 1.5 m and more.
constexpr double kFineMedian_m = 0.8, kFineFar_m = 2, kFinePixel_m = 0.00125;
// Coarse: a hall, of which normal voxels would each be hit by less than one pixel, and whose walls lie beyond 6 m.
// A median beyond 30 m means a wrong depth unit; the inspector warns of it.
constexpr double kCoarseMedian_m = 4.5, kCoarsePixel_m = 0.005, kFarthest_m = 30;

constexpr float kBandVoxels = 4;  // half width of the band at depth 0, of voxels that were given

constexpr float kLeastAround_m = 5;  // a room throws shadows on what a near camera sees

/// The depth at which the band is as wide as voxels can express: 16 voxels, at a slope of 0.005 (FusionSettings).
constexpr float kReachVoxels = (16 - kBandVoxels) / 0.005f;

template <class Value>
void set_unless_given(Settings& settings, const char* key, Value& place, Value value) {
    if (!Access::is_given(settings, key)) place = value;
}

}  // namespace

DetailValues values_of(Detail level) {
    switch (level) {
        // The depth of steep metal, as of a dish's rim, is off by more than four such voxels.
        case Detail::kFine: return {0.0025f, 0.016f, 3, 0.01f, 8};
        case Detail::kCoarse: return {0.01f, 0.04f, 12, 0.04f, 12};
        case Detail::kNormal: break;
        case Detail::kAuto: PATINA_ASSERT(false, "a level that is left open has no values");
    }
    const ReconstructionSettings normal;
    return {normal.map.voxel_m, normal.fusion.truncation_m, normal.fusion.max_depth_m, 0,
            ReflectanceStageSettings().observe.max_distance_m};
}

DetailChoice choose_detail(const SessionOptions& options, const SequenceInfo& info,
                           const std::optional<sensor::DepthStatistics>& seen) {
    if (options.detail != Detail::kAuto) return {options.detail, "it was asked for"};
    if (Access::is_given(options.settings, "map.voxel_m")) return {Detail::kNormal, "map.voxel_m was given"};
    if (!seen || seen->valid_share == 0) return {Detail::kNormal, "its first frames were not looked at"};
    const double pixel_m = seen->median_m / info.depth.fx;
    std::string because = fmt::format("the median depth is {:.2f} m", seen->median_m);
    const std::string and_pixel = fmt::format("{}, where a pixel covers {:.1f} mm", because, 1000 * pixel_m);
    if (seen->median_m <= kFineMedian_m && seen->p95_m <= kFineFar_m && pixel_m <= kFinePixel_m)
        return {Detail::kFine, and_pixel};
    const bool far = seen->median_m >= kCoarseMedian_m && seen->median_m <= kFarthest_m;
    if (far && pixel_m >= kCoarsePixel_m) return {Detail::kCoarse, and_pixel};
    return {Detail::kNormal, std::move(because)};
}

void set_detail(Settings& settings, Detail level) {
    DetailValues chosen = values_of(level);
    ReconstructionSettings& values = Access::values(settings);
    if (Access::is_given(settings, "map.voxel_m")) {
        chosen.truncation_m = std::min(chosen.truncation_m, kBandVoxels * values.map.voxel_m);
        chosen.max_depth_m = std::min(chosen.max_depth_m, kReachVoxels * values.map.voxel_m);
        chosen.record_m = 0;
    }
    set_unless_given(settings, "map.voxel_m", values.map.voxel_m, chosen.voxel_m);
    set_unless_given(settings, "fusion.truncation_m", values.fusion.truncation_m, chosen.truncation_m);
    set_unless_given(settings, "fusion.max_depth_m", values.fusion.max_depth_m, chosen.max_depth_m);
    // What is fused is shaded.
    set_unless_given(settings, "map.around_m", values.around_m, std::max(kLeastAround_m, values.fusion.max_depth_m));
}

std::string sentence_of(const DetailChoice& choice, const Settings& settings, double reach_m) {
    return fmt::format("detail: {}, voxels of {} mm, depth up to {:.3g} m, since {}", name_of(choice.level),
                       1000 * Access::values(settings).map.voxel_m, reach_m, choice.because);
}

}  // namespace patina
