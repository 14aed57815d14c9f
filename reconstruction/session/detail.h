#pragma once

#include <optional>
#include <string>

#include "patina/session.h"
#include "sensor/inspect.h"

namespace patina {

/// How fine a session is, and why.
struct DetailChoice {
    Detail level = Detail::kNormal;  ///< never kAuto
    std::string because;             ///< a clause, as "the median depth is 1.90 m"
};

/// What a level sets, except where settings are given.
struct DetailValues {
    float voxel_m;       ///< map.voxel_m
    float truncation_m;  ///< fusion.truncation_m
    float max_depth_m;   ///< fusion.max_depth_m; wide views reach less with such voxels (Pipeline::reach_m)
    float record_m;      ///< reflectance.voxel_m
    float observe_m;     ///< observe.max_distance_m
};
DetailValues values_of(Detail level);

/// The level that the options ask for; where they leave it open, by what the first frames show. `seen`: their depth;
/// empty where they are not known before the run, or nothing was measured.
DetailChoice choose_detail(const SessionOptions& options, const SequenceInfo& info,
                           const std::optional<sensor::DepthStatistics>& seen);

/// Sets what belongs to a level and was not given. Where map.voxel_m was given, band and reach are narrowed to what
/// such voxels hold.
void set_detail(Settings& settings, Detail level);

/// For a person: "detail: fine, voxels of 2.5 mm, depth up to 3 m, since the median depth is 0.55 m, where ...".
/// `reach_m`: as far as the camera's readings are fused.
std::string sentence_of(const DetailChoice& choice, const Settings& settings, double reach_m);

}  // namespace patina
