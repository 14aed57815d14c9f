#include "reconstruction/session/preflight.h"

#include <algorithm>
#include <cmath>

#include "reconstruction/api/access.h"
#include "reconstruction/session/choices.h"
#include "sensor/files/text_file.h"
#include "sensor/inspect.h"
#include "sensor/open.h"
#include "sensor/plausibility.h"
#include "sensor/recentred_source.h"

namespace patina {

namespace {

/// A second of video: enough for the scale, and often for the poses. The rest is judged as it is fused.
constexpr uint32_t kFrames = 30;

/// Of a recording, whose length is known.
uint32_t frames_to_take(const SessionOptions& options, const SequenceInfo& info) {
    const uint32_t all = info.frames.value_or(kFrames);
    return options.frames > 0 ? std::min(all, options.frames) : all;
}

/// As far as surfaces are fused.
double reach_of(const SessionOptions& options, Detail level, const SequenceInfo& info) {
    Settings settings = options.settings;
    set_detail(settings, level);
    return std::min<double>(Access::values(settings).fusion.max_depth_m, info.max_metres);
}

bool has_reading_within(const Frame& frame, double metres_per_unit, double far_m) {
    const auto near_enough = [far_m](auto reading, double metres) {
        const double z = static_cast<double>(reading) * metres;
        return z > 0 && z <= far_m;  // false for what is not a number
    };
    if (const auto* units = std::get_if<Image<uint16_t>>(&frame.depth))
        return std::ranges::any_of(units->pixels(), [&](uint16_t r) { return near_enough(r, metres_per_unit); });
    const auto& metres = std::get<Image<float>>(frame.depth);
    return std::ranges::any_of(metres.pixels(), [&](float r) { return near_enough(r, 1); });
}

[[noreturn]] void fail_out_of_reach(const SessionOptions& options, double far_m, const sensor::SequenceReport& report) {
    std::string reason;
    if (report.depth.valid_share == 0) {
        reason = "no pixel has a reading at all";
    } else {
        reason = sensor::implausible_scale(report).value_or(
            text("their median is ", sensor::fixed(report.depth.median_m, 2), " m"));
    }
    throw Error("no depth reading of '", options.sequence, "' lies within ", far_m,
                " m, as far as surfaces are fused (fusion.max_depth_m and the sequence's own limit): ", reason);
}

}  // namespace

sensor::ConventionCheck convention_check(const SessionOptions& options) {
    return uses_given_poses(options) ? sensor::ConventionCheck::kOn : sensor::ConventionCheck::kOff;
}

Preflight look_ahead(sensor::LookAheadSource& source, const SessionOptions& options,
                     const sensor::MakePayloadDecoder& make_decoder) {
    const SequenceInfo& info = source.info();
    const uint32_t frames = frames_to_take(options, info);
    // An inspector spreads its samples over the frames that it expects: one sees the first alone, one all that are read
    // where no reading is near enough.
    SequenceInfo first_info = info, all_info = info;
    first_info.frames = std::min(frames, kFrames);
    all_info.frames = frames;
    sensor::Inspector first(first_info, convention_check(options)), all(all_info, sensor::ConventionCheck::kOff);
    Preflight found;
    for (uint32_t i = 0; i < *first_info.frames; ++i) {
        const Reading* reading = source.peek(i);
        if (!reading) break;
        first.add(*reading);
    }
    const sensor::SequenceReport report = first.report();
    found.warnings = report.warnings;
    found.detail = choose_detail(options, info, report.depth);
    const double far_m = reach_of(options, found.detail.level, info);
    bool any_pose = false, any_frame = false, any_reading = false;
    const auto look_at = [&](const Reading& reading) {
        if (!any_reading) all.add(reading);
        const auto* frame = std::get_if<Frame>(&reading);
        if (!frame) return;
        any_frame = true;
        any_reading = any_reading || has_reading_within(*frame, info.metres_per_unit, far_m);
        if (!any_pose && frame->world_from_camera)
            found.world_offset_m = sensor::world_offset_m(glm::dvec3((*frame->world_from_camera)[3]));
        any_pose = any_pose || frame->world_from_camera.has_value();
    };
    for (uint32_t i = 0; i < *first_info.frames; ++i) {
        const Reading* reading = source.peek(i);
        if (!reading) break;
        look_at(*reading);
    }
    const auto goes_on = [&] { return (any_frame && !any_reading) || (info.has_poses && !any_pose); };
    if (frames > kFrames && goes_on()) {
        const auto again = sensor::open_sequence(options.sequence, options.format, make_decoder);
        for (uint32_t i = 0; i < frames && (i < kFrames || goes_on()); ++i) {
            const auto reading = again->next();
            if (!reading) break;
            if (i >= kFrames) look_at(*reading);
        }
    }
    if (any_frame && !any_reading) fail_out_of_reach(options, far_m, all.report());
    return found;
}

glm::dvec3 world_offset_of(const std::string& sequence, const std::string& format,
                           const sensor::MakePayloadDecoder& make_decoder) {
    const auto source = sensor::open_sequence(sequence, format, make_decoder);
    if (!source->info().has_poses) return glm::dvec3(0);
    while (const auto reading = source->next()) {
        const auto* frame = std::get_if<Frame>(&*reading);
        if (frame && frame->world_from_camera)
            return sensor::world_offset_m(glm::dvec3((*frame->world_from_camera)[3]));
    }
    return glm::dvec3(0);
}

}  // namespace patina
