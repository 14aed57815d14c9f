#include "reconstruction/pipeline.h"

#include <algorithm>

#include "passes/input/convert_color.h"
#include "passes/input/convert_depth.h"
#include "reconstruction/sample_surface.h"
#include "reconstruction/segment_intervals.h"
#include "reconstruction/streaming/map_tiles.h"
#include "reconstruction/streaming/surface_cells.h"
#include "reconstruction/texture/split_triangles.h"

namespace patina {

Pipeline::Pipeline(vulkan::Device& device, const ReconstructionSettings& settings)
    : runner_(device), stages_(device, settings), streaming_(runner_, stages_), fusion_(runner_, stages_, streaming_) {
    if (stages_.tracking) tracked_.emplace(runner_, stages_, fusion_);
}

void Pipeline::set_lights(std::span<const Light> lights, glm::dvec3 ambient) {
    if (stages_.reflectance) stages_.reflectance->set_lights(lights, ambient);
}

void Pipeline::set_material(uint32_t label, glm::vec3 ks, float alpha) {
    if (stages_.reflectance) stages_.reflectance->set_material(label, ks, alpha);
}

void Pipeline::set_relocaliser(Relocaliser relocaliser) {
    if (tracked_) tracked_->set_relocaliser(std::move(relocaliser));
}

bool Pipeline::add(const RgbdFrame& frame) {
    check_frame(frame, frames());
    if (tracked_) return tracked_->add(frame);
    fusion_.add(frame);
    return true;
}

void Pipeline::add_posed(const RgbdFrame& frame) {
    check_frame(frame, frames());
    if (tracked_) return tracked_->add_posed(frame);
    fusion_.add(frame);
}

void Pipeline::add_low_exposure(const RgbdFrame& frame, float radiance_scale, float lamp_luminance) {
    if (!stages_.reflectance) return;
    check_frame(frame, low_exposures_);
    const FrameCameras cameras = make_frame_cameras(frame);
    graph::FrameGraph graph = runner_.begin();
    stages_.reflectance->add_low_exposure(
        graph, {add_convert_depth(graph, frame.depth), add_convert_color(graph, frame.color), cameras.depth.gpu,
                cameras.color.gpu, low_exposures_++, radiance_scale, lamp_luminance});
    runner_.submit(std::move(graph));
    if (frames() == 0 && !tracked_ && stages_.specular) fusion_.add_preceding(frame, radiance_scale);
}

void Pipeline::fuse_waiting() {
    if (tracked_) tracked_->fuse_waiting();
}

void Pipeline::wait() {
    fuse_waiting();
    runner_.wait();
}

void Pipeline::visit(graph::StateVisitor& visitor) {
    wait();
    streaming_.prepare_visit();
    stages_.visit(visitor);
    streaming_.visit(visitor);
    fusion_.visit(visitor);
    if (tracked_) tracked_->visit(visitor);
    if (visitor.brings_back()) gathered_after_ = 0;
}

void Pipeline::begin_recording() {
    if (tracked_) tracked_->begin_recording();
}

uint32_t Pipeline::frames() const { return fusion_.frames() + (tracked_ && tracked_->has_waiting() ? 1 : 0); }

ViewReadback Pipeline::view(const Intrinsics& camera, const RigidTransform& world_from_camera) {
    fuse_waiting();
    fusion_.require(camera, world_from_camera);
    graph::FrameGraph graph = runner_.begin();
    ViewReadback view =
        wire_view(graph, stages_, make_posed_camera(camera, world_from_camera), pictures_ ? &*pictures_ : nullptr);
    runner_.submit(std::move(graph));
    return view;
}

graph::FrameTime Pipeline::draw(const Intrinsics& camera, const RigidTransform& world_from_camera,
                                const OtherLights* other, const UseView& use) {
    fuse_waiting();
    fusion_.require(camera, world_from_camera);
    graph::FrameGraph graph = runner_.begin();
    use(graph, add_model_view(graph, stages_, make_posed_camera(camera, world_from_camera), Gloss::kMean, other));
    const graph::FrameTime time = graph.time();
    runner_.submit(std::move(graph));
    return time;
}

Mesh Pipeline::extract_surface() {
    if (fusion_.frames() == 0) return {};
    wait();
    SurfaceCells whole(runner_, map(), streaming_, std::nullopt);
    return whole.size() > 0 ? whole.extract(0) : Mesh{};
}

void Pipeline::give_surface(const std::vector<SegmentReflectance>& segments, const TakeSurface& take, double cell_m) {
    if (fusion_.frames() == 0) return;
    wait();
    SurfaceCells cells(runner_, map(), streaming_, cell_m);
    for (size_t i = 0; i < cells.size(); ++i) {
        const Mesh mesh = cells.extract(i);
        MeshReflectance sampled;
        if (!segments.empty()) {
            sampled = sample_part_by_part(mesh);
            sampled.segments = segments;
        }
        take(mesh, sampled);
    }
}

std::vector<TexturePage> Pipeline::bake_texture(const TextureLayout& layout,
                                                const std::function<void(const TakePicture&)>& give) {
    if (layout.pages.empty()) return {};
    refine_all();
    TextureBake bake(runner_, stages_, sampled_between_vertices(layout));
    give([&](const TexturePicture& picture) {
        fusion_.require(picture.color.camera, picture.world_from_camera);
        bake.add(picture);
    });
    std::vector<TexturePage> pages = bake.finish();
    bake.add_detail(layout, pages);
    return pages;
}

/// A simplified surface has few vertices, between which its albedo may change.
TextureLayout Pipeline::sampled_between_vertices(const TextureLayout& layout) {
    TextureLayout fine{layout.texel_m, layout.pages, {}, layout.boxes};
    for (const TexturedSurface& piece : layout.pieces) {
        if (piece.reflectance.kd.empty() || !stages_.reflectance) {
            fine.pieces.push_back(piece);
            continue;
        }
        // No shorter than a tile of texels, each of which looks at all triangles of its tile.
        const double record_m = double{stages_.reflectance->observations().settings().voxel_m};
        const double longest_m = std::max(record_m, layout.texel_m * gpu::kTextureTile);
        TexturedSurface& split = fine.pieces.emplace_back(with_short_edges(piece, longest_m));
        const MeshReflectance sampled = sample_part_by_part(split.mesh);
        for (size_t i = 0; i < sampled.kd.size(); ++i) {
            if (sampled.kd[i].a == 0) continue;  // off the records: what is between the corners
            split.reflectance.kd[i] = sampled.kd[i];
            split.reflectance.labels[i] = sampled.labels[i];
        }
    }
    return fine;
}

void Pipeline::show_pictures(const Intrinsics& camera, size_t count,
                             const std::function<void(const TakePicture&)>& give) {
    pictures_.reset();
    if (!stages_.reflectance || fusion_.frames() == 0 || count == 0) return;
    refine_all();
    pictures_.emplace(runner_, stages_);
    const size_t most = ShownPictures::most_of(camera), every = (count + most - 1) / most;
    size_t number = 0;
    give([&](const TexturePicture& picture) {
        if (number++ % every != 0) return;
        fusion_.require(picture.color.camera, picture.world_from_camera);
        pictures_->add(picture);
    });
}

void Pipeline::for_each_tile(const UseTile& use) {
    const double block_m = double{stages_.reflectance->observations().settings().block_m};
    for (const MapTile& tile : tiles_of_records(streaming_.observed_blocks(), block_m, settings().around_m)) {
        streaming_.require_blocks(tile.around);
        streaming_.require_records(tile.cube);
        graph::FrameGraph graph = runner_.begin();
        use(graph, tile.part);
        runner_.submit(std::move(graph));
    }
}

void Pipeline::refine_all() {
    if (!stages_.reflectance || fusion_.frames() == 0) return;
    fuse_waiting();
    // Asking twice gives the same: more rays of the same map would change all a little.
    const bool gathers = gathered_after_ != fusion_.frames();
    gathered_after_ = fusion_.frames();
    for_each_tile([&](graph::FrameGraph& graph, const RefinedPart& part) {
        stages_.reflectance->refine_all(graph, map().import(graph), gathers, part);
    });
}

void Pipeline::relight(const Relighting& relighting) {
    if (!stages_.reflectance || fusion_.frames() == 0) return;
    refine_all();
    const std::vector<RelightTurn> turns = stages_.reflectance->relight(relighting);
    if (pictures_) pictures_->relight();
    if (turns.empty()) return refine_all();
    const auto change_voxels = [&](graph::FrameGraph& graph, const std::function<void(VoxelMapIds&)>& change) {
        VoxelMapIds voxels = map().import(graph);
        change(voxels);
        VoxelMap::keep(graph, voxels);
    };
    graph::FrameGraph forgets = runner_.begin();
    change_voxels(forgets,
                  [&](VoxelMapIds& voxels) { stages_.reflectance->add_forget_light(forgets, voxels, relighting); });
    runner_.submit(std::move(forgets));
    for (const RelightTurn& turn : turns) {
        for_each_tile([&](graph::FrameGraph& graph, const RefinedPart& part) {
            change_voxels(graph,
                          [&](VoxelMapIds& voxels) { stages_.reflectance->add_relight(graph, voxels, turn, part); });
        });
    }
}

std::vector<SegmentReflectance> Pipeline::segments() {
    if (!stages_.reflectance || fusion_.frames() == 0) return {};
    refine_all();
    std::vector<SegmentReflectance> segments = read_segments(runner_, *stages_.reflectance);
    if (stages_.specular) add_intervals(runner_, *stages_.reflectance, *stages_.specular, segments);
    return segments;
}

Image<glm::vec4> Pipeline::far_field() {
    if (!stages_.reflectance || fusion_.frames() == 0) return {};
    wait();
    return read_far_field(runner_, *stages_.reflectance);
}

std::vector<AreaLight> Pipeline::windows(std::span<const TimedPose> trajectory, std::span<const Light> lamps) {
    if (!stages_.reflectance || fusion_.frames() == 0) return {};
    wait();
    glm::dvec3 inside_m(0);
    for (const TimedPose& pose : trajectory)
        inside_m += glm::dvec3(pose.world_from_camera[3]) / static_cast<double>(trajectory.size());
    return read_windows(runner_, *stages_.reflectance, inside_m, lamps);
}

MeshReflectance Pipeline::sample_reflectance(const Mesh& mesh) {
    if (!stages_.reflectance || fusion_.frames() == 0) return {};
    std::vector<SegmentReflectance> known = segments();
    MeshReflectance sampled = sample_part_by_part(mesh);
    sampled.segments = std::move(known);
    return sampled;
}

/// So that the device need not hold the records of all vertices at once.
MeshReflectance Pipeline::sample_part_by_part(const Mesh& mesh) {
    if (!streaming_.any_records_away()) return sample_vertices(runner_, *stages_.reflectance, mesh);
    const double block_m = double{stages_.reflectance->observations().settings().block_m};
    return sample_cube_by_cube(runner_, *stages_.reflectance, mesh, block_m,
                               [&](const StreamRegion& region) { return streaming_.require_records(region); });
}

PipelineCounters Pipeline::counters() {
    PipelineCounters counters = fusion_.counters();
    if (const TrackingReport* report = tracking_report()) counters.tracking = *report;
    return counters;
}

gpu::KeyframeCounters Pipeline::keyframe_counters() {
    if (!stages_.keyframes || fusion_.frames() == 0) return {};
    fuse_waiting();
    graph::FrameGraph graph = runner_.begin();
    const graph::Readback read = stages_.keyframes->read_counters(graph);
    runner_.submit(std::move(graph));
    runner_.wait();
    return read.as<gpu::KeyframeCounters>().front();
}

std::span<const gpu::ColorGains> Pipeline::gains() {
    if (!stages_.color_correction) return {};
    return stages_.color_correction->gains();
}

}  // namespace patina
