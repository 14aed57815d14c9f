#include "tools/record/record.h"

#include <chrono>
#include <exception>
#include <memory>
#include <optional>
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
#include "tools/program/camera_watch.h"
#include "tools/program/cameras.h"
#include "tools/program/inputs.h"
#include "tools/program/interrupt.h"
#include "tools/program/mebibytes.h"
#include "tools/program/progress.h"
#include "tools/program/standard_streams.h"
#include "tools/record/raw_pass.h"

namespace patina::tools {

namespace {

namespace fs = std::filesystem;
using sensor::SequenceRole;

/// One recording from its first sequence to its last.
class Recording {
  public:
    explicit Recording(const RecordOptions& options)
        : options_(options),
          recorder_(std::make_shared<sensor::Recorder>(
              options.out,
              sensor::Recorder::Options{.when_full = is_live(options) ? sensor::Recorder::WhenFull::kDrop
                                                                      : sensor::Recorder::WhenFull::kWait})) {}

    /// Records what a camera sends, as it sends it, until the user or the time ends it; then once more at a low
    /// exposure where that was asked for. The camera runs on between the two: its calibration holds for one run.
    void add(cameras::Kinect2Capture& capture) {
        const bool twice = !options_.lighting.empty();
        const auto pass = tapped(capture);
        add_pass(capture, *pass, SequenceRole::kMain, !twice, twice ? "sequence 1 of 2" : "");
        if (twice && recorder_->problem().empty() && !interrupt_.must_end()) {
            interrupt_.forget();
            capture.fix_exposure({static_cast<float>(options_.low_exposure_ms), 1});
            add_pass(capture, *pass, SequenceRole::kLighting, true, "sequence 2 of 2");
        }
        capture.stop();
        if (const uint64_t lost = capture.counts().lost; lost > 0)
            advice_.push_back(fmt::format("{} frames were lost on the way from the camera", lost));
    }

    /// The same of a camera whose exposure cannot be set: what it shows of itself.
    void add(sensor::CameraSource& camera) {
        instruct(SequenceRole::kMain, "");
        sensor::ExposureCheck exposure(SequenceRole::kMain);
        begin(SequenceRole::kMain, camera.info());
        camera.set_tap(sensor::tap_to(recorder_));
        take(camera, std::nullopt, exposure);
        finish_pass(SequenceRole::kMain, exposure);
    }

    /// Records one sequence to its end.
    void add(SequenceRole role, const std::string& path, const std::string& format, const std::string& place) {
        if (const auto raw = options_.simulate ? open_raw_to_play(path) : nullptr)
            return add_pass(*raw, *tapped(*raw), role, true, place);
        sensor::ExposureCheck exposure(role);
        if (options_.simulate) {
            instruct(role, place);
            play(role, sensor::open_sequence(path, format), exposure);
        } else if (sensor::names_recording(path)) {
            copy_rows(role, path, exposure);
        } else {
            copy(role, sensor::open_sequence(path, format), exposure);
        }
        finish_pass(role, exposure);
    }

    bool interrupted() const { return interrupt_.requested(); }

    /// What was recorded before something failed. Throws Error.
    [[noreturn]] void keep(const std::string& reason) {
        try {
            recorder_->finish();
        } catch (const Error&) {  // nothing more can be done
        }
        const sensor::RecorderCounts counts = recorder_->counts();
        if (counts.given == 0) {
            recorder_->discard();
            throw Error(reason);
        }
        throw Error(reason, "; '", options_.out.string(), "' holds ", counts.written, " frames");
    }

