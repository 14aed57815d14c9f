#include "reconstruction/streaming/streaming.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <set>
#include <string>

#include "passes/state/block_keys.h"
#include "reconstruction/pipeline.h"
#include "reconstruction/session/rgbd_frame.h"
#include "reconstruction/store/map_file.h"
#include "reconstruction/store/state_files.h"
#include "reconstruction/streaming/map_tiles.h"
#include "scenes/render/synthetic_source.h"
#include "tests/export/temporary_folder.h"
#include "tests/gpu/gpu_test.h"
#include "tests/support/same_bytes.h"

namespace patina::streaming_test {
namespace {

constexpr uint32_t kFrames = 60, kFarEnd = kFrames / 2;

/// Along a wall with things before it, 12 m there and back, coarse and small.
scenes::SyntheticScene street() {
    scenes::SyntheticScene scene;
    scene.name = "street";
    const auto add = [&](scenes::Shape shape, const RigidTransform& pose, glm::dvec3 kd, glm::dvec3 ks, double alpha) {
        const auto id = static_cast<uint32_t>(scene.objects.size() + 1);
        scene.objects.push_back({{{std::move(shape), pose}}, {id, std::to_string(id), kd, ks, alpha}, {}});
    };
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0);
    add(scenes::RectangleShape{{8, 1.5}}, scenes::placed({6, 0, 1.3}, y, 0), {0.5, 0.5, 0.45}, glm::dvec3(0.05), 0.3);
    add(scenes::RectangleShape{{8, 1.5}}, scenes::placed({6, 0.7, 0}, x, std::numbers::pi / 2), {0.3, 0.25, 0.2},
        glm::dvec3(0.1), 0.2);
    for (int i = 0; i < 26; ++i) {
        const glm::dvec3 kd(0.15 + 0.5 * (i % 3 == 0), 0.15 + 0.4 * (i % 3 == 1), 0.15 + 0.4 * (i % 4 == 2));
        add(scenes::BoxShape{glm::dvec3(0.12)}, scenes::placed({0.5 * i - 0.2, 0.58 - 0.5 * (i % 2), 1.0}, y, 0.4 * i),
            kd, glm::dvec3(0.1), 0.15);
    }
    for (int i = 0; i < 5; ++i) scene.lights.push_back({{3.0 * i, -1.5, -0.5}, {4, 4, 4}, 0.05});
    scenes::WaypointPath path;
    path.period_s = 40;
    for (int i = 0; i < 9; ++i) path.waypoints.push_back({{1.5 * i, 0, 0}, {1.5 * i + 0.2, 0.1, 1.3}});
    for (int i = 7; i > 0; --i) path.waypoints.push_back({{1.5 * i, -0.1, 0.1}, {1.5 * i - 0.2, 0.1, 1.3}});
    scene.path = path;
    scene.fps = kFrames / path.period_s;
    scene.camera = scaled_to(scene.camera, {128, 106});
    return scene;
}

struct Tour {
    explicit Tour(vulkan::Device& device) {
        scenes::SyntheticSource source(device, street(), {.frames = kFrames});
        info = source.info();
        while (auto reading = source.next()) frames.push_back(std::get<Frame>(std::move(*reading)));
        lights = source.scene().lights;
    }

