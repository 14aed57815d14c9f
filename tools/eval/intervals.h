#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "tools/eval/result.h"

namespace patina::eval {

/// Objects whose best label has less IoU have no segment of their own, and are left out: the segment's material is that
/// of something else.
inline constexpr double kMatchedIou = 0.5;

/// Whether the true materials of `sequence` lie in the intervals that materials.json of `run` has for the best label of
/// each object: sets ObjectResult::intervals. Objects are left out that have no such segment, or one without intervals;
/// kd also where truth or segment have no single one. A bound counts as rounded to four decimals. Does nothing where
/// one of the two files is missing. Throws Error for a file that is damaged.
void compare_intervals(const std::filesystem::path& sequence, const std::filesystem::path& run,
                       std::vector<ObjectResult>& objects);

/// Sums over objects by level; empty where no object has intervals.
std::vector<IntervalCounts> count_intervals(std::span<const ObjectResult> objects);

}  // namespace patina::eval
