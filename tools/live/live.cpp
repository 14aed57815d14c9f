#include "tools/live/live.h"

#include <utility>

#include "cameras/kinect2_live_source.h"
#include "engine/core/error.h"
#include "sensor/live/played_source.h"
#include "sensor/open.h"
#include "sensor/output/apart.h"
#include "tools/live/live_recording.h"
#include "tools/live/live_run.h"
#include "tools/program/cameras.h"
#include "tools/program/inputs.h"

namespace patina::tools {

namespace {

/// Lights cannot be looked for in a source before it is read. A recording that plays has its lighting sequence beside
/// it, and is looked at in its own world.
LightingChoice lighting_for(const LiveOptions& options) {
    if (options.simulate.empty()) return options.run.lighting;
    if (const auto* named = std::get_if<LightsFromSequence>(&options.run.lighting))
        return LightsFromSequence{named->sequence, options.simulate};
    if (!std::holds_alternative<LightsBeside>(options.run.lighting)) return options.run.lighting;
    const std::filesystem::path beside = sensor::lighting_of(options.simulate);
    if (beside.empty()) return LightsBeside{};
    return LightsFromSequence{beside.string(), options.simulate};
}

struct RecordedInput {
    LiveInput input;
    std::shared_ptr<LiveRecording> recording;
};

/// Of decoded frames.
std::shared_ptr<LiveRecording> recording_of(const SequenceInfo& info) {
    sensor::RecordedSequence sequence;
    sequence.info = info;
    return std::make_shared<LiveRecording>(std::move(sequence));
}

/// Of raw frames, which the run's device decodes.
RecordedInput input_of(std::shared_ptr<cameras::RawCapture> capture) {
    auto recording = std::make_shared<LiveRecording>(capture->sequence());
    capture->set_tap([recording](const cameras::RawReading& reading) { recording->take(reading); });
    return {
        {capture,
         [capture](vulkan::Device& device) { return std::make_unique<cameras::Kinect2LiveSource>(device, capture); }},
        recording};
}

RecordedInput open_camera(const std::string& name) {
    if (name != kKinect2) {
        const auto source = open_other_camera(name);
        auto recording = recording_of(source->info());
        source->set_tap([recording](const Reading& reading) { recording->take(reading); });
        return {live_input(source), recording};
    }
    return input_of(open_kinect2());
}

RecordedInput open_played(const LiveOptions& options) {
    const std::vector<std::filesystem::path> inputs = sequence_inputs(options.simulate);
    sensor::expect_apart(options.run.out, inputs);
    if (!options.record.empty()) sensor::expect_apart(options.record, inputs);
    if (auto raw = open_raw_to_play(options.simulate)) return input_of(std::move(raw));
    auto played = sensor::open_sequence(options.simulate, options.run.format);
    auto recording = recording_of(played->info());
    return {live_input(std::make_shared<sensor::PlayedSource>(
                std::move(played), [recording](const Reading& reading) { recording->take(reading); })),
            recording};
}

}  // namespace

Outcome live(const LiveOptions& options) {
    if (options.simulate.empty() && !is_camera(options.source))
        throw Error("there is no camera '", options.source, "', must be ", kCameraNames,
                    "; a recording plays as one with --simulate RECORDING");
    RunOptions run_options = options.run;
    run_options.lighting = lighting_for(options);
    run_options.sequence.clear();
    RecordedInput opened = options.simulate.empty() ? open_camera(options.source) : open_played(options);
    if (!options.record.empty()) opened.recording->start(options.record);
    LiveRun companion(std::move(opened.input), std::move(opened.recording), options.run.out, options.seconds);
    if (!options.accompany) return run(run_options, &companion);
    const auto besides = options.accompany(run_options, companion, companion);
    return run(run_options, besides.get());
}

}  // namespace patina::tools
