#include "tools/record/record.h"

#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "sensor/live/played_source.h"
#include "sensor/open.h"
#include "sensor/output/apart.h"
#include "sensor/prefetch.h"
#include "sensor/recording/exposure_check.h"
#include "sensor/recording/payload_codec.h"
#include "sensor/recording/recorder.h"
#include "tools/program/cameras.h"
#include "tools/program/inputs.h"
#include "tools/program/interrupt.h"
#include "tools/program/progress.h"
#include "tools/program/standard_streams.h"

namespace patina::tools {

namespace {

namespace fs = std::filesystem;
using sensor::SequenceRole;

double mebibytes(uint64_t bytes) { return static_cast<double>(bytes) / (1 << 20); }

/// Stops a camera when the user asks, also one that has fallen silent.
class Watch {
  public:
    Watch(sensor::LiveCapture& capture, const InterruptGuard& interrupt)
        : thread_([&capture, &interrupt](std::stop_token stop) {
              while (!stop.stop_requested() && !interrupt.requested()) std::this_thread::sleep_for(kWatch);
              if (!stop.stop_requested()) capture.stop();
          }) {}

  private:
    static constexpr std::chrono::milliseconds kWatch{50};
    std::jthread thread_;
};

/// One recording from its first sequence to its last.
class Recording {
  public:
    explicit Recording(const RecordOptions& options)
        : options_(options),
          recorder_(std::make_shared<sensor::Recorder>(
              options.out,
              sensor::Recorder::Options{.when_full = is_live(options) ? sensor::Recorder::WhenFull::kDrop
                                                                      : sensor::Recorder::WhenFull::kWait})) {}

    /// Records what a camera sends, as it sends it, until the user or the time ends it.
    void add(cameras::Kinect2Capture& capture) {
        recorder_->begin(SequenceRole::kMain, capture.sequence());
        if (!options_.quiet) print_error("{}\n", sensor::instruction(SequenceRole::kMain));
        capture.set_tap([recorder = recorder_](const sensor::RecordedFrame& frame) { recorder->record(frame); });
        sensor::ExposureCheck exposure(SequenceRole::kMain);
        const Watch watch(capture, interrupt_);
        Progress progress("Recording", std::nullopt, options_.quiet);
        while (const auto frame = capture.next()) {
            if (const auto* raw = std::get_if<sensor::RecordedFrame>(&*frame)) {
                if (is_over(raw->timestamp_s)) break;
                check(*raw, capture.sequence(), exposure);
            }
            if (interrupted() || !recorder_->problem().empty()) break;
            progress.update(static_cast<uint32_t>(capture.counts().captured), detail(exposure));
        }
        capture.stop();
        advise(SequenceRole::kMain, exposure);
    }

    /// Records one sequence to its end.
    void add(SequenceRole role, const std::string& path, const std::string& format, const std::string& place) {
        auto recording = sensor::open_sequence(path, format);
        sensor::RecordedSequence sequence;
        sequence.info = recording->info();
        total_ = recording->info().frames;
        recorder_->begin(role, std::move(sequence));
        if (options_.simulate && !options_.quiet) print_error("{}: {}\n", place, sensor::instruction(role));
        sensor::ExposureCheck exposure(role);
        if (options_.simulate) {
            play(std::move(recording), exposure);
        } else {
            copy(std::move(recording), exposure);
        }
        advise(role, exposure);
    }

    bool interrupted() const { return interrupt_.requested(); }

    /// What was recorded before something failed. Throws Error.
    [[noreturn]] void keep(const std::string& reason) {
        try {
            recorder_->finish();
        } catch (const Error&) {  // nothing more can be done
        }
        throw Error(reason, "; '", options_.out.string(), "' holds ", recorder_->counts().written, " frames");
    }

    Outcome finish() {
        try {
            recorder_->finish();
        } catch (const Error& error) {
            keep(error.what());
        }
        const sensor::RecorderCounts counts = recorder_->counts();
        Outcome outcome;
        if (interrupted() && !is_live(options_))
            outcome.fall_short(fmt::format("interrupted after {} frames", counts.given));
        if (counts.dropped > 0)
            outcome.fall_short(fmt::format("{} of {} frames are missing: the disk did not keep pace with the camera",
                                           counts.dropped, counts.given));
        outcome.print(options_.quiet);
        if (!options_.quiet) {
            print_out("{} frames, {:.1f} MiB in {}\n", counts.written, mebibytes(counts.bytes),
                      printable(options_.out.string()));
            for (const std::string& advice : advice_) print_out("warning: {}\n", printable(advice));
        }
        return outcome;
    }

  private:
    /// Cameras take frames whether they are written or not.
    static bool is_live(const RecordOptions& options) { return options.simulate || is_camera(options.source); }

    void advise(SequenceRole role, const sensor::ExposureCheck& exposure) {
        if (std::string advice = exposure.advice(); !advice.empty())
            advice_.push_back(fmt::format("{} sequence: {}", name_of(role), advice));
    }

