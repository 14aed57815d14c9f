#include "reconstruction/lights/try_in_volume.h"

#include <algorithm>

#include "reconstruction/lights/surface_samples.h"

namespace patina {

TryLampsInVolume::TryLampsInVolume(Pipeline& pipeline, std::span<const gpu::LightSample> drawn,
                                   const LitSurface& surface, const RuledOutPlaces* ruled_out)
    : pipeline_(pipeline), drawn_(drawn), surface_(surface), ruled_out_(ruled_out) {}

std::vector<TrialLamp> TryLampsInVolume::operator()(std::span<const glm::vec3> places_m, uint32_t count) const {
    const std::vector<bool> is_ruled_out = ruled_out_ ? (*ruled_out_)(places_m) : std::vector<bool>(places_m.size());
    const std::vector<float> received = try_lamps(pipeline_, drawn_.first(count), places_m);
    const std::vector<float> reached = try_lamps(pipeline_, surface_.highlights(), places_m);
    std::vector<float> row(gpu::kLightSamples);
    std::vector<TrialLamp> lamps;
    for (size_t i = 0; i < places_m.size(); ++i) {
        const auto own = std::span(received).subspan(i * count, count);
        if (is_ruled_out[i]) {
            std::ranges::fill(row, 0.0f);
        } else {
            std::ranges::copy(own, row.begin());
        }
        lamps.push_back({places_m[i], surface_.received(row), surface_.unexplained(places_m[i])});
        TrialLamp& lamp = lamps.back();
        for (size_t k = 0; k < lamp.unexplained.size(); ++k)
            if (is_ruled_out[i] || reached[i * lamp.unexplained.size() + k] <= 0) lamp.unexplained[k] = 1;
    }
    return lamps;
}

}  // namespace patina
