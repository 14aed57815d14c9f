#include "tools/sequence_fusion.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "sensor/open.h"
#include "sensor/prefetch.h"
#include "sensor/synthetic/scene_file.h"
#include "tools/progress.h"
#include "tools/rgbd_frame.h"
#include "tools/run_lights.h"
#include "tools/run_specular.h"

namespace patina::tools {

namespace {

constexpr std::string_view kSynthetic = "synthetic:";
constexpr uint32_t kSyntheticFrames = 120;

bool is_synthetic(const SequenceOptions& options) { return options.sequence.starts_with(kSynthetic); }

std::unique_ptr<sensor::Source> open_recording(const SequenceOptions& options) {
    auto source = sensor::open_sequence(options.sequence, options.format);
    const bool needs_poses = options.poses == PoseMode::kGiven || options.poses == PoseMode::kPrior;
    if (needs_poses && !source->info().has_poses) {
        throw Error("the sequence '", options.sequence, "' has no poses, but --poses ",
                    options.poses == PoseMode::kGiven ? "given" : "prior", " needs them");
    }
    return std::make_unique<sensor::PrefetchSource>(std::move(source));
}

std::unique_ptr<sensor::SyntheticSource> open_synthetic(const SequenceOptions& options, vulkan::Device& device) {
    const uint32_t frames = options.frames > 0 ? options.frames : kSyntheticFrames;
    return std::make_unique<sensor::SyntheticSource>(device,
                                                     sensor::load_scene(options.sequence.substr(kSynthetic.size())),
                                                     sensor::SyntheticOptions{.frames = frames});
}

/// With lights, reflectance is estimated; without, there is nothing to estimate it from.
ReconstructionSettings settings_of(const SequenceOptions& options, const sensor::SequenceInfo& info,
                                   const std::vector<PointLight>& lights, std::optional<NetworkDescription> network) {
    ReconstructionSettings settings = options.settings;
    const bool drifts = options.gains == GainMode::kAuto && !info.exposure_known && settings.fusion.color;
    if (options.gains == GainMode::kOff) settings.gains.reset();
    if ((drifts || options.gains == GainMode::kOn) && !settings.gains) settings.gains.emplace();
    if (lights.empty()) {
        const bool asked = options.truth_materials || settings.reflectance;
        if (asked)
            throw Error("reflectance needs lights: give --lights FILE or --lighting SEQUENCE or --lighting self");
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
    return settings;
}

}  // namespace

SequenceFusion::SequenceFusion(const SequenceOptions& options, const InterruptGuard& interrupt)
    : options_(options), interrupt_(interrupt), held_out_(options.hold_out) {
    // A recording is opened before the device, and a network read before lights are looked for, so that a wrong path
    // is told at once.
    const sensor::SyntheticSource* scene = nullptr;
    if (!is_synthetic(options)) source_ = open_recording(options);
    std::optional<NetworkDescription> network = read_network(options);
    illumination_ = lights_of(options);
    lights_ = point_lights(illumination_);
    device_.emplace(options.device);
    if (is_synthetic(options)) {
        auto rendered = open_synthetic(options, *device_);
        scene = rendered.get();
        source_ = std::move(rendered);
    }
    truth_.emplace(options.sequence, scene);
    info_ = source_->info();
    if (options.frames > 0) info_.frames = std::min(info_.frames, options.frames);
    reconstruction_.emplace(*device_, settings_of(options, info_, lights_, std::move(network)));
    if (reconstruction_->reflectance()) prepare_reflectance(*reconstruction_->reflectance());
}

void SequenceFusion::prepare_reflectance(ReflectanceModel& reflectance) {
    reflectance.set_lights(lights_, illumination_.ambient);
    if (!options_.truth_materials) return;
    for (const sensor::Material& m : truth_->materials())
        reflectance.set_material(m.id, glm::vec3(m.ks), static_cast<float>(m.alpha));
}

void SequenceFusion::fuse_all(const std::function<void(const sensor::Frame&)>& after_frame) {
    Progress progress(info_.frames, options_.quiet);
    bool warned_full = false, warned_observations = false;
    if (const auto warning = reach_warning()) progress.say("warning: " + *warning);
    for (uint32_t done = 0; done < info_.frames; ++done) {
        stop_if_interrupted();
        auto reading = source_->next();
        if (!reading) break;
        ledger_.note(*reading);
        if (const auto* skipped = std::get_if<sensor::Skipped>(&*reading)) {
            progress.say("frame " + std::to_string(skipped->index) + " is skipped: " + skipped->reason);
        } else {
            fuse(std::get<sensor::Frame>(*reading), after_frame);
        }
        if (!warned_full && reconstruction_->counters().refused_blocks > 0) {
            warned_full = true;
            progress.say(
                fmt::format("warning: the voxel pool of {} blocks is full; new surface is left out from here on",
                            settings().map.capacity_blocks));
        }
        const ObservationCounters& observed = reconstruction_->observation_counters();
        if (!warned_observations && observed.records.refused_blocks + observed.blocks.refused_blocks > 0) {
            warned_observations = true;
            progress.say(fmt::format(
                "warning: the pool of {} {} is full; the reflectance of new surface is left out from here on",
                observed.records.refused_blocks > 0 ? settings().reflectance->capacity_records
                                                    : settings().reflectance->capacity_blocks,
                observed.records.refused_blocks > 0 ? "observed voxels" : "observed blocks"));
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
        labels = truth_->labels(frame.index, info_.depth.extent);
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

uint32_t SequenceFusion::blocks_used() {
    return settings().map.capacity_blocks - reconstruction_->counters().free_blocks;
}

}  // namespace patina::tools
