#include "reconstruction/session/choose_settings.h"

#include <utility>

#include "reconstruction/api/access.h"
#include "reconstruction/session/detail.h"
#include "reconstruction/session/session_lights.h"
#include "reconstruction/session/session_materials.h"

namespace patina {

namespace {

void choose_gains(ReconstructionSettings& settings, Gains gains, const SequenceInfo& info) {
    const bool drifts = gains == Gains::kAuto && !info.exposure_known && settings.fusion.color;
    if (gains == Gains::kOff) settings.gains.reset();
    if ((drifts || gains == Gains::kOn) && !settings.gains) settings.gains.emplace();
}

void choose_reflectance(ReconstructionSettings& settings, const Illumination& light, const SequenceInfo& info) {
    if (!shines(light)) {
        settings.reflectance.reset();
    } else if (!settings.reflectance) {
        settings.reflectance.emplace();
    }
    const bool gathers = info.indirect_light && settings.fusion.color;
    if (settings.reflectance && !gathers) settings.reflectance->refine.gathered_rays = 0;
}

void choose_detail_of_records(ReconstructionSettings& settings, const SessionOptions& options) {
    if (!settings.reflectance || options.detail == Detail::kAuto) return;
    const DetailValues chosen = values_of(options.detail);
    const auto is_given = [&](const char* key) { return Access::is_given(options.settings, key); };
    ReflectanceStageSettings& reflectance = *settings.reflectance;
    if (reflectance.voxel_m == 0 && !is_given("map.voxel_m") && !is_given("reflectance.voxel_m"))
        reflectance.voxel_m = chosen.record_m;
    if (!is_given("observe.max_distance_m")) reflectance.observe.max_distance_m = chosen.observe_m;
}

void choose_labels(ReconstructionSettings& settings, Labels labels) {
    if (labels == Labels::kOff) {
        settings.segmentation.reset();
    } else if (!settings.segmentation) {
        settings.segmentation.emplace();
    }
    if (settings.segmentation) settings.segmentation->given = labels == Labels::kTruth;
}

void choose_poses(ReconstructionSettings& settings, Poses poses, const SequenceInfo& info) {
    if (poses == Poses::kGiven || (poses == Poses::kAuto && info.has_poses)) {
        settings.tracking.reset();
        settings.keyframes.reset();
        return;
    }
    if (!settings.tracking) settings.tracking.emplace();
    if (!settings.keyframes) settings.keyframes.emplace();
    if (settings.gains) settings.keyframes->tests = KeyframeTests::kDepth;
}

}  // namespace

ReconstructionSettings choose_settings(const SessionOptions& options, const SequenceInfo& info,
                                       const Illumination& light, std::optional<NetworkDescription> network) {
    ReconstructionSettings settings = Access::values(options.settings);
    if (options.seed) settings.seed = *options.seed;
    choose_gains(settings, options.gains, info);
    choose_reflectance(settings, light, info);
    choose_detail_of_records(settings, options);
    choose_labels(settings, options.labels);
    choose_poses(settings, options.poses, info);
    set_specular(settings, options, std::move(network));
    if (light.lights.empty() && options.materials == Materials::kAuto) {
        // A mirror is told by the room that it shows. Other gloss needs lamps.
        const bool gathers = settings.reflectance && settings.reflectance->refine.gathered_rays > 0;
        if (!gathers) settings.specular.reset();
        if (!gathers || !may_lack_lamps(light)) settings.network.reset();
    }
    return settings;
}

ReconstructionSettings choose_settings(const ReconstructionOptions& given) {
    if (given.materials == Materials::kTruth)
        throw Error("materials of the truth belong to a sequence: a reconstruction of frames has none");
    SessionOptions options;
    options.labels = given.labels;
    options.materials = given.materials;
    options.poses = given.poses;
    options.gains = given.gains;
    options.network = given.network;
    options.seed = given.seed;
    options.settings = given.settings;
    // Frames bring poses and are of one exposure, unless the settings say otherwise.
    SequenceInfo info;
    info.has_poses = !Access::values(given.settings).tracking;
    info.exposure_known = true;
    const Illumination light = illumination_of(given.lighting, glm::dvec3(0));
    return choose_settings(options, info, light, shines(light) ? read_network(options) : std::nullopt);
}

}  // namespace patina
