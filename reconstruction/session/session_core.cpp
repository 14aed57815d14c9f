#include "reconstruction/session/session_core.h"

#include <algorithm>

#include <fmt/format.h>

#include "cameras/open_sequence.h"
#include "reconstruction/api/access.h"
#include "reconstruction/lights/surface_samples.h"
#include "reconstruction/session/choices.h"
#include "reconstruction/session/choose_settings.h"
#include "reconstruction/session/preflight.h"
#include "reconstruction/session/rgbd_frame.h"
#include "reconstruction/session/session_lights.h"
#include "reconstruction/session/session_materials.h"
#include "reconstruction/session/session_state.h"
#include "reconstruction/session/warm_up.h"
#include "scenes/files/scene_file.h"
#include "scenes/render/synthetic_source.h"
#include "sensor/look_ahead_source.h"
#include "sensor/recentred_source.h"
#include "sensor/repeated.h"

namespace patina {

namespace {

std::string sequence_name(const SessionOptions& options, const SequenceInfo& info) {
    return options.sequence.empty() ? info.name : options.sequence;
}

void expect_poses(const SessionOptions& options, const Source& source) {
    if (source.info().has_poses) return;
    const bool prior = options.poses == Poses::kPrior;
    if (!prior && options.poses != Poses::kGiven) return;
    throw Error(hinted(text("'", sequence_name(options, source.info()), "' has no poses, but ",
                            prior ? "tracking was to start from them" : "they were to be used as given",
                            "; track the camera without them"),
                       options.hints.track));
}

std::unique_ptr<scenes::SyntheticSource> open_scene(const SessionOptions& options, vulkan::Device& device) {
    scenes::SyntheticScene scene = scenes::load_scene(*synthetic_scene(options), {.seed = options.seed});
    scenes::SyntheticOptions recording;
    if (options.frames > 0) recording.frames = options.frames;
    return std::make_unique<scenes::SyntheticSource>(device, std::move(scene), recording);
}

bool needs_reflectance(const SessionOptions& options) {
    return !options.reflectance_for.empty() || options.materials == Materials::kTruth ||
           Access::values(options.settings).reflectance;
}

[[noreturn]] void fail_without_lights(const SessionOptions& options, const std::string& because = "") {
    throw Error(options.reflectance_for.empty() ? "reflectance" : options.reflectance_for,
                " needs lights: ", give_lights(options), because.empty() ? "" : "; ", because);
}

/// Throws Error where there is no light for what was asked. After a search that failed a run goes on without, but not
/// what shows nothing else.
void check_light(const SessionOptions& options, const SessionLight& light) {
    if (shines(light.illumination) || !needs_reflectance(options)) return;
    const bool searched = !light.shortfalls.empty();
    if (!searched) fail_without_lights(options, light.none_because);
    if (!options.reflectance_for.empty())
        fail_without_lights(options, fmt::format("{}", fmt::join(light.shortfalls, "; ")));
}

}  // namespace

std::string full_pool_warning(const PoolState& pool) {
    const char* reason = "";
    switch (pool.limit) {
        case PoolLimit::kNone: reason = " and had no frame left to grow in"; break;
        case PoolLimit::kSetting: reason = ", the limit in the settings"; break;
        case PoolLimit::kBuffers: reason = ", all that the device's buffers hold"; break;
        case PoolLimit::kMemory: reason = ", all that the device has memory for"; break;
    }
    return fmt::format("the pool of {} is full: {} requests were refused, it holds {}{}", pool.name, pool.refused,
                       pool.capacity, reason);
}

/// Wrong paths and options are found before lights are looked for, which takes time.
SessionCore::SessionCore(vulkan::Device& device, const SessionOptions& options, std::unique_ptr<Source> source)
    : device_(device), options_(options) {
    if (options_.hold_out == 1) throw Error("every frame is held out, which leaves none for a model");
    if (!(options_.white_albedo > 0 && options_.white_albedo <= 1))
        throw Error("the albedo of white surfaces is ", options_.white_albedo, ", it must be above 0 and at most 1");
    if (!options_.map.empty()) open_map();
    const std::shared_ptr<MapFile> earlier = earlier_map();
    std::optional<DetailChoice> kept_detail;
    if (earlier && options_.detail == Detail::kAuto) {
        kept_detail = detail_in(*earlier);
        options_.detail = kept_detail->level;
    }
    open(std::move(source), earlier ? std::optional(world_offset_in(device_, *earlier)) : std::nullopt);
    if (kept_detail) detail_ = *std::move(kept_detail);
    options_.detail = detail_.level;
    set_detail(options_.settings, detail_.level);
    if (!earlier && needs_reflectance(options_) && lights_source(options_) == LightsSource::kNone)
        fail_without_lights(options_);
    std::optional<NetworkDescription> network = read_network(options_);
    take_light(earlier ? light_in(device_, *earlier) : light_of(device_, options_, world_offset_m_));
    if (options_.extends.empty() && lights_source(options_) == LightsSource::kSurroundings && is_light_assumed())
        seen_.emplace(options_.white_albedo);
    start_pipeline(std::move(network));
    if (!earlier) add_low_exposure(device_, *pipeline_, options_, world_offset_m_);
    if (options_.resume) {
        resume();
    } else if (earlier) {
        extend(*earlier);
    }
    if (const auto warning = reach_warning()) report(options_.callbacks, "warning: " + *warning);
}

/// In the world of a map that it goes on from, where `world_offset_m` is given.
void SessionCore::open(std::unique_ptr<Source> given, const std::optional<glm::dvec3>& world_offset_m) {
    std::optional<DetailChoice> seen_detail;
    if (given) {
        source_ = std::move(given);
        expect_poses(options_, *source_);
        world_offset_m_ = world_offset_m.value_or(glm::dvec3(0));
        if (world_offset_m_ != glm::dvec3(0))
            source_ = std::make_unique<sensor::RecentredSource>(std::move(source_), world_offset_m_);
    } else if (synthetic_scene(options_)) {
        auto rendered = open_scene(options_, device_);
        scene_ = rendered.get();
        source_ = std::move(rendered);
    } else {
        auto recording = cameras::open_sequence_ahead(device_, options_.sequence, options_.format);
        expect_poses(options_, *recording);
        auto ahead = std::make_unique<sensor::LookAheadSource>(std::move(recording));
        Preflight seen = look_ahead(*ahead, options_, cameras::payload_decoders(device_));
        seen_detail = std::move(seen.detail);
        world_offset_m_ = world_offset_m.value_or(seen.world_offset_m);
        for (const std::string& warning : seen.warnings) report(options_.callbacks, "warning: " + warning);
        source_ = std::make_unique<sensor::RecentredSource>(std::move(ahead), world_offset_m_);
    }
    truth_.emplace(options_.sequence, scene_);
    info_ = source_->info();
    detail_ = seen_detail ? *std::move(seen_detail) : choose_detail(options_, info_, std::nullopt);
    if (options_.frames > 0 && info_.frames) info_.frames = std::min(*info_.frames, options_.frames);
    if (!scene_) inspector_.emplace(info_, convention_check(options_));
}

void SessionCore::start_pipeline(std::optional<NetworkDescription> network) {
    const ReconstructionSettings settings = choose_settings(options_, info_, illumination_, std::move(network));
    if (!info_.frames) {  // a camera does not wait
        report(options_.callbacks, "the device builds its pipelines; then the source begins");
        warm_up(device_, settings, info_, illumination_, [this] { return stop_requested(options_.callbacks); });
    }
    pipeline_.emplace(device_, settings);
    if (!pipeline_->reflectance()) return;
    pipeline_->set_lights(lights_of(illumination_), illumination_.ambient);
    if (options_.materials != Materials::kTruth) return;
    for (const sensor::Material& m : truth_->materials())
        pipeline_->set_material(m.id, glm::vec3(m.ks), static_cast<float>(m.alpha));
}

void SessionCore::take_light(SessionLight light) {
    check_light(options_, light);
    illumination_ = std::move(light.illumination);
    shortfalls_ = std::move(light.shortfalls);
    no_light_because_ = std::move(light.none_because);
}

std::string SessionCore::materials_missing() const {
    if (!no_light_because_.empty()) return "no materials, only geometry and colours: " + no_light_because_;
    if (!illumination_.lights.empty()) return "";
    const std::string without_lamps = "materials hold a diffuse albedo, and gloss of mirrors at most: ";
    if (!looks_for_light()) return without_lamps + "no lamp is known to show other gloss; " + give_lights(options_);
    if (illumination_.found_by == "lighting sequence")
        return without_lamps + "the lighting sequence shows no lamp, and what it would light tells of none";
    return without_lamps + "what lamps would light tells of none; " + give_lights(options_);
}

bool SessionCore::step() {
    fused_.reset();
    held_out_.reset();
    stop_if_interrupted();
    const uint32_t limit = info_.frames.value_or(options_.frames);
    std::optional<Reading> reading;
    if (limit == 0 || ledger_.read() < limit) reading = source_->next();
    if (!reading) {
        ended_ = true;
        return false;
    }
    ledger_.note(*reading);
    if (!scene_ && ledger_.read() <= 1) {
        const double reach_m = std::min<double>(pipeline_->reach_m(info_.depth), info_.max_metres);
        report(options_.callbacks, sentence_of(detail_, options_.settings, reach_m));
    }
    const std::optional<std::string> repeated = repeats_last(*reading);
    if (inspector_) inspector_->add(*reading);
    if (repeated) {
        repeat(std::get<Frame>(*reading).index, *repeated);
    } else if (const auto* skipped = std::get_if<Skipped>(&*reading)) {
        last_ = FrameResult{.state = TrackingState::kLost, .reason = skipped->reason};
        if (!skipped->dropped)
            report(options_.callbacks, fmt::format("frame {} is skipped: {}", skipped->index, skipped->reason));
    } else {
        fuse(std::get<Frame>(*std::move(reading)));
    }
    report_progress();
    return true;
}

void SessionCore::report_progress() {
    const PipelineCounters counters = pipeline_->counters();
    for (const PoolState& pool : counters.pools) {
        if (!pool.is_full() || pool.limit == PoolLimit::kNone || !full_pools_.insert(pool.name).second) continue;
        report(options_.callbacks,
               "warning: " + full_pool_warning(pool) + "; what does not fit is left out from here on");
    }
    if (const std::string problem = pipeline_->stream_problem(); stream_problem_.empty() && !problem.empty()) {
        stream_problem_ = problem;
        report(options_.callbacks, "warning: " + problem);
    }
    report(options_.callbacks, {.task = "frames",
                                .done = ledger_.read(),
                                .total = info_.frames,
                                .detail = fmt::format("{} blocks", counters.map.capacity - counters.map.free_blocks)});
}

void SessionCore::end() {
    pipeline_->wait();
    if (const auto discrepancy = ledger_.discrepancy(info_)) throw Error(*discrepancy);
    expect_frames();
    look_for_last_light();
}

void SessionCore::expect_frames() const {
    if (ledger_.used() > 0) return;
    throw Error("no frame of '", sequence_name(options_, info_), "' could be used; ",
                ledger_.skipped().empty() ? "the source ended before its first one"
                                          : "the first was skipped because: " + ledger_.skipped().front().reason);
}

void SessionCore::skip(uint32_t index, std::string reason) {
    last_ = FrameResult{.state = TrackingState::kLost, .reason = reason};
    ledger_.skip(index, std::move(reason));
}

/// Synthetic frames are never alike.
std::optional<std::string> SessionCore::repeats_last(const Reading& reading) const {
    const Frame* before = inspector_ ? inspector_->last() : nullptr;
    const auto* frame = std::get_if<Frame>(&reading);
    return before && frame ? sensor::repeats(*frame, *before) : std::nullopt;
}

void SessionCore::repeat(uint32_t index, std::string reason) {
    last_ = FrameResult{.fused = false, .reason = std::move(reason)};
    ledger_.repeat(index);
    repeated_.push_back(index);
}

void SessionCore::hold_out(Frame frame) {
    last_ = FrameResult{.fused = false, .reason = "held out", .world_from_depth = *frame.world_from_camera};
    ledger_.use(frame.index);
    held_out_indices_.push_back(frame.index);
    held_out_ = std::move(frame);
}

void SessionCore::fuse(Frame frame) {
    if (!frame.world_from_camera && !tracks())
        return skip(frame.index, fmt::format("frame {} has no pose", frame.index));
    if (is_held_out(frame.index, options_.hold_out) && !tracks()) return hold_out(std::move(frame));
    RgbdFrame rgbd = to_rgbd(info_, frame);
    Image<uint16_t> labels;
    if (options_.labels == Labels::kTruth) {
        try {
            labels = truth_->labels(frame.index, info_.depth.extent);
        } catch (const Error& error) {
            return skip(frame.index, error.what());
        }
        rgbd.labels = labels.pixels();
    }
    if (!poses_.empty()) rgbd.shutter_share = shutter_share(info_, frame, poses_.back().timestamp_s);
    rgbd.only_track = is_held_out(frame.index, options_.hold_out);
    if (const auto ambient = see_brightness(frame)) assume_light(*ambient);
    if (!add(rgbd, frame)) return;
    last_ = FrameResult{.fused = true, .reason = "", .world_from_depth = *frame.world_from_camera};
    ledger_.use(frame.index);
    used_.push_back(frame.index);
    poses_.push_back({frame.timestamp_s, *frame.world_from_camera});
    fused_ = std::move(frame);
    look_for_light();
}

/// Sets the frame's pose where it is tracked.
bool SessionCore::add(RgbdFrame& rgbd, Frame& frame) {
    if (!tracks()) return pipeline_->add(rgbd);
    if (!first_given_) first_given_ = frame.world_from_camera;
    rgbd.world_from_depth = first_given_.value_or(RigidTransform(1.0));
    if (options_.poses == Poses::kPrior) rgbd.time.prior = frame.world_from_camera;
    const bool fused = pipeline_->add(rgbd);
    const TrackingReport& report = *pipeline_->tracking_report();
    tracked_.push_back({frame.index, report});
    frame.world_from_camera = report.world_from_depth;
    if (rgbd.only_track && !fused && report.state == TrackingState::kTracking) {
        hold_out(std::move(frame));
        return false;
    }
    if (!fused) {
        ledger_.skip(frame.index, fmt::format("frame {} was not fused, tracking was {}: {}", frame.index,
                                              name_of(report.state), report.reason));
        last_ = FrameResult{false, report.state, report.reason, report.world_from_depth};
    }
    return fused;
}

void SessionCore::stop_if_interrupted() {
    if (!stop_requested(options_.callbacks)) return;
    pipeline_->wait();
    throw Interrupted("interrupted after ", ledger_.read(), info_.frames ? text(" of ", *info_.frames) : "", " frames");
}

std::string SessionCore::gains_text() {
    std::string lines = "# index, then the gains of red, green and blue over the first frame's\n";
    const auto gains = pipeline_->gains();
    const size_t earlier = pipeline_->frames() - used_.size();  // those of a map that is extended
    for (size_t i = earlier; i < gains.size(); ++i) {
        const glm::vec4 gain = gains[i].gain;
        lines += fmt::format("{} {:.4f} {:.4f} {:.4f}\n", used_[i - earlier], gain.r, gain.g, gain.b);
    }
    return lines;
}

std::optional<std::string> SessionCore::reach_warning() const {
    const Settings& given = options_.settings;
    if (!Access::is_given(given, "fusion.max_depth_m") && !Access::is_given(given, "map.voxel_m")) return std::nullopt;
    const float reach_m = pipeline_->reach_m(info_.depth);
    const double wanted_m = std::min<double>(settings().fusion.max_depth_m, info_.max_metres);
    if (reach_m >= wanted_m) return std::nullopt;
    return fmt::format(
        "with voxels of {} m the view reaches {:.2f} m, not {:.2f} m: what lies farther is left out; raise "
        "map.voxel_m, or lower fusion.max_depth_m",
        settings().map.voxel_m, reach_m, wanted_m);
}

std::vector<std::string> SessionCore::warnings() const {
    std::vector<std::string> all;
    if (const auto reach = reach_warning()) all.push_back(*reach);
    const std::string problem = pipeline_->stream_problem();
    if (!problem.empty() || !stream_problem_.empty()) all.push_back(problem.empty() ? stream_problem_ : problem);
    if (inspector_) {
        for (std::string& implausible : inspector_->report().warnings) all.push_back(std::move(implausible));
    }
    return all;
}

std::vector<TimedPose> SessionCore::world_poses() const {
    std::vector<TimedPose> poses = poses_;
    for (TimedPose& pose : poses) pose.world_from_camera[3] += glm::dvec4(world_offset_m_, 0);
    return poses;
}

std::vector<PoolState> SessionCore::pools() {
    try {
        pipeline_->wait();
    } catch (const std::exception&) {
        // Of a device that was lost the host knows what it knew before.
    }
    return pipeline_->counters().pools;
}

Lighting SessionCore::lighting() const {
    Lighting lighting = lighting_of(illumination_);
    for (Light& light : lighting.lights) light.position_m -= world_offset_m_;
    return lighting;
}

Scene SessionCore::scene_without_surface() const {
    Scene scene;
    scene.name = info_.name;
    scene.lighting = lighting();
    scene.trajectory = poses_;
    scene.world_offset_m = world_offset_m_;
    if (!settings().tracking) scene.gravity = info_.gravity;  // else the world is another than that of the poses
    return scene;
}

void SessionCore::add_segments(Scene& scene) {
    scene.reflectance.segments = pipeline_->segments();
    scene.segment_names = segment_names();
}

std::vector<std::string> SessionCore::segment_names() const {
    return options_.labels == Labels::kTruth ? truth_->names() : std::vector<std::string>();
}

Scene SessionCore::scene() {
    Scene scene = scene_without_surface();
    scene.mesh = pipeline_->extract_surface();
    scene.reflectance = pipeline_->sample_reflectance(scene.mesh);
    scene.far_field = pipeline_->far_field();
    scene.lighting.windows = pipeline_->windows(scene.trajectory, scene.lighting.lights);
    scene.segment_names = segment_names();
    return scene;
}

}  // namespace patina
