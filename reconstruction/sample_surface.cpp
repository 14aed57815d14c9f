#include "reconstruction/sample_surface.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <span>

#include "reconstruction/far_field.h"
#include "reconstruction/lights/find_windows.h"

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

// Blocks along the edge of a cube whose vertices are sampled at once: at first, and at least.
constexpr int kLargestCube = 64, kSmallestCube = 4;
// What interpolation between records looks at lies within so many blocks of a vertex's own.
constexpr int kBesideVertex = 1;

/// Samples some vertices of a mesh, which may lie in one cube or in several.
class CubeSampler {
  public:
    CubeSampler(graph::Runner& runner, ReflectanceStage& model, const Mesh& mesh, double block_m,
                const BringRecords& bring)
        : runner_(runner), model_(model), mesh_(mesh), block_m_(block_m), bring_(bring) {
        sampled.kd.resize(mesh.positions_m.size());
        sampled.labels.resize(mesh.positions_m.size());
    }

    void sample(const std::vector<uint32_t>& vertices, int edge) {
        std::map<std::array<int, 3>, std::vector<uint32_t>> cubes;
        for (const uint32_t vertex : vertices) {
            const glm::ivec3 cube(glm::floor(glm::dvec3(mesh_.positions_m[vertex]) / (edge * block_m_)));
            cubes[{cube.z, cube.y, cube.x}].push_back(vertex);
        }
        for (const auto& [at, own] : cubes) {
            const glm::ivec3 low = glm::ivec3(at[2], at[1], at[0]) * edge;
            if (!bring_(StreamRegion::box(low - kBesideVertex, low + edge - 1 + kBesideVertex)) &&
                edge > kSmallestCube) {
                sample(own, edge / 2);
            } else {
                take(own);
            }
        }
    }

    MeshReflectance sampled;

  private:
    void take(const std::vector<uint32_t>& vertices) {
        Mesh part;
        for (const uint32_t vertex : vertices) {
            part.positions_m.push_back(mesh_.positions_m[vertex]);
            part.normals.push_back(mesh_.normals[vertex]);
        }
        const MeshReflectance own = sample_vertices(runner_, model_, part);
        for (size_t i = 0; i < vertices.size(); ++i) {
            sampled.kd[vertices[i]] = own.kd[i];
            sampled.labels[vertices[i]] = own.labels[i];
        }
    }

    graph::Runner& runner_;
    ReflectanceStage& model_;
    const Mesh& mesh_;
    double block_m_;
    const BringRecords& bring_;
};

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

Image<glm::vec4> read_far_field(graph::Runner& runner, const ReflectanceStage& model) {
    if (!model.gathers()) return {};
    graph::FrameGraph frame = runner.begin();
    const graph::BufferId surroundings = model.import_surroundings(frame);
    const graph::Readback sky = frame.read_back(surroundings, 0, gpu::kFarFieldTexels * sizeof(gpu::FarFieldTexel));
    const graph::Readback openings =
        frame.read_back(surroundings, kOpeningsAt, gpu::kOpeningTexels * sizeof(gpu::OpeningTexel));
    runner.submit(std::move(frame));
    runner.wait();
    return far_field_of(sky.as<gpu::FarFieldTexel>(), openings.as<gpu::OpeningTexel>());
}

std::vector<AreaLight> read_windows(graph::Runner& runner, const ReflectanceStage& model, glm::dvec3 inside_m,
                                    std::span<const Light> lamps) {
    if (!model.gathers()) return {};
    graph::FrameGraph frame = runner.begin();
    const graph::Readback cells = frame.read_back(model.import_surroundings(frame), kSurroundingsCellsAt,
                                                  gpu::kSurroundingsCells * sizeof(gpu::SurroundingsCell));
    runner.submit(std::move(frame));
    runner.wait();
    return find_windows(cells.as<gpu::SurroundingsCell>(), inside_m, lamps);
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

MeshReflectance sample_cube_by_cube(graph::Runner& runner, ReflectanceStage& model, const Mesh& mesh, double block_m,
                                    const BringRecords& bring) {
    CubeSampler sampler(runner, model, mesh, block_m, bring);
    std::vector<uint32_t> all(mesh.positions_m.size());
    std::iota(all.begin(), all.end(), 0u);
    sampler.sample(all, kLargestCube);
    return std::move(sampler.sampled);
}

}  // namespace patina
