#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace patina::eval {

/// How many frames of a run were in each state of tracking.
struct FrameStates {
    uint64_t tracking = 0;
    uint64_t weak = 0;
    uint64_t lost = 0;
};

/// What run.json of a run's folder says; empty where there is no such file or its poses were given. Throws Error when
/// the file is damaged.
std::optional<FrameStates> read_frame_states(const std::filesystem::path& run);

}  // namespace patina::eval
