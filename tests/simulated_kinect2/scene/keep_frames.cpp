// kinect2_keep_frames FROM TRAJECTORY TO: a recording with the frames of another one alone whose times are those of a
// trajectory, such as the frames that a live run used. They are copied row by row.
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <set>

#include "sensor/pose.h"
#include "sensor/recording/container.h"
#include "sensor/recording/recorder.h"

namespace patina::sensor {
namespace {

namespace fs = std::filesystem;

/// A trajectory has six digits of a second.
int64_t microseconds(double timestamp_s) { return std::llround(1e6 * timestamp_s); }

void keep_frames(const fs::path& from, const fs::path& trajectory, const fs::path& to) {
    std::set<int64_t> times_us;
    for (const auto& pose : read_trajectory(trajectory)) times_us.insert(microseconds(pose.timestamp_s));
    RecordingFile recording(from);
    const RecordedSequence& sequence = recording.sequence(SequenceRole::kMain);
    Recorder recorder(to, {.when_full = Recorder::WhenFull::kWait});
    recorder.begin(SequenceRole::kMain, sequence);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < *sequence.info.frames; ++i) {
        auto row = recording.read(SequenceRole::kMain, i);
        auto* frame = std::get_if<RecordedFrame>(&row);
        if (!frame || !times_us.contains(microseconds(frame->timestamp_s))) continue;
        frame->index = kept++;
        recorder.record(std::move(*frame));
    }
    recorder.finish();
    if (kept != times_us.size()) throw Error(kept, " of ", times_us.size(), " frames are in '", from.string(), "'");
}

}  // namespace
}  // namespace patina::sensor

int main(int count, char** arguments) {
    if (count != 4) {
        std::fputs("usage: kinect2_keep_frames FROM TRAJECTORY TO\n", stderr);
        return 2;
    }
    try {
        patina::sensor::keep_frames(arguments[1], arguments[2], arguments[3]);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