    SequenceInfo info;
    std::vector<Frame> frames;
    std::vector<Light> lights;
};

struct Result {
    Mesh mesh;
    MeshReflectance reflectance;
    StreamCounts streamed, records;  ///< before the mesh was extracted
    PipelineCounters counters;
};

void expect_same_scene(const Result& a, const Result& b) {
    EXPECT_TRUE(same_bytes(a.mesh.positions_m, b.mesh.positions_m));
    EXPECT_TRUE(same_bytes(a.mesh.normals, b.mesh.normals));
    EXPECT_TRUE(same_bytes(a.mesh.colors, b.mesh.colors));
    EXPECT_TRUE(same_bytes(a.mesh.triangles, b.mesh.triangles));
    EXPECT_TRUE(same_bytes(a.reflectance.labels, b.reflectance.labels));
    EXPECT_TRUE(same_bytes(a.reflectance.kd, b.reflectance.kd));
    ASSERT_EQ(a.reflectance.segments.size(), b.reflectance.segments.size());
    for (size_t label = 0; label < a.reflectance.segments.size(); ++label) {
        const SegmentReflectance &one = a.reflectance.segments[label], &other = b.reflectance.segments[label];
        EXPECT_EQ(one.kd, other.kd) << label;
        EXPECT_EQ(one.voxels, other.voxels) << label;
        EXPECT_EQ(one.observations, other.observations) << label;
        EXPECT_EQ(one.confidence, other.confidence) << label;
        ASSERT_EQ(one.gloss.has_value(), other.gloss.has_value()) << label;
        if (!one.gloss) continue;
        EXPECT_EQ(one.gloss->ks, other.gloss->ks) << label;
        EXPECT_EQ(one.gloss->alpha, other.gloss->alpha) << label;
        EXPECT_EQ(one.gloss->confidence, other.gloss->confidence) << label;
    }
}

class StreamingTest : public GpuTest {
  protected:
    static constexpr uint32_t kTightRecords = 11000;  // frames need about as many

    /// Of a camera that sees 1.6 m far. `resident`: voxel blocks, and observed voxels, that are to stay; 0: all.
    /// What records gather depends on their turns, and what is away has none.
    static ReconstructionSettings settings(uint32_t resident, uint32_t gathered_rays = 0) {
        ReconstructionSettings settings;
        settings.map.voxel_m = 0.02f;
        settings.map.capacity_blocks = 512;
        settings.fusion.truncation_m = 0.06f;
        settings.fusion.max_depth_m = 1.6f;
        settings.around_m = 1.6f;
        settings.remove_every = 4;
        settings.resident_blocks = resident;
        settings.segmentation.emplace();
        settings.segmentation->sample_every = 8;
        settings.reflectance.emplace();
        settings.reflectance->voxel_m = 0.04f;
        settings.reflectance->refine.gathered_rays = gathered_rays;
        settings.reflectance->resident_records = resident;
        settings.reflectance->capacity_blocks = 64;
        settings.reflectance->capacity_records = 512;
        settings.specular.emplace();
        return settings;
    }

    void add(Pipeline& pipeline, size_t first, size_t end) const {
        for (size_t i = first; i < end; ++i) pipeline.add(patina::to_rgbd(tour_.info, tour_.frames[i]));
    }

    Result reconstruct(const ReconstructionSettings& settings) const {
        Pipeline pipeline(device(), settings);
        pipeline.set_lights(tour_.lights);
        add(pipeline, 0, tour_.frames.size());
        return result_of(pipeline);
    }

    static Result result_of(Pipeline& pipeline) {
        pipeline.wait();
        Result result;
        result.streamed = pipeline.streamed_blocks();
        result.records = pipeline.streamed_records();
        result.counters = pipeline.counters();
        result.mesh = pipeline.extract_surface();
        result.reflectance = pipeline.sample_reflectance(result.mesh);
        return result;
    }

    /// Of a map all of which stays on the device; computed once.
    const Result& whole() const {
        static const Result result = reconstruct(settings(0));
        return result;
    }

    /// Of one of which as little stays as may; computed once.
    const Result& streamed() const {
        static const Result result = reconstruct(settings(1));
        return result;
    }

    const Tour& tour_ = the_tour(device());