    Outcome finish() {
        try {
            recorder_->finish();
        } catch (const Error& error) {
            keep(error.what());
        }
        const sensor::RecorderCounts counts = recorder_->counts();
        if (frames_of_main_.value_or(0) == 0) discard();
        Outcome outcome;
        if (interrupted() && !is_live(options_))
            outcome.fall_short(fmt::format("interrupted after {} frames", counts.given));
        if (counts.dropped > 0)
            outcome.fall_short(fmt::format("{} of {} frames are missing: the disk did not keep pace with the camera",
                                           counts.dropped, counts.given));
        if (undecoded_ > 0)
            outcome.fall_short(
                fmt::format("{} of {} frames are missing: they could not be decoded as fast as the camera sends them; "
                            "record without --decoded, and decode the file later",
                            undecoded_, counts.given));
        if (counts.skipped == counts.given)
            outcome.fall_short(
                fmt::format("none of {} frames has pictures: {}", counts.given, recorder_->skipped_for()));
        else if (counts.skipped > undecoded_)
            advice_.push_back(fmt::format("{} of {} frames have no pictures, the last of them: {}",
                                          counts.skipped - undecoded_, counts.given, recorder_->skipped_for()));
        if (frames_of_lighting_ == 0) outcome.fall_short("no frame of the sequence of low exposure was recorded");
        outcome.print(options_.quiet);
        if (!options_.quiet) {
            print_out("{} frames, {:.1f} MiB in {}\n", counts.written, mebibytes(counts.bytes),
                      printable(options_.out.string()));
            if (!recorder_->warning().empty()) advice_.push_back(recorder_->warning());
            for (const std::string& advice : advice_) print_out("warning: {}\n", printable(advice));
        }
        return outcome;
    }

  private:
    /// Cameras take frames whether they are written or not.
    static bool is_live(const RecordOptions& options) { return options.simulate || is_camera(options.source); }

    [[noreturn]] void discard() {
        recorder_->discard();
        if (interrupted()) throw Interrupted("interrupted before the first frame; nothing is left");
        throw Error("no frame of '", options_.source, "' was recorded; nothing is left");
    }

    void begin_pass(SequenceRole role) {
        given_before_ = recorder_->counts().given;
        first_s_.reset();
        first_skipped_.reset();
        (role == SequenceRole::kMain ? frames_of_main_ : frames_of_lighting_) = 0;
    }

    void finish_pass(SequenceRole role, const sensor::ExposureCheck& exposure) {
        (role == SequenceRole::kMain ? frames_of_main_ : frames_of_lighting_) =
            recorder_->counts().given - given_before_;
        if (std::string advice = exposure.advice(); !advice.empty())
            advice_.push_back(fmt::format("{} sequence: {}", name_of(role), advice));
    }

    /// What a person is to do now. `place`: of the sequence among others; empty where it is alone.
    void instruct(SequenceRole role, const std::string& place) const {
        if (!options_.quiet) print_error("{}{}{}\n", place, place.empty() ? "" : ": ", sensor::instruction(role));
    }

    /// Takes what a capture sends, on its thread.
    std::shared_ptr<RawPass> tapped(cameras::RawCapture& capture) {
        auto pass = std::make_shared<RawPass>(
            recorder_, options_.decoded ? repacker_on(device(), capture.sequence(), capture.name()) : nullptr);
        capture.set_tap([pass](const cameras::RawReading& reading) { pass->take(reading); });
        return pass;
    }

    /// Waits while the capture's tap records, until the user, the time or the capture ends it.
    void watch(cameras::RawCapture& capture, const RawPass& pass, sensor::ExposureCheck& exposure) {
        Progress progress("Recording", std::nullopt, options_.quiet);
        while (const auto frame = capture.next()) {
            const auto* raw = std::get_if<sensor::RecordedFrame>(&*frame);
            if (raw ? is_over(raw->timestamp_s) : is_over_by_our_clock()) break;
            if (raw) check(*raw, capture.sequence(), exposure);
            if (interrupted() || !recorder_->problem().empty() || !pass.problem().empty()) break;
            progress.update(static_cast<uint32_t>(recorder_->counts().given - given_before_), detail(exposure));
        }
    }

