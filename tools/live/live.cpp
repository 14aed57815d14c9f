#include "tools/live/live.h"

#include <utility>

#include "cameras/kinect2_live_source.h"
#include "engine/core/error.h"
#include "sensor/live/played_source.h"
#include "sensor/open.h"
#include "sensor/output/apart.h"
#include "sensor/recording/recorder.h"
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

/// A recorder for a file that is not there yet; null where none was asked for.
std::shared_ptr<sensor::Recorder> recorder_for(const LiveOptions& options, sensor::RecordedSequence sequence) {
    if (options.record.empty()) return nullptr;
    auto recorder = std::make_shared<sensor::Recorder>(options.record);
    recorder->begin(sensor::SequenceRole::kMain, std::move(sequence));
    return recorder;
}

struct RecordedInput {
    LiveInput input;
    std::shared_ptr<sensor::Recorder> recorder;  ///< null where nothing is recorded
};

RecordedInput open_camera(const LiveOptions& options) {
    auto capture = open_kinect2();
    auto recorder = recorder_for(options, capture->sequence());
    if (recorder) capture->set_tap([recorder](const sensor::RecordedFrame& frame) { recorder->record(frame); });
    return {
        {capture,
         [capture](vulkan::Device& device) { return std::make_unique<cameras::Kinect2LiveSource>(device, capture); }},
        recorder};
}

RecordedInput open_played(const LiveOptions& options) {
    const std::vector<std::filesystem::path> inputs = sequence_inputs(options.simulate);
    sensor::expect_apart(options.run.out, inputs);
    auto recording = open_to_play(options.simulate, options.run.format);
    if (!options.record.empty()) sensor::expect_apart(options.record, inputs);
    sensor::RecordedSequence sequence;
    sequence.info = recording->info();
    auto recorder = recorder_for(options, std::move(sequence));
    return {live_input(std::make_shared<sensor::PlayedSource>(std::move(recording), sensor::tap_to(recorder))),
            recorder};
}

}  // namespace

Outcome live(const LiveOptions& options) {
    if (options.simulate.empty() && !is_camera(options.source))
        throw Error("there is no camera '", options.source, "', must be ", kKinect2,
                    "; a recording plays as one with --simulate RECORDING");
    RunOptions run_options = options.run;
    run_options.lighting = lighting_for(options);
    run_options.sequence.clear();
    RecordedInput opened = options.simulate.empty() ? open_camera(options) : open_played(options);
    LiveRun companion(std::move(opened.input), opened.recorder, options.record, options.seconds);
    if (!options.accompany) return run(run_options, &companion);
    const auto besides = options.accompany(run_options, companion, [&companion] { companion.end_source(); });
    return run(run_options, besides.get());
}

}  // namespace patina::tools
