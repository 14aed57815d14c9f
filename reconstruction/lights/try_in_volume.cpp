#include "reconstruction/lights/try_in_volume.h"

#include <algorithm>

#include "reconstruction/lights/surface_samples.h"

namespace patina {
namespace {

/// The highlights as samples of a pass, which takes whole groups.
std::vector<gpu::LightSample> in_groups(const std::vector<gpu::LightSample>& highlights) {
    std::vector<gpu::LightSample> padded = highlights;
    padded.resize((highlights.size() + gpu::kTrialSamples - 1) / gpu::kTrialSamples * gpu::kTrialSamples);
    return padded;
}

}  // namespace

TryLampsInVolume::TryLampsInVolume(Pipeline& pipeline, std::span<const gpu::LightSample> drawn,
                                   const LitSurface& surface, const RuledOutPlaces* ruled_out)
    : pipeline_(pipeline),
      drawn_(drawn),
      surface_(surface),
      ruled_out_(ruled_out),
      highlights_(in_groups(surface.highlights())) {}

std::vector<TrialLamp> TryLampsInVolume::operator()(std::span<const glm::vec3> places_m, uint32_t count) const {
    std::vector<TrialLamp> lamps;
    while (!places_m.empty()) {
        const auto batch = places_m.first(std::min<size_t>(gpu::kTrialLights, places_m.size()));
        places_m = places_m.subspan(batch.size());
        const std::vector<bool> is_ruled_out = ruled_out_ ? (*ruled_out_)(batch) : std::vector<bool>(batch.size());
        std::vector<float> received = try_lamps(pipeline_, drawn_, batch, count);
        const std::vector<float> reached =
            highlights_.empty() ? std::vector<float>()
                                : try_lamps(pipeline_, highlights_, batch, static_cast<uint32_t>(highlights_.size()));
        for (size_t i = 0; i < batch.size(); ++i) {
            const std::span<float> row(received.data() + i * gpu::kLightSamples, gpu::kLightSamples);
            if (is_ruled_out[i]) std::ranges::fill(row, 0.0f);
            lamps.push_back({batch[i], surface_.received(row), surface_.unexplained(batch[i])});
            TrialLamp& lamp = lamps.back();
            for (size_t k = 0; k < lamp.unexplained.size(); ++k)
                if (is_ruled_out[i] || reached[i * gpu::kLightSamples + k] <= 0) lamp.unexplained[k] = 1;
        }
    }
    return lamps;
}

}  // namespace patina
