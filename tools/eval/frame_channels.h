#pragma once

#include <set>
#include <string>
#include <vector>

#include "tools/eval/exr_planes.h"
#include "tools/eval/result.h"

namespace patina::eval {

/// Where frames hold a quantity: a scalar channel `name`, or name.R name.G name.B.
struct QuantityChannels {
    std::string truth;  ///< name in truth/frames
    std::string run;    ///< name in the run's frames
    bool displayed;     ///< compared after clipping to [0, 1], as a camera records it
};
QuantityChannels channels_for(Quantity quantity);

/// The channels of a group, as "kd.R" "kd.G" "kd.B", or "alpha".
std::vector<std::string> channel_names(const std::string& group);

/// The groups of channels that a frame of a run has, of those that are known: "kd", "normal", "valid" and so on.
/// Throws Error when a group is incomplete.
std::set<std::string> groups_of(const ExrPlanes& frame);

/// Throws Error unless `frame` has the groups that the run's first frame has.
void expect_groups(const ExrPlanes& frame, const std::set<std::string>& expected, const std::string& first_file);

}  // namespace patina::eval