    /// `last`: the capture ends with this pass. What waits to be decoded when the camera fails is recorded, too.
    void add_pass(cameras::RawCapture& capture, RawPass& pass, SequenceRole role, bool last, const std::string& place) {
        instruct(role, place);
        begin_pass(role);
        pass.begin(role, capture.sequence());
        sensor::ExposureCheck exposure(role);
        std::optional<CameraWatch> camera_watch;  // who ends the first pass of two wants the camera to go on
        if (last) camera_watch.emplace(capture, interrupt_);
        std::exception_ptr failure;
        try {
            watch(capture, pass, exposure);
        } catch (...) {
            failure = std::current_exception();
        }
        if (last || failure) capture.stop();
        undecoded_ += pass.end();
        finish_pass(role, exposure);
        if (failure) std::rethrow_exception(failure);
    }

    void begin(SequenceRole role, const SequenceInfo& info) {
        begin_pass(role);
        sensor::RecordedSequence sequence;
        sequence.info = info;
        recorder_->begin(role, std::move(sequence));
    }

    /// As fast as it can be read.
    void copy(SequenceRole role, std::unique_ptr<Source> recording, sensor::ExposureCheck& exposure) {
        begin(role, recording->info());
        sensor::PrefetchSource source(std::move(recording));
        const sensor::ReadingTap record = sensor::tap_to(recorder_);
        Progress progress("Recording", source.info().frames, options_.quiet);
        uint32_t done = 0;
        while (std::optional<Reading> reading = source.next()) {
            if (interrupted() || is_over(*reading) || !recorder_->problem().empty()) break;
            check(*reading, exposure);
            record(*reading);
            progress.update(++done, detail(exposure));
        }
    }

    /// The frames of a recording in one file, as they are: pictures, and the raw frames of a camera.
    void copy_rows(SequenceRole role, const std::string& path, sensor::ExposureCheck& exposure) {
        const auto [file, its_role] = sensor::named_sequence(path);
        sensor::RecordingFile recording(file);
        const sensor::RecordedSequence& sequence = recording.sequence(its_role);
        begin_pass(role);
        const bool decodes = options_.decoded && !sensor::holds_pictures(sequence) && cameras::is_kinect2(sequence);
        const auto repacker = decodes ? repacker_on(device(), sequence, "'" + file.string() + "'") : nullptr;
        recorder_->begin(role, decodes ? cameras::kinect2_decoded_sequence(sequence) : sequence);
        Progress progress("Recording", sequence.info.frames, options_.quiet);
        for (uint32_t i = 0; i < *sequence.info.frames; ++i) {
            auto row = recording.read(its_role, i);
            const auto* read = std::get_if<sensor::RecordedFrame>(&row);
            if (interrupted() || !recorder_->problem().empty() || (read && is_over(read->timestamp_s))) break;
            if (read) check(*read, sequence, exposure);
            if (read && decodes) row = repacker->repack(*read);
            if (auto* frame = std::get_if<sensor::RecordedFrame>(&row)) {
                recorder_->record(std::move(*frame));
            } else {
                recorder_->skip(std::get<Skipped>(std::move(row)));
            }
            progress.update(i + 1, detail(exposure));
        }
    }

    /// By its clock: what is looked at may be late, what is recorded is not.
    void play(SequenceRole role, std::unique_ptr<Source> recording, sensor::ExposureCheck& exposure) {
        begin(role, recording->info());
        const std::optional<uint32_t> frames = recording->info().frames;
        sensor::PlayedSource source(std::move(recording), sensor::tap_to(recorder_));
        take(source, frames, exposure);
    }

