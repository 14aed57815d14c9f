#include "tools/sequence_fusion.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "engine/core/printable.h"
#include "sensor/open.h"
#include "sensor/prefetch.h"
#include "sensor/recentred_source.h"
#include "sensor/synthetic/scene_file.h"
#include "tools/preflight.h"
#include "tools/progress.h"
#include "tools/rgbd_frame.h"
#include "tools/run_lights.h"
#include "tools/run_specular.h"
#include "tools/standard_streams.h"

namespace patina::tools {

namespace {

bool is_synthetic(const SequenceOptions& options) { return sensor::scene_name(options.sequence).has_value(); }

std::unique_ptr<sensor::Source> open_recording(const SequenceOptions& options, glm::dvec3 world_offset_m) {
    auto source = sensor::open_sequence(options.sequence, options.format);
    const bool needs_poses = options.poses == PoseMode::kGiven || options.poses == PoseMode::kPrior;
    if (needs_poses && !source->info().has_poses) {
        throw Error("the sequence '", options.sequence, "' has no poses, but --poses ",
                    options.poses == PoseMode::kGiven ? "given" : "prior", " needs them");
    }
    auto ahead = std::make_unique<sensor::PrefetchSource>(std::move(source));
    return std::make_unique<sensor::RecentredSource>(std::move(ahead), world_offset_m);
}

std::unique_ptr<sensor::SyntheticSource> open_synthetic(const SequenceOptions& options, vulkan::Device& device) {
    sensor::Scene scene = sensor::load_scene(*sensor::scene_name(options.sequence), {.seed = options.seed});
    sensor::SyntheticOptions recording;
    if (options.frames > 0) recording.frames = options.frames;
    return std::make_unique<sensor::SyntheticSource>(device, std::move(scene), recording);
}

bool needs_reflectance(const SequenceOptions& options) {
    return !options.reflectance_for.empty() || options.truth_materials || options.settings.reflectance;
}

[[noreturn]] void fail_without_lights(const SequenceOptions& options, const std::string& because = "") {
    throw Error(options.reflectance_for.empty() ? "reflectance" : options.reflectance_for,
                " needs lights: give --lights FILE or --lighting SEQUENCE or --lighting self",
                because.empty() ? "" : "; ", because);
}

/// Throws Error where there is no light for what was asked. After a search that failed a run goes on without, but not
/// what shows nothing else.
void check_light(const SequenceOptions& options, const LightOfRun& light) {
    if (shines(light.illumination) || !needs_reflectance(options)) return;
    const bool searched = !light.shortfalls.empty();
    if (!searched) fail_without_lights(options, light.none_because);
    if (!options.reflectance_for.empty())
        fail_without_lights(options, fmt::format("{}", fmt::join(light.shortfalls, "; ")));
}

/// With light, reflectance is estimated; without, there is nothing to estimate it from. Ambient light alone tells
/// nothing of gloss.
ReconstructionSettings settings_of(const SequenceOptions& options, const sensor::SequenceInfo& info,
                                   const Illumination& light, std::optional<NetworkDescription> network) {
    ReconstructionSettings settings = options.settings;
    const bool drifts = options.gains == GainMode::kAuto && !info.exposure_known && settings.fusion.color;
    if (options.gains == GainMode::kOff) settings.gains.reset();
    if ((drifts || options.gains == GainMode::kOn) && !settings.gains) settings.gains.emplace();
    if (!shines(light)) {
        settings.reflectance.reset();
    } else if (!settings.reflectance) {
        settings.reflectance.emplace();
    }
    if (options.labels == "off") {
        settings.segmentation.reset();
    } else if (!settings.segmentation) {
        settings.segmentation.emplace();
    }
    if (options.poses == PoseMode::kGiven || (options.poses == PoseMode::kAuto && info.has_poses)) {
        settings.tracking.reset();
        settings.keyframes.reset();
    } else {
        if (!settings.tracking) settings.tracking.emplace();
        if (!settings.keyframes) settings.keyframes.emplace();
        if (settings.gains) settings.keyframes->tests = KeyframeTests::kDepth;
    }
    if (settings.segmentation) settings.segmentation->given = options.labels == "truth";
    set_specular(settings, options, std::move(network));
    if (light.lights.empty() && options.specular.empty()) {
        settings.specular.reset();
        settings.network.reset();
    }
    return settings;
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

SequenceFusion::SequenceFusion(const SequenceOptions& options, const InterruptGuard& interrupt)
    : options_(options), interrupt_(interrupt), held_out_(options.hold_out) {
    // A recording is opened before the device, and a network read before lights are looked for, so that a wrong path
    // or option is told at once.
    const sensor::SyntheticSource* scene = nullptr;
    if (!is_synthetic(options)) {
        Preflight ahead = look_ahead(options);
        world_offset_m_ = ahead.world_offset_m;
        source_ = open_recording(options, world_offset_m_);
        if (!options.quiet)
            for (const std::string& warning : ahead.warnings) print_error("warning: {}\n", printable(warning));
    }
    if (needs_reflectance(options) && lights_source(options) == LightsSource::kNone) fail_without_lights(options);
    std::optional<NetworkDescription> network = read_network(options);
    take_light(light_of(options, world_offset_m_));
    device_.emplace(options.device);
    if (is_synthetic(options)) {
        auto rendered = open_synthetic(options, *device_);
        scene = rendered.get();
        source_ = std::move(rendered);
    }
    truth_.emplace(options.sequence, scene);
    info_ = source_->info();
    if (options.frames > 0) info_.frames = std::min(info_.frames, options.frames);
    if (!scene) inspector_.emplace(info_, convention_check(options));
    reconstruction_.emplace(*device_, settings_of(options, info_, illumination_, std::move(network)));
    if (reconstruction_->reflectance()) prepare_reflectance(*reconstruction_->reflectance());
}

void SequenceFusion::take_light(LightOfRun light) {
    check_light(options_, light);
    illumination_ = std::move(light.illumination);
    lights_ = point_lights(illumination_);
    shortfalls_ = std::move(light.shortfalls);
    if (!light.none_because.empty()) {
        materials_missing_ = "no materials, only geometry and colours: " + light.none_because;
    } else if (lights_.empty()) {
        materials_missing_ = "materials hold a diffuse albedo alone: there is ambient light, but no lamp to show gloss";
    }
}

void SequenceFusion::prepare_reflectance(ReflectanceModel& reflectance) {
    reflectance.set_lights(lights_, illumination_.ambient);
    if (!options_.truth_materials) return;
    for (const sensor::Material& m : truth_->materials())
        reflectance.set_material(m.id, glm::vec3(m.ks), static_cast<float>(m.alpha));
}

void SequenceFusion::fuse_all(const std::function<void(const sensor::Frame&)>& after_frame) {
    Progress progress(info_.frames, options_.quiet);
    std::set<std::string> warned;
    if (const auto warning = reach_warning()) progress.say("warning: " + *warning);
    for (uint32_t done = 0; done < info_.frames; ++done) {
        stop_if_interrupted();
        auto reading = source_->next();
        if (!reading) break;
        ledger_.note(*reading);
        if (inspector_) inspector_->add(*reading);
        if (const auto* skipped = std::get_if<sensor::Skipped>(&*reading)) {
            progress.say("frame " + std::to_string(skipped->index) + " is skipped: " + skipped->reason);
        } else {
            fuse(std::get<sensor::Frame>(*reading), after_frame);
        }
        for (const PoolState& pool : reconstruction_->recent_pools()) {
            if (!pool.is_full() || pool.limit == PoolLimit::kNone || !warned.insert(pool.name).second) continue;
            progress.say("warning: " + full_pool_warning(pool) + "; what does not fit is left out from here on");
        }
        progress.update(done + 1, fmt::format("{} blocks", blocks_used()));
    }
    reconstruction_->wait();
    if (const auto discrepancy = ledger_.discrepancy(info_)) throw Error(*discrepancy);
    if (ledger_.used() == 0) {
        throw Error("no frame of '", options_.sequence,
                    "' could be used; the first was skipped because: ", ledger_.skipped().front().reason);
    }
}

void SequenceFusion::fuse(sensor::Frame& frame, const std::function<void(const sensor::Frame&)>& after_frame) {
    if (!frame.world_from_camera && !tracks()) {
        ledger_.skip(frame.index, fmt::format("frame {} has no pose", frame.index));
        return;
    }
    RgbdFrame rgbd = to_rgbd(info_, frame);
    Image<uint16_t> labels;
    if (options_.labels == "truth") {
        try {
            labels = truth_->labels(frame.index, info_.depth.extent);
        } catch (const Error& error) {
            ledger_.skip(frame.index, error.what());
            return;
        }
        rgbd.labels = labels.pixels();
    }
    if (!poses_.empty()) rgbd.shutter_share = shutter_share(info_, frame, poses_.back().timestamp_s);
    rgbd.held_out = held_out_.wants(frame.index);
    const uint32_t order = reconstruction_->frames();
    if (!add(rgbd, frame)) return;
    if (rgbd.held_out) held_out_.keep(frame, order);
    ledger_.use(frame.index);
    used_.push_back(frame.index);
    poses_.push_back({frame.timestamp_s, *frame.world_from_camera});
    after_frame(frame);
}

bool SequenceFusion::add(RgbdFrame& rgbd, sensor::Frame& frame) {
    if (!tracks()) return reconstruction_->add(rgbd);
    if (!first_given_) first_given_ = frame.world_from_camera;
    rgbd.world_from_depth = first_given_.value_or(RigidTransform(1.0));
    if (options_.poses == PoseMode::kPrior) rgbd.time.prior = frame.world_from_camera;
    const bool fused = reconstruction_->add(rgbd);
    const TrackingReport& report = *reconstruction_->tracking_report();
    tracked_.push_back({frame.index, report});
    frame.world_from_camera = report.world_from_depth;
    if (!fused) {
        ledger_.skip(frame.index, fmt::format("frame {} was not fused, tracking was {}: {}", frame.index,
                                              name_of(report.state), report.reason));
    }
    return fused;
}

void SequenceFusion::stop_if_interrupted() {
    if (!interrupt_.requested()) return;
    reconstruction_->wait();
    throw Interrupted("interrupted after ", ledger_.read(), " of ", info_.frames, " frames");
}

std::string SequenceFusion::gains_text() {
    std::string lines = "# index, then the gains of red, green and blue over the first frame's\n";
    const auto gains = reconstruction_->gains();
    for (size_t i = 0; i < gains.size(); ++i) {
        const glm::vec4 gain = gains[i].gain;
        lines += fmt::format("{} {:.4f} {:.4f} {:.4f}\n", used_[i], gain.r, gain.g, gain.b);
    }
    return lines;
}

std::optional<std::string> SequenceFusion::reach_warning() const {
    const float reach_m = reconstruction_->reach_m(info_.depth);
    const double wanted_m = std::min<double>(settings().fusion.max_depth_m, info_.max_metres);
    if (reach_m >= wanted_m) return std::nullopt;
    return fmt::format(
        "with voxels of {} m the view reaches {:.2f} m, not {:.2f} m: what lies farther is left out; raise "
        "map.voxel_m, or lower fusion.max_depth_m",
        settings().map.voxel_m, reach_m, wanted_m);
}

std::vector<std::string> SequenceFusion::warnings() const {
    std::vector<std::string> all;
    if (const auto reach = reach_warning()) all.push_back(*reach);
    if (inspector_) {
        for (std::string& implausible : inspector_->report().warnings) all.push_back(std::move(implausible));
    }
    return all;
}

std::vector<TimedPose> SequenceFusion::world_poses() const {
    std::vector<TimedPose> poses = poses_;
    for (TimedPose& pose : poses) pose.world_from_camera[3] += glm::dvec4(world_offset_m_, 0);
    return poses;
}

std::vector<PoolState> SequenceFusion::pools() {
    try {
        return reconstruction_->pools();
    } catch (const std::exception&) {
        return reconstruction_->recent_pools();
    }
}

uint32_t SequenceFusion::blocks_used() {
    const gpu::MapCounters& counters = reconstruction_->counters();
    return counters.capacity - counters.free_blocks;
}

}  // namespace patina::tools