  private:
    /// Rendered once.
    static const Tour& the_tour(vulkan::Device& device) {
        static const Tour tour(device);
        return tour;
    }
};

TEST_F(StreamingTest, WhatLeavesTheDeviceMakesNoDifference) {
    const Result &all = whole(), &few = streamed();
    ReconstructionSettings with_file = settings(1);
    with_file.host_mib = 1;
    const Result fewer = reconstruct(with_file);
    EXPECT_GT(fewer.streamed.filed, 100u);
    EXPECT_GT(fewer.records.filed, 100u);
    expect_same_scene(fewer, all);
    EXPECT_EQ(all.streamed.left + all.streamed.filed + few.streamed.filed, 0u);
    EXPECT_EQ(all.records.left + all.records.filed + few.records.filed, 0u);
    EXPECT_GT(few.streamed.left, 1000u);
    EXPECT_GT(few.streamed.returned, 200u);
    EXPECT_GT(few.streamed.away, 500u);
    EXPECT_EQ(few.streamed.away, few.streamed.left - few.streamed.returned);
    EXPECT_LT(few.counters.map.capacity - few.counters.map.free_blocks,
              all.counters.map.capacity - all.counters.map.free_blocks);
    EXPECT_EQ(few.counters.map.refused_blocks, 0u);
    const auto in_use = [](const gpu::MapCounters& pool) { return pool.capacity - pool.free_blocks; };
    const gpu::MapCounters &records = few.counters.observations.records, &whole = all.counters.observations.records;
    EXPECT_GT(few.records.left, 3000u);
    EXPECT_GT(few.records.returned, 200u);
    EXPECT_EQ(few.records.away + in_use(records), in_use(whole));
    EXPECT_LT(in_use(records), in_use(whole) / 2);
    EXPECT_LT(records.capacity, whole.capacity);
    EXPECT_EQ(records.refused_blocks + few.counters.observations.blocks.refused_blocks, 0u);
    ASSERT_GT(all.mesh.positions_m.size(), 10000u);
    expect_same_scene(few, all);
    EXPECT_EQ(few.counters.segments.created, all.counters.segments.created);
    EXPECT_EQ(few.counters.segments.live, all.counters.segments.live);
    EXPECT_EQ(few.counters.segments.pruned, all.counters.segments.pruned);
    EXPECT_EQ(few.counters.segments.free_labels, all.counters.segments.free_labels);
}

/// Everything that the corners of a mesh's triangles have, triangle by triangle, sorted.
using Corner = std::array<float, 14>;
std::vector<std::array<Corner, 3>> corners_of(const Mesh& mesh, const MeshReflectance& reflectance) {
    std::vector<std::array<Corner, 3>> triangles;
    for (const auto& triangle : mesh.triangles) {
        auto& corners = triangles.emplace_back();
        for (size_t i = 0; i < 3; ++i) {
            const uint32_t v = triangle[i];
            const glm::vec3 p = mesh.positions_m.at(v), n = mesh.normals.at(v), c = mesh.colors.at(v);
            const glm::vec4 kd = reflectance.kd.at(v);
            corners[i] = {p.x, p.y, p.z,  n.x,  n.y,  n.z,  c.x,
                          c.y, c.z, kd.r, kd.g, kd.b, kd.a, static_cast<float>(reflectance.labels.at(v))};
        }
    }
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

TEST_F(StreamingTest, CellsAreTogetherTheWholeSurface) {
    std::vector<Mesh> kept;
    for (const uint32_t resident_blocks : {0u, 1u}) {
        Pipeline pipeline(device(), settings(resident_blocks, 1));
        pipeline.set_lights(tour_.lights);
        add(pipeline, 0, tour_.frames.size());
        const std::vector<SegmentReflectance> segments = pipeline.segments();
        if (resident_blocks > 0) {
            const gpu::MapCounters map = pipeline.counters().map;
            EXPECT_GT(pipeline.streamed_blocks().away + map.capacity - map.free_blocks, map.capacity)
                << "the pool cannot hold the whole at once";
        }
        std::vector<Mesh> cells;
        std::vector<std::array<Corner, 3>> together;
        const auto take = [&](const Mesh& cell, const MeshReflectance& reflectance) {
            std::vector<bool> used(cell.positions_m.size());
            for (const auto& triangle : cell.triangles) {
                for (const uint32_t vertex : triangle) used.at(vertex) = true;
            }
            EXPECT_EQ(std::count(used.begin(), used.end(), false), 0);
            EXPECT_EQ(reflectance.segments.size(), segments.size());
            const auto corners = corners_of(cell, reflectance);
            together.insert(together.end(), corners.begin(), corners.end());
            cells.push_back(cell);
        };
        pipeline.give_surface(segments, take, 1.7);
        EXPECT_GT(cells.size(), 7u);
        std::sort(together.begin(), together.end());
        const Mesh whole = pipeline.extract_surface();
        EXPECT_TRUE(same_bytes(together, corners_of(whole, pipeline.sample_reflectance(whole))));

        size_t pieces = 0;
        const auto take_one = [&](const Mesh& mesh, const MeshReflectance& reflectance) {
            ++pieces;
            EXPECT_TRUE(same_bytes(mesh.positions_m, whole.positions_m));
            EXPECT_TRUE(same_bytes(mesh.triangles, whole.triangles));
            EXPECT_TRUE(reflectance.kd.empty() && reflectance.labels.empty());
        };
        pipeline.give_surface({}, take_one, 100);
        EXPECT_EQ(pieces, 1u);

        if (kept.empty()) {
            kept = std::move(cells);
            continue;
        }
        ASSERT_EQ(cells.size(), kept.size());
        for (size_t i = 0; i < cells.size(); ++i) {
            EXPECT_TRUE(same_bytes(cells[i].positions_m, kept[i].positions_m));
            EXPECT_TRUE(same_bytes(cells[i].normals, kept[i].normals));
            EXPECT_TRUE(same_bytes(cells[i].colors, kept[i].colors));
            EXPECT_TRUE(same_bytes(cells[i].triangles, kept[i].triangles));
        }
    }
}

/// From one end of the street to the other and back, without a way: whole rooms come back at once.
TEST_F(StreamingTest, ACameraThatJumpsFindsWhatItHadLeft) {
    const auto jump = [&](uint32_t resident_blocks) {
        Pipeline pipeline(device(), settings(resident_blocks));
        pipeline.set_lights(tour_.lights);
        for (const size_t first : {0, 27, 1, 28, 12, 2}) add(pipeline, first, first + 6);
        return result_of(pipeline);
    };
    const Result all = jump(0), few = jump(1);
    EXPECT_GT(few.streamed.awaited, 500u);
    EXPECT_GT(few.records.awaited, 300u);
    EXPECT_LE(few.streamed.awaited, few.streamed.returned);
    EXPECT_EQ(few.counters.map.refused_blocks, 0u);
    expect_same_scene(few, all);
}

TEST_F(StreamingTest, ViewsOfWhatIsAwayBringItBack) {
    Pipeline pipeline(device(), settings(1));
    pipeline.set_lights(tour_.lights);
    Pipeline whole(device(), settings(0));
    whole.set_lights(tour_.lights);
    add(pipeline, 0, kFarEnd);
    add(whole, 0, kFarEnd);
    ASSERT_GT(pipeline.streamed_blocks().away, 500u);
    const auto view = [&](Pipeline& of, const RigidTransform& pose) {
        const ViewReadback seen = of.view(tour_.info.depth, pose);
        of.wait();
        return seen.get();
    };
    // As a frame saw it; and along the street, farther than frames see.
    RigidTransform along(1.0);
    along[0] = {0, 0, -1, 0};
    along[2] = {1, 0, 0, 0};
    for (const RigidTransform& pose : {*tour_.frames[3].world_from_camera, along}) {
        const ModelView back = view(pipeline, pose), there = view(whole, pose);
        EXPECT_TRUE(same_bytes(back.position_m.pixels(), there.position_m.pixels()));
        EXPECT_TRUE(same_bytes(back.color.pixels(), there.color.pixels()));
        EXPECT_TRUE(same_bytes(back.label.pixels(), there.label.pixels()));
        uint32_t seen = 0, far = 0;
        for (const glm::vec4& point : there.position_m.pixels()) {
            seen += point.w > 0 ? 1 : 0;
            far += point.w > 3 ? 1 : 0;
        }
        EXPECT_GT(seen, 1500u);
        EXPECT_EQ(far > 100, pose == along);
    }
}

/// Of another place, and of a pool that cannot hold both that and what frames look at.
TEST_F(StreamingTest, ViewsBetweenFramesMakeNoDifference) {
    const Result& all = whole();
    ReconstructionSettings tight = settings(1);
    tight.reflectance->limit_records = kTightRecords;
    Pipeline pipeline(device(), tight);
    pipeline.set_lights(tour_.lights);
    for (size_t i = 0; i < tour_.frames.size(); ++i) {
        add(pipeline, i, i + 1);
        // Between two choices of samples.
        if (i % 8 == 2 || i % 8 == 5)
            pipeline.view(tour_.info.depth, *tour_.frames[(i + kFarEnd) % kFrames].world_from_camera);
    }
    const Result few = result_of(pipeline), alone = reconstruct(tight);
    EXPECT_EQ(few.counters.observations.records.refused_blocks, 0u);
    EXPECT_GT(few.records.left, alone.records.left + 20000) << "views take places";
    expect_same_scene(few, all);
}

TEST_F(StreamingTest, WhatTheColorCameraSeesIsOnTheDeviceToo) {
    const Stages stages(device(), settings(1));
    const PosedCamera depth = make_posed_camera(tour_.info.depth, RigidTransform(1.0));
    Intrinsics wide = tour_.info.color;
    wide.fx = wide.fy = 0.4 * wide.fx;
    RigidTransform beside(1.0);
    beside[3] = {0.3, 0, 0, 1};
    const PosedCamera color = make_posed_camera(wide, beside);
    const StreamRegion region = stages.geometry.around(depth, color);
    const StreamRegion depth_alone = stages.geometry.around(depth, depth);
    const gpu::VoxelGrid grid = stages.geometry.map().grid();
    const auto holds = [&](const StreamRegion& of, double u, double v) {
        const glm::dvec3 seen(1.6 * (u - wide.cx) / wide.fx, 1.6 * (v - wide.cy) / wide.fy, 1.6);
        return of.holds(grid, glm::ivec3(glm::floor((seen + glm::dvec3(beside[3])) / 0.16)));
    };
    const double right = wide.extent.width - 1.0, bottom = wide.extent.height - 1.0;
    for (const double u : {0.0, right / 2, right}) {
        for (const double v : {0.0, bottom / 2, bottom}) EXPECT_TRUE(holds(region, u, v)) << u << ", " << v;
    }
    EXPECT_FALSE(holds(depth_alone, right, bottom));
}

TEST_F(StreamingTest, TilesHoldEachRecordOnce) {
    Pipeline pipeline(device(), settings(0));
    pipeline.set_lights(tour_.lights);
    add(pipeline, 0, kFarEnd);
    pipeline.wait();
    const ObservationMap& map = pipeline.reflectance()->observations();
    graph::FrameGraph graph = runner().begin();
    const graph::Readback read = graph.read_back(map.import(graph).block_keys);
    run(std::move(graph));
    std::vector<glm::ivec3> observed;
    for (const uint32_t key : read.as<uint32_t>()) {
        if (key != gpu::kEmptyKey) observed.push_back(block_of_key(map.grid(), key));
    }
    const double block_m = double{map.settings().block_m};
    EXPECT_EQ(tiles_of_records(observed, block_m, 100).size(), 1u) << "one ball holds all";
    const std::vector<MapTile> tiles = tiles_of_records(observed, block_m, 1.6);
    EXPECT_GT(tiles.size(), 10u);
    for (const glm::ivec3& block : observed) {
        const glm::vec3 center_m = (glm::vec3(block) + 0.5f) * map.settings().block_m;
        uint32_t holding = 0;
        for (const MapTile& tile : tiles) {
            const glm::vec3 apart = glm::abs(center_m - glm::vec3(tile.part.cube_m));
            if (std::max({apart.x, apart.y, apart.z}) > tile.part.cube_m.w) continue;
            ++holding;
            EXPECT_LT(glm::distance(center_m, glm::vec3(tile.part.ball_m)), 0.5f * tile.part.ball_m.w);
            EXPECT_TRUE(tile.around.holds(pipeline.map().grid(), block));
            EXPECT_TRUE(tile.cube.holds(pipeline.map().grid(), block));
        }
        EXPECT_EQ(holding, 1u);
    }
    EXPECT_GT(observed.size(), 300u);
}

TEST_F(StreamingTest, ARunGoesOnFromAStateOfWhichPartsAreAway) {
    const Result& at_once = streamed();
    const test::TemporaryFolder folder;
    MapFile map(folder / "map.sqlite");
    {
        Pipeline pipeline(device(), settings(1));
        pipeline.set_lights(tour_.lights);
        add(pipeline, 0, kFarEnd + 3);
        Transaction change(map.database());
        StateWriter writer(device(), map);
        pipeline.visit(writer);
        writer.finish();
        change.commit();
        ASSERT_GT(pipeline.streamed_blocks().away, 500u);
    }
    Pipeline pipeline(device(), settings(1));
    pipeline.set_lights(tour_.lights);
    StateReader reader(device(), map);
    pipeline.visit(reader);
    reader.finish();
    ASSERT_GT(pipeline.streamed_blocks().away, 500u);
    add(pipeline, kFarEnd + 3, tour_.frames.size());
    const Result again = result_of(pipeline);
    expect_same_scene(again, at_once);
    EXPECT_EQ(again.streamed.left, at_once.streamed.left);
    EXPECT_EQ(again.streamed.away, at_once.streamed.away);
    EXPECT_EQ(again.streamed.returned, at_once.streamed.returned);
    EXPECT_EQ(again.records.left, at_once.records.left);
    EXPECT_EQ(again.records.away, at_once.records.away);
}

TEST_F(StreamingTest, WhatAGraphThatWasNotSubmittedWasToBringIsStillAway) {
    Stages stages(device(), settings(1));
    stages.reflectance->set_lights(tour_.lights);
    Streaming streaming(runner(), stages);
    PosedFusion fusion(runner(), stages, streaming);
    for (size_t i = 0; i < kFarEnd; ++i) fusion.add(patina::to_rgbd(tour_.info, tour_.frames[i]));
    runner().wait();
    const auto all_blocks = [&] {
        std::set<std::array<int, 4>> blocks;
        for (const glm::ivec3& block : streaming.blocks()) blocks.insert({0, block.x, block.y, block.z});
        for (const glm::ivec3& block : streaming.observed_blocks()) blocks.insert({1, block.x, block.y, block.z});
        return blocks;
    };
    const auto before = all_blocks();
    const uint64_t away = streaming.block_counts().away, records_away = streaming.record_counts().away;
    ASSERT_GT(away, 500u);
    ASSERT_GT(records_away, 1000u);
    const PosedCamera start = make_posed_camera(tour_.info.depth, *tour_.frames[3].world_from_camera);
    for (uint32_t index = kFarEnd; index < kFarEnd + 4; ++index) {  // in one of them blocks leave, too
        const ComingPlaces coming = streaming.plan(stages.geometry.around(start, start), index, {true, true});
        ASSERT_GT(coming.voxel_blocks, 100u);
        ASSERT_GT(coming.observed_blocks, 50u);
        ASSERT_GT(coming.observed_records, coming.observed_blocks);
        graph::FrameGraph graph = runner().begin();
        streaming.add(graph);
    }
    EXPECT_EQ(streaming.block_counts().away, away);
    EXPECT_EQ(streaming.record_counts().away, records_away);
    EXPECT_EQ(all_blocks(), before);
    EXPECT_TRUE(streaming.require_blocks(stages.geometry.around(start, start)));
    EXPECT_TRUE(streaming.require_records(stages.geometry.around(start, start)));
    EXPECT_LT(streaming.block_counts().away, away);
    EXPECT_EQ(all_blocks(), before);
}

}  // namespace
}  // namespace patina::streaming_test