    /// What the source's tap records meanwhile, until the user, the time or the source ends it.
    void take(sensor::LiveSource& source, std::optional<uint32_t> frames, sensor::ExposureCheck& exposure) {
        Progress progress("Recording", frames, options_.quiet);
        const CameraWatch watch(source, interrupt_);
        while (std::optional<Reading> reading = source.next()) {
            const bool is_frame = std::holds_alternative<Frame>(*reading);
            if (is_frame ? is_over(*reading) : is_over_by_our_clock()) break;
            if (interrupted() || !recorder_->problem().empty()) break;
            check(*reading, exposure);
            progress.update(static_cast<uint32_t>(source.counts().captured), detail(exposure));
        }
        source.stop();
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

    /// Of frames that a camera skipped, which have no time: if it skips them all, the sequence ends even so.
    bool is_over_by_our_clock() {
        const auto now = std::chrono::steady_clock::now();
        if (!first_skipped_) first_skipped_ = now;
        return options_.seconds > 0 && now - *first_skipped_ >= std::chrono::duration<double>(options_.seconds);
    }

    static void check(const Reading& reading, sensor::ExposureCheck& exposure) {
        if (const auto* frame = std::get_if<Frame>(&reading)) exposure.add(frame->color);
    }

    /// What cannot be decoded is reported when the recording is read.
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

    const std::shared_ptr<Device>& device() {
        if (!device_) device_ = std::make_shared<Device>();
        return device_;
    }

    const RecordOptions& options_;
    InterruptGuard interrupt_;
    std::shared_ptr<Device> device_;  ///< null until something is decoded
    std::shared_ptr<sensor::Recorder> recorder_;
    uint64_t undecoded_ = 0;     ///< frames that were dropped because too many waited to be decoded
    uint64_t given_before_ = 0;  ///< to the recorder, when the present sequence began
    std::optional<uint64_t> frames_of_main_, frames_of_lighting_;  ///< empty: not begun
    std::optional<double> first_s_;                                ///< time of the present sequence's first frame
    std::optional<std::chrono::steady_clock::time_point> first_skipped_;  ///< of the present sequence
    std::vector<std::string> advice_;
};

/// What was recorded before the camera failed is kept.
template <class Camera>
Outcome record_from(const RecordOptions& options, Camera& camera) {
    Recording recording(options);
    try {
        recording.add(camera);
    } catch (const std::exception& error) {  // it was unplugged, perhaps
        camera.stop();
        recording.keep(reason_of(error));
    }
    return recording.finish();
}

Outcome record_camera(const RecordOptions& options) {
    if (options.source != kKinect2) {
        if (!options.lighting.empty())
            throw Error("the exposure of ", options.source,
                        " cannot be set, so it has no sequence of low exposure: record one with another camera");
        return record_from(options, *open_other_camera(options.source));
    }
    if (!options.lighting.empty() && options.lighting != options.source)
        throw Error("the sequence of low exposure of a camera comes from the camera itself: --lighting ",
                    options.source, ", not --lighting ", options.lighting);
    return record_from(options, *open_kinect2());
}

/// Wrong paths are found before the file is there.
void expect_readable(const RecordOptions& options, const std::string& source, const std::string& format) {
    if (options.simulate && !open_raw_to_play(source)) {
        sensor::open_sequence(source, format);
    } else if (sensor::names_recording(source)) {
        const auto [file, role] = sensor::named_sequence(source);
        sensor::RecordingFile(file).sequence(role);
    } else {
        sensor::open_sequence(source, format);
    }
}

}  // namespace

Outcome record(const RecordOptions& options) {
    if (is_camera(options.source)) return record_camera(options);
    const std::string lighting =
        options.lighting.empty() ? sensor::lighting_of(options.source).string() : options.lighting;
    std::vector<fs::path> inputs = sequence_inputs(options.source);
    for (fs::path& input : sequence_inputs(lighting)) inputs.push_back(std::move(input));
    sensor::expect_apart(options.out, inputs);
    expect_readable(options, options.source, options.format);
    if (!lighting.empty()) expect_readable(options, lighting, "");
    Recording recording(options);
    try {
        const char* of = lighting.empty() ? "1" : "2";
        recording.add(SequenceRole::kMain, options.source, options.format, fmt::format("sequence 1 of {}", of));
        if (!lighting.empty() && !recording.interrupted())
            recording.add(SequenceRole::kLighting, lighting, "", "sequence 2 of 2");
    } catch (const std::exception& error) {  // the source is gone
        recording.keep(reason_of(error));
    }
    return recording.finish();
}

}  // namespace patina::tools