    /// As fast as it can be read.
    void copy(std::unique_ptr<Source> recording, sensor::ExposureCheck& exposure) {
        sensor::PrefetchSource source(std::move(recording));
        const sensor::ReadingTap record = to_recorder();
        Progress progress("Recording", total_, options_.quiet);
        uint32_t done = 0;
        while (std::optional<Reading> reading = source.next()) {
            if (interrupted() || is_over(*reading) || !recorder_->problem().empty()) break;
            check(*reading, exposure);
            record(*reading);
            progress.update(++done, detail(exposure));
        }
        first_s_.reset();
    }

    /// By its clock: what is looked at may be late, what is recorded is not.
    void play(std::unique_ptr<Source> recording, sensor::ExposureCheck& exposure) {
        sensor::PlayedSource source(std::move(recording), to_recorder());
        Progress progress("Recording", total_, options_.quiet);
        while (std::optional<Reading> reading = source.next()) {
            if (interrupted() || is_over(*reading) || !recorder_->problem().empty()) break;
            check(*reading, exposure);
            progress.update(static_cast<uint32_t>(source.counts().captured), detail(exposure));
        }
        first_s_.reset();
    }

    sensor::ReadingTap to_recorder() const {
        return [recorder = recorder_](const Reading& reading) {
            if (const auto* skipped = std::get_if<Skipped>(&reading)) return recorder->skip(*skipped);
            recorder->record(std::get<Frame>(reading));
        };
    }

    bool is_over(const Reading& reading) {
        const auto* frame = std::get_if<Frame>(&reading);
        return frame && is_over(frame->timestamp_s);
    }

    bool is_over(double timestamp_s) {
        if (options_.seconds <= 0) return false;
        if (!first_s_) first_s_ = timestamp_s;
        return timestamp_s - *first_s_ >= options_.seconds;
    }

    static void check(const Reading& reading, sensor::ExposureCheck& exposure) {
        if (const auto* frame = std::get_if<Frame>(&reading)) exposure.add(frame->color);
    }

    /// What cannot be decoded is told when the recording is read.
    static void check(const sensor::RecordedFrame& raw, const sensor::RecordedSequence& sequence,
                      sensor::ExposureCheck& exposure) {
        for (const sensor::Payload& payload : raw.payloads) {
            const sensor::RecordedStream& stream = sequence.streams[payload.stream];
            if (stream.name != "color") continue;
            try {
                exposure.add(sensor::decode_color(stream.encoding, payload.content, sequence.info.color.extent, ""));
            } catch (const Error&) {
            }
        }
    }

    std::string detail(const sensor::ExposureCheck& exposure) const {
        const sensor::RecorderCounts counts = recorder_->counts();
        return fmt::format("{:.2f} % clipped, {:.1f} % bright  {:.0f} MiB, {:.0f} MiB wait, {} dropped",
                           100 * exposure.last().clipped, 100 * exposure.last().bright, mebibytes(counts.bytes),
                           mebibytes(counts.queued_bytes), counts.dropped);
    }

    const RecordOptions& options_;
    InterruptGuard interrupt_;
    std::shared_ptr<sensor::Recorder> recorder_;
    std::optional<uint32_t> total_;
    std::optional<double> first_s_;
    std::vector<std::string> advice_;
};

Outcome record_camera(const RecordOptions& options) {
    if (!options.lighting.empty())
        throw Error("--lighting is for recordings: a camera's sequence of low exposure cannot be recorded yet");
    const auto capture = open_kinect2();
    Recording recording(options);
    try {
        recording.add(*capture);
    } catch (const std::exception& error) {  // it was unplugged, perhaps
        recording.keep(reason_of(error));
    }
    return recording.finish();
}

}  // namespace

Outcome record(const RecordOptions& options) {
    if (is_camera(options.source)) return record_camera(options);
    const std::string lighting =
        options.lighting.empty() ? sensor::lighting_of(options.source).string() : options.lighting;
    std::vector<fs::path> inputs = sequence_inputs(options.source);
    for (fs::path& input : sequence_inputs(lighting)) inputs.push_back(std::move(input));
    sensor::expect_apart(options.out, inputs);
    // Wrong paths are found before the file is there.
    for (const std::string& source : {options.source, lighting})
        if (!source.empty()) sensor::open_sequence(source, source == options.source ? options.format : "");
    Recording recording(options);
    try {
        const char* of = lighting.empty() ? "1" : "2";
        recording.add(SequenceRole::kMain, options.source, options.format, fmt::format("sequence 1 of {}", of));
        if (!lighting.empty() && !recording.interrupted())
            recording.add(SequenceRole::kLighting, lighting, "", "sequence 2 of 2");
    } catch (const std::exception& error) {  // the source is gone, such as a camera that was unplugged
        recording.keep(reason_of(error));
    }
    return recording.finish();
}

}  // namespace patina::tools
