#include "reconstruction/sample_surface.h"

#include <algorithm>
#include <span>

namespace patina {
namespace {

std::span<const float> floats_of(std::span<const glm::vec3> vectors) {
    static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
    return {&vectors.front().x, 3 * vectors.size()};
}

SegmentReflectance to_segment(const gpu::SegmentAlbedo& sums, const gpu::SegmentMaterial& material) {
    SegmentReflectance segment;
    segment.kd = kd_of(sums);
    if (material.version != 0) segment.gloss = WardGloss{glm::vec3(material.ks_alpha), material.ks_alpha.a};
    segment.voxels = sums.kd.w;
    segment.observations = sums.weight.w;
    const uint32_t least = std::min({sums.weight.r, sums.weight.g, sums.weight.b});
    if (segment.voxels > 0)
        segment.confidence = static_cast<float>(least) / (gpu::kCertaintySteps * static_cast<float>(segment.voxels));
    return segment;
}

}  // namespace

std::vector<SegmentReflectance> read_segments(graph::Runner& runner, ReflectanceStage& model) {
    graph::FrameGraph frame = runner.begin();
    const SegmentIds ids = model.add_segments(frame);
    const graph::Readback albedo = frame.read_back(ids.albedo), materials = frame.read_back(ids.materials);
    runner.submit(std::move(frame));
    runner.wait();
    const auto sums = albedo.as<gpu::SegmentAlbedo>();
    const auto gloss = materials.as<gpu::SegmentMaterial>();
    std::vector<SegmentReflectance> segments;
    for (size_t label = 0; label < sums.size(); ++label) segments.push_back(to_segment(sums[label], gloss[label]));
    return segments;
}

MeshReflectance sample_vertices(graph::Runner& runner, ReflectanceStage& model, const Mesh& mesh,
                                uint32_t batch_points) {
    MeshReflectance reflectance;
    const std::span<const glm::vec3> positions(mesh.positions_m), normals(mesh.normals);
    for (size_t first = 0; first < positions.size(); first += batch_points) {
        const size_t count = std::min<size_t>(batch_points, positions.size() - first);
        graph::FrameGraph frame = runner.begin();
        const auto at = frame.upload("positions", floats_of(positions.subspan(first, count)));
        const auto facing = frame.upload("normals", floats_of(normals.subspan(first, count)));
        const auto samples = frame.read_back(model.add_sample(frame, at, facing, static_cast<uint32_t>(count)));
        runner.submit(std::move(frame));
        runner.wait();
        for (const auto& sample : samples.as<gpu::SampledReflectance>()) {
            reflectance.kd.push_back(sample.kd);
            reflectance.labels.push_back(sample.label);
        }
    }
    return reflectance;
}

}  // namespace patina
