#include "reconstruction/segment_intervals.h"

#include <algorithm>
#include <span>

#include "shared/specular/material_bounds.h"
#include "shared/specular/ward_fit.h"

namespace patina {

namespace {

static_assert(gpu::kBoundsLevels == kIntervalLevels.size());

MaterialInterval to_interval(const gpu::MaterialBounds& bounds) {
    return {glm::vec3(bounds.kd_low),        glm::vec3(bounds.kd_high), glm::vec3(bounds.ks_alpha_low),
            glm::vec3(bounds.ks_alpha_high), bounds.ks_alpha_low.w,     bounds.ks_alpha_high.w};
}

/// `bounds`: of one label.
void set_intervals(std::span<const gpu::MaterialBounds> bounds, SegmentReflectance& segment) {
    segment.gloss->confidence = bounds.front().kd_low.w;
    auto& intervals = segment.intervals.emplace();
    std::ranges::transform(bounds, intervals.begin(), to_interval);
}

}  // namespace

void add_intervals(graph::Runner& runner, ReflectanceStage& reflectance, const SpecularStage& specular,
                   std::vector<SegmentReflectance>& segments) {
    graph::FrameGraph graph = runner.begin();
    const graph::Readback read_fits = graph.read_back(specular.fits(graph));
    std::optional<graph::Readback> read_bounds;
    if (const auto bounds = specular.add_bounds(graph, reflectance.add_segments(graph).albedo))
        read_bounds = graph.read_back(*bounds);
    runner.submit(std::move(graph));
    runner.wait();
    const auto fits = read_fits.as<gpu::WardFit>();
    const auto bounds = read_bounds ? read_bounds->as<gpu::MaterialBounds>() : std::vector<gpu::MaterialBounds>{};
    for (size_t label = 0; label < std::min(fits.size(), segments.size()); ++label) {
        SegmentReflectance& segment = segments[label];
        if (!segment.gloss || segment.voxels == 0) continue;
        segment.gloss->confidence = fits[label].confidence;
        if (read_bounds)
            set_intervals(std::span(bounds).subspan(label * gpu::kBoundsLevels, gpu::kBoundsLevels), segment);
    }
}

}  // namespace patina
