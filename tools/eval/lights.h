#pragma once

#include <span>

#include "tools/eval/result.h"

namespace patina::eval {

/// Pairs each true light with at most one of the run, nearest pairs first, none farther apart than `radius_m`. Both
/// lists are in one world.
LightErrors compare_lights(std::span<const Light> truth, std::span<const Light> run, double radius_m);

}  // namespace patina::eval
