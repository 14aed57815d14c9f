#include "tests/sensor/recording_rig.h"

#include "sensor/repeated.h"
#include "tests/sensor/sequences.h"

namespace patina::sensor::testing {

namespace {

void record_frames(Recorder& recorder, SequenceRole role, uint32_t frames) {
    RecordedSequence sequence;
    sequence.info = test_info();
    recorder.begin(role, std::move(sequence));
    for (const Reading& reading : test_readings(frames)) recorder.record(std::get<Frame>(reading));
}

}  // namespace

void write_recording(const std::filesystem::path& file, uint32_t frames, bool lighting) {
    Recorder recorder(file, {.when_full = Recorder::WhenFull::kWait});
    record_frames(recorder, SequenceRole::kMain, frames);
    if (lighting) record_frames(recorder, SequenceRole::kLighting, frames);
    recorder.finish();
}

bool same_frame(const Frame& a, const Frame& b) {
    return a.index == b.index && a.timestamp_s == b.timestamp_s && same_pixels(a.color, b.color) &&
           same_pixels(a.depth, b.depth) && a.world_from_camera == b.world_from_camera &&
           a.pose_defect == b.pose_defect && a.exposure == b.exposure;
}

std::vector<uint8_t> noise_bytes(size_t count, uint64_t seed) {
    std::vector<uint8_t> bytes(count);
    uint64_t state = seed * 0x9e3779b97f4a7c15u + 1;
    for (uint8_t& byte : bytes) {
        state ^= state << 13;  // xorshift64 (Marsaglia 2003)
        state ^= state >> 7;
        state ^= state << 17;
        byte = static_cast<uint8_t>(state >> 32);
    }
    return bytes;
}

RecordedSequence raw_sequence() {
    RecordedSequence sequence;
    sequence.info = test_info();
    sequence.streams = {{"infrared", "noise", 125e-6}};
    sequence.attachments = {{"page 1", noise_bytes(1000, 1)}, {"page 2", noise_bytes(50, 2)}};
    return sequence;
}

RecordedFrame raw_frame(uint32_t index, size_t bytes) {
    RecordedFrame frame;
    frame.index = index;
    frame.timestamp_s = index / 30.0;
    frame.arrival_s = frame.timestamp_s + 0.01;
    frame.payloads.push_back({0, index + 7, 267 * int64_t{index}, R"({"gain":1.5})", noise_bytes(bytes, index)});
    return frame;
}

}  // namespace patina::sensor::testing
