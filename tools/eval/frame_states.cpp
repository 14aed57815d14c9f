#include "tools/eval/frame_states.h"

#include "engine/core/input_file.h"
#include "sensor/files/json_file.h"

namespace patina::eval {

namespace {

constexpr uint64_t kMostFrames = UINT32_MAX;

}  // namespace

std::optional<FrameStates> read_frame_states(const std::filesystem::path& run) {
    const std::filesystem::path file = run / "run.json";
    if (!path_exists(file)) return std::nullopt;
    const auto tracking = sensor::JsonValue::read(file).find("tracking");
    if (!tracking) return std::nullopt;
    const auto count = [&](const char* state) { return tracking->at(state).whole_number(kMostFrames); };
    return FrameStates{count("tracking"), count("weak"), count("lost")};
}

}  // namespace patina::eval
