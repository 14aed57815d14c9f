#pragma once

#include <limits>
#include <optional>
#include <span>

#include "reconstruction/lights/fit_intensities.h"
#include "reconstruction/pipeline.h"

namespace patina {

/// Irradiance over pi of the surface's samples, mean of the channels.
struct KnownLight {
    ReceivedLight lamps;    ///< from all lamps together; may be null but for fit_unseen_light()
    ReceivedLight all;      ///< from these, and from what gathered rays met
    ReceivedLight unknown;  ///< what light of 1 would give from the directions of which nothing is known
};

/// `all`, and a radiance of `unseen` from unknown directions.
ReceivedLight with_unseen(const KnownLight& known, double unseen);

struct UnseenLight {
    double radiance = 0;  ///< from unknown directions; linear pixel value, mean of the channels
    double misfit = 1;    ///< mean robust residual of the surface's samples, 0 to 1
};

/// What unknown directions likely send: 0 to 8 times as much as `usual` (usual_light(), mean of the channels), by the
/// misfit that it leaves. They mostly hide more of the same room. So what explains the surface hardly better and is
/// farther from `usual` is not taken, less so where it is more than that. Lamps in a void, whose shadows are black, are
/// explained by 0. `lamps`: those beside known ones, of any strength.
UnseenLight likely_unseen_light(const LitSurface& surface, const KnownLight& known, double usual,
                                std::span<const ReceivedLight> lamps = {});

/// What arrives beside lamps whose intensities are known and what is around: the light of a sky that no frame shows.
/// Radiance (linear pixel value, mean of the channels), as if it were the same in all directions of which nothing is
/// known. Shadows tell it, and surface that turns away from the lamps: where one albedo receives little of what is
/// known, the rest of its light is other light. It is fitted twice: as what lamps alone leave, the same everywhere; and
/// as what lamps and surroundings leave, from unknown directions. All that the model lacks (a sun, gloss, soft shadows)
/// lights shadows, too, and makes both too large: of those that explain the surface the smaller one is returned. Empty
/// where none does: where it has many albedos of one chromaticity, or much of its light comes in patches, as a sun's.
/// Where light is gathered with errors both are too small, as in rooms with few lamps.
std::optional<float> fit_unseen_light(const LitSurface& surface, const KnownLight& known);

/// Radiance that known directions send on average over all samples that have some; linear pixel value.
glm::vec3 usual_light(std::span<const gpu::LightSample> samples);

/// unknown_share() from which on hardly anything is known of what is around; of a table it is 0.8 to 0.93.
inline constexpr double kHardlyKnown = 0.55;

/// Share of all directions, by cosine, of which nothing is known, on average over all samples of which it was looked;
/// 1 where there are none.
double unknown_share(std::span<const gpu::LightSample> samples);

/// Whether light can be told by what it lights, where no lamp was measured: that takes enough of a surface. A few
/// things on a table tell less of it than how bright they look.
bool is_enough_surface(std::span<const gpu::LightSample> samples);

/// The same of what unknown directions send, where no lamp is known: from a table the room around is hardly seen.
bool is_enough_around(std::span<const gpu::LightSample> samples);

/// Radiance that the surface itself sends, by channel the median over all samples; linear pixel value, 0 where there
/// are none. Unlike usual_light() windows and lamps' surroundings do not count: they are few, and what is hidden is
/// mostly more of the same walls.
glm::vec3 surface_light(std::span<const gpu::LightSample> samples);

/// How strong light has to be that gives the samples `reached` at a strength of 1, for no more than `share` of these to
/// have an albedo above `albedo`, beside the light that they receive. Both are irradiance over pi of each sample, mean
/// of the channels. What light does not reach (0) does not count. Below 0 where they receive more than enough; empty
/// where it reaches none.
std::optional<float> least_strength(std::span<const gpu::LightSample> samples, std::span<const float> received,
                                    std::span<const float> reached, float albedo, double share);

/// Of a surface, which may be brighter than paint: highlights, patches of sun, light that was gathered too dark.
inline constexpr double kBrighterShare = 0.2;

/// Of a surface, which is white; and how dark that may be found, of its albedo.
inline constexpr double kBrightest = 0.1;
inline constexpr float kDarkWhite = 0.75f;

/// The least such light under which surfaces are as dark as surfaces are: a lamp that no picture of low exposure shows
/// would make albedos of 1 and more. A fifth of the samples that it can reach may stay brighter than an albedo of 0.9,
/// as highlights and patches of sun are. `received` is irradiance over pi by sample, mean of the channels, from all
/// that is known. 0 where nothing is missing.
float least_unseen_light(std::span<const gpu::LightSample> samples, std::span<const float> received);

/// The most such light, of a recording without low exposure: pictures clip what is bright, so that nothing else says
/// how bright light is. With more, less than a tenth of the samples would keep three quarters of `white_albedo`. 0
/// where there is too much light without it.
float most_unseen_light(std::span<const gpu::LightSample> samples, std::span<const float> received, float white_albedo);

/// Which of the two counts. Where known light explains the surface well, it is what fit_unseen_light() says, white as
/// its colour is too uncertain, or none beside a sun; else what is likely, of the tint of `usual` (usual_light(), not
/// black). Empty where no such light explains the surface.
std::optional<glm::vec3> choose_unseen_light(const LitSurface& surface, const KnownLight& known, glm::vec3 usual,
                                             bool beside_sun);

struct UnseenLightBounds {
    float least = 0;  ///< least_unseen_light()
    float most = std::numeric_limits<float>::infinity();
};

/// What counts in the end: `chosen` (choose_unseen_light()) within these bounds; where nothing explains the surface,
/// what that sends itself (surface_light()), no more than the bounds say. `drawn` as draw_samples returns it. Above 0:
/// no light at all would count as not known.
glm::vec3 decide_unseen_light(const std::optional<glm::vec3>& chosen, std::span<const gpu::LightSample> drawn,
                              UnseenLightBounds bounds);

/// decide_unseen_light() of what the pipeline has observed, under these lights; `drawn` as draw_samples returns it.
/// Empty where nobody looked around: then as much as each record receives from elsewhere is better. `white_albedo`
/// bounds it (most_unseen_light()) where no picture of low exposure tells how bright light is; then it is empty, too,
/// where nothing explains the surface and no lamp is known. At most gpu::kMaxPointLights lights. Waits for the device.
std::optional<glm::vec3> find_unseen_light(Pipeline& pipeline, std::vector<gpu::LightSample> drawn,
                                           std::span<const Light> lights, std::optional<float> white_albedo);

}  // namespace patina
