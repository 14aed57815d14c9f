#include "tools/live/live.h"

#include <utility>

#include "engine/core/error.h"
#include "sensor/live/played_source.h"
#include "sensor/open.h"
#include "sensor/output/apart.h"
#include "sensor/recording/recorder.h"
#include "tools/live/live_run.h"
#include "tools/program/inputs.h"

namespace patina::tools {

namespace {

/// Lights cannot be looked for in a source before it is read: what was recorded beside it stands in.
LightingChoice lighting_for(const LiveOptions& options) {
    if (!std::holds_alternative<LightsBeside>(options.run.lighting)) return options.run.lighting;
    const std::filesystem::path beside =
        options.simulate.empty() ? std::filesystem::path() : sensor::lighting_of(options.simulate);
    if (beside.empty()) return LightsBeside{};
    return LightsFromSequence{beside.string()};
}

}  // namespace

Outcome live(const LiveOptions& options) {
    if (options.simulate.empty())
        throw Error("there is no live source '", options.source,
                    "'; a recording plays as one with --simulate RECORDING");
    std::vector<std::filesystem::path> inputs = sequence_inputs(options.simulate);
    sensor::expect_apart(options.run.out, inputs);
    auto recording = sensor::open_sequence(options.simulate, options.run.format);
    RunOptions run_options = options.run;
    run_options.lighting = lighting_for(options);
    run_options.sequence.clear();
    std::shared_ptr<sensor::Recorder> recorder;
    if (!options.record.empty()) {
        sensor::expect_apart(options.record, inputs);
        recorder = std::make_shared<sensor::Recorder>(options.record);
        sensor::RecordedSequence sequence;
        sequence.info = recording->info();
        recorder->begin(sensor::SequenceRole::kMain, std::move(sequence));
    }
    auto played = std::make_shared<sensor::PlayedSource>(std::move(recording), tap_to(recorder));
    LiveRun companion(std::move(played), recorder, options.record, options.seconds);
    return run(run_options, &companion);
}

}  // namespace patina::tools
