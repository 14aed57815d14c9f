#include <bit>
#include <utility>

#include "reconstruction/lights/find_sun.h"
#include "reconstruction/lights/surface_samples.h"
#include "reconstruction/lights/unmeasured_lamps.h"
#include "reconstruction/lights/unseen_light.h"
#include "reconstruction/session/rgbd_frame.h"
#include "reconstruction/session/session_core.h"

// The light that a session looks for while it goes on.

namespace patina {
namespace {

constexpr size_t kFirstAmbientFrames = gpu::kLeastForSample;  // then what unknown directions send is looked for,
constexpr size_t kFirstUnseenFrames = 8;                      // and then lamps and a sun that no picture tells;
constexpr size_t kFirstUnseenFramesOfCamera = 64;             // a camera of which no lamp is known does not wait for it

}  // namespace

bool SessionCore::looks_for_light() const {
    const ReflectanceStage* reflectance = pipeline_->reflectance();
    return reflectance && reflectance->gathers() && may_lack_lamps(illumination_);
}

/// Of a camera, while nothing else tells what is around: what arrives from there, by how bright its pictures are.
std::optional<glm::dvec3> SessionCore::see_brightness(const Frame& frame) {
    if (!seen_ || is_held_out(frame.index, options_.hold_out) || !(frame.world_from_camera || tracks())) return {};
    const auto ambient = seen_->add(frame.color);
    return ambient ? std::optional(glm::dvec3(*ambient)) : std::nullopt;
}

void SessionCore::assume_light(glm::dvec3 ambient) {
    illumination_.ambient = illumination_.assumed = ambient;
    pipeline_->set_lights({}, ambient);
}

/// Of a camera, where nothing has told yet what is around.
bool SessionCore::is_light_assumed() const {
    return options_.sequence.empty() && illumination_.lights.empty() && illumination_.ambient == illumination_.assumed;
}

/// After a frame.
void SessionCore::look_for_light() {
    if (!looks_for_light() || !is_unseen_light_due()) return;
    const bool waits = info_.frames || knows_brightness();
    if (used_.size() < (waits ? kFirstUnseenFrames : kFirstUnseenFramesOfCamera)) {
        look_for_ambient_light();
    } else {
        look_for_unseen_light();
    }
}

/// After the last frame, once: nothing will know more of what is around.
void SessionCore::look_for_last_light() {
    if (!ended_ || std::exchange(looked_last_, true)) return;
    if (!looks_for_light() || !shows_enough(draw_samples(*pipeline_))) return;
    pipeline_->refine_all();
    look_for_unseen_light();
}

/// Whenever there are twice as many frames: what is unknown becomes less, and so does what comes from there.
bool SessionCore::is_unseen_light_due() const {
    return used_.size() >= kFirstAmbientFrames && std::has_single_bit(used_.size());
}

/// What arrives from unseen surroundings under the lights that are known so far.
void SessionCore::look_for_ambient_light() {
    const std::vector<gpu::LightSample> drawn = draw_samples(*pipeline_);
    if (!shows_enough(drawn)) return;
    const auto told = ambient_told_by(drawn);
    if (!told) return;
    illumination_.ambient = *told;
    seen_.reset();
    pipeline_->set_lights(lights_of(illumination_), illumination_.ambient);
}

/// Light that no picture tells: lamps that low exposure clips or does not show, a sun in its patches, and what arrives
/// from unseen surroundings.
void SessionCore::look_for_unseen_light() {
    const std::vector<gpu::LightSample> drawn = draw_samples(*pipeline_);
    if (!shows_enough(drawn)) return;
    const std::vector<FoundLight> measured = as_measured(illumination_.lights);
    ToldLamps told = find_unmeasured_lamps(*pipeline_, drawn, measured, illumination_.candidates_m,
                                           options_.white_albedo, knows_brightness());
    std::vector<FoundLight>& lights = illumination_.lights = std::move(told.lamps);
    illumination_.candidates_m = std::move(told.places_m);
    const std::vector<Light> lamps = lights_of(illumination_);
    const bool room_for_one = lamps.size() < gpu::kMaxPointLights;
    if (const auto sun =
            room_for_one ? find_sun(*pipeline_, drawn, lamps, glm::vec3(illumination_.ambient)) : std::nullopt)
        lights.push_back(*sun);
    const auto ambient = ambient_told_by(drawn);
    // Where nothing tells it and no lamp is known, what was assumed at first is the only light.
    illumination_.ambient = ambient.value_or(lights.empty() ? illumination_.assumed : glm::dvec3(0));
    if (ambient || !lights.empty()) seen_.reset();
    if (ambient && lights.size() > lamps.size())
        measure_sun(*pipeline_, drawn, lights.back(), lamps, glm::vec3(illumination_.ambient));
    pipeline_->set_lights(lights_of(illumination_), illumination_.ambient);
}

/// Whether pictures of low exposure tell how bright lamps or windows are.
bool SessionCore::knows_brightness() const { return illumination_.found_by == "lighting sequence"; }

/// Whether there is something to tell light by.
bool SessionCore::shows_enough(const std::vector<gpu::LightSample>& drawn) const {
    return knows_brightness() || is_enough_surface(drawn);
}

/// What unknown directions send under the lights that are known so far, if anything tells it.
std::optional<glm::dvec3> SessionCore::ambient_told_by(const std::vector<gpu::LightSample>& drawn) {
    const std::vector<Light> lights = lights_of(illumination_);
    if (lights.empty() && !knows_brightness() && !is_enough_around(drawn)) return std::nullopt;
    const auto unknown_white = knows_brightness() ? std::nullopt : std::optional(options_.white_albedo);
    const auto unseen = find_unseen_light(*pipeline_, drawn, lights, unknown_white);
    return unseen ? std::optional(glm::dvec3(*unseen)) : std::nullopt;
}

}  // namespace patina
