#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/graph/runner.h"
#include "patina/frame.h"
#include "patina/lighting.h"
#include "patina/scene.h"
#include "reconstruction/model_view.h"
#include "reconstruction/pipeline_counters.h"
#include "reconstruction/posed_fusion.h"
#include "reconstruction/reconstruction_settings.h"
#include "reconstruction/stages/stages.h"
#include "reconstruction/streaming/streaming.h"
#include "reconstruction/texture/bake_texture.h"
#include "reconstruction/texture/shown_pictures.h"
#include "reconstruction/tracked_fusion.h"
#include "reconstruction/view_readback.h"

namespace patina {

/// Fuses RGB-D frames into a volume and extracts its surface. Frames are submitted without waiting for the device, two
/// in flight. Joins the stages with the two ways to fuse, at poses that are given and at poses that tracking finds. One
/// device, one thread.
class Pipeline {
  public:
    /// Throws Error for settings that cannot be met, or lack of memory. The device must outlive this.
    Pipeline(vulkan::Device& device, const ReconstructionSettings& settings);

    /// Replaces all lights of the reflectance; at any time. `ambient` is irradiance over pi, linear pixel value.
    /// Without reflectance nothing changes. Throws Error as Lights::set does.
    void set_lights(std::span<const Light> lights, glm::dvec3 ambient = glm::dvec3(0));
    /// Sets the specular material of a label (SegmentMaterials::set); at any time. Without reflectance nothing changes.
    void set_material(uint32_t label, glm::vec3 ks, float alpha);

    /// Fuses a frame. The first one places the volume around its camera. With tracking its pose is found first: one
    /// graph fuses the frame before, casts the model and searches, and its end is waited for; the frame itself, whose
    /// pictures stay on the device, is fused by the next one's graph, or as soon as anything is asked of the model.
    /// Returns whether the frame is fused: without tracking all are, with it those that track. Throws Error when a
    /// picture is not its camera's size, or the device was lost.
    bool add(const RgbdFrame& frame);

    /// Fuses a frame at its given pose although others are tracked; tracking goes on from there. Throws Error as add().
    void add_posed(const RgbdFrame& frame);

    /// Takes a frame of low exposure, which shows how bright is what the others clip: lamps, windows, patches of sun.
    /// At any time, best before the first frame; in the frames' world. `radiance_scale` is their exposure over its own;
    /// pixels from `lamp_luminance` on, 1 being full scale, are lamps', which lights tell of, and left out. Before the
    /// first frame, where poses are given and gloss is estimated, it tells geometry and segments, too, and which of
    /// them are mirrors.
    /// Without reflectance nothing changes. Throws Error when a picture is not its camera's size.
    void add_low_exposure(const RgbdFrame& frame, float radiance_scale, float lamp_luminance);
    /// There are no more of them before the first frame.
    void end_low_exposure() { fusion_.end_preceding(); }

    /// Asks `relocaliser` for poses of every frame that tracking lost, instead of the keyframes; the first from which
    /// the frame tracks is taken. Without tracking nothing changes.
    void set_relocaliser(Relocaliser relocaliser);

    /// How the last frame was tracked, and from where it was taken; null where poses are given.
    const TrackingReport* tracking_report() const { return tracking() ? &tracking()->last() : nullptr; }

    /// Casts the model into a pinhole camera (lens distortion is left out). Ready two frames later, or after wait().
    ViewReadback view(const Intrinsics& camera, const RigidTransform& world_from_camera);

    /// The same without the way to the host: `use` adds passes to the view's graph, and keeps what they write. Only
    /// after a frame was fused. Returns how long the device takes for it. Throws Error as view(), and what `use`
    /// throws.
    using UseView = std::function<void(graph::FrameGraph&, const ModelImages&)>;
    graph::FrameTime draw(const Intrinsics& camera, const RigidTransform& world_from_camera, const OtherLights* other,
                          const UseView& use);

    /// How far surfaces are fused and seen, metres along the optical axis of a depth camera (GeometryStage::range).
    float reach_m(const Intrinsics& camera) const { return stages_.geometry.range(camera).reach_m; }

    /// Fuses what waits to be, and waits for the device.
    void wait();

    /// Walks over all that later frames depend on; waits. What is brought back was kept by a pipeline with the same
    /// settings, and takes the place of what there is.
    void visit(graph::StateVisitor& visitor);

    /// The next frame is of another recording: where it was taken is looked for in the keyframes, in no relation to the
    /// frame before. Without tracking nothing changes.
    void begin_recording();

    /// Extracts the surface from what was fused so far; waits.
    Mesh extract_surface();

    /// What all segments reflect, by label, brought up to date before; waits. Empty without reflectance.
    std::vector<SegmentReflectance> segments();

    /// What arrives from where there is no surface, as Scene::far_field has it; waits. Empty where no light is
    /// gathered.
    Image<glm::vec4> far_field();

    /// The windows that pictures showed beside these lamps, as rectangles, seen by cameras on this trajectory; waits.
    /// None where no light is gathered.
    std::vector<AreaLight> windows(std::span<const TimedPose> trajectory, std::span<const Light> lamps);

    /// The surface piece by piece, so that memory need not hold it at once: in cells of `cell_m`, with the vertices at
    /// their borders on both sides. A map that fits into one is one piece, the mesh of extract_surface(). `segments`:
    /// of segments(); empty: without what pieces reflect. Waits. Throws Error as SurfaceCells does, and what `take`
    /// throws.
    static constexpr double kSurfaceCell_m = 8;
    using TakeSurface = std::function<void(const Mesh&, const MeshReflectance&)>;
    void give_surface(const std::vector<SegmentReflectance>& segments, const TakeSurface& take,
                      double cell_m = kSurfaceCell_m);

    /// What a mesh of the surface and all segments reflect, brought up to date before; waits. Empty without
    /// reflectance.
    MeshReflectance sample_reflectance(const Mesh& mesh);

    /// Bakes a texture for a surface of this map (export/atlas/lay_out_texture.h lays it out) from what `give` gives
    /// one after the other, best all keyframes of the frames that were fused; waits. Throws Error as TextureBake does.
    using TakePicture = std::function<void(const TexturePicture&)>;
    std::vector<TexturePage> bake_texture(const TextureLayout& layout,
                                          const std::function<void(const TakePicture&)>& give);

    /// What view() shows from now on has the detail of these pictures, where they show it (ShownPictures); of more than
    /// fit, some. `count`: how many `give` gives, of a camera as `camera`. Of the frames that were fused so far: asked
    /// for before relight(), as their light is divided out at once. Without reflectance nothing changes. Throws Error
    /// as ShownPictures::add does.
    void show_pictures(const Intrinsics& camera, size_t count, const std::function<void(const TakePicture&)>& give);

    /// Brings all of the reflectance up to date, where there is any; else that is spread over frames.
    void refine_all();

    /// Puts the model under other light than that of its frames, for views alone: no frame may be added after that.
    /// Brings the reflectance up to date first. Where light is gathered, surfaces light each other, and mirrors show
    /// what is around them under it. Without reflectance nothing changes. Throws Error as Lights::set does.
    void relight(const Relighting& relighting);

    /// Counters as of at most two frames ago; exact after wait(). Does not wait. With tracking, the last frame is
    /// counted only after wait(); runner().wait() does not fuse it.
    PipelineCounters counters();

    /// The keyframes' counters; waits. Zero without keyframes.
    gpu::KeyframeCounters keyframe_counters();

    /// The colour gains of the frames so far (ColorCorrection::gains), with the delay of counters(); empty where the
    /// settings estimate none.
    std::span<const gpu::ColorGains> gains();

    /// How many voxel blocks, and how many observed voxels, are away from the device, as far as it has finished.
    StreamCounts streamed_blocks() { return streaming_.block_counts(); }
    StreamCounts streamed_records() { return streaming_.record_counts(); }
    /// A sentence where more of those stay in memory than should; else empty.
    std::string stream_problem() const { return streaming_.problem(); }

    uint32_t frames() const;  ///< fused, or about to be
    const ReconstructionSettings& settings() const { return stages_.settings; }
    const VoxelMap& map() const { return stages_.geometry.map(); }
    graph::Runner& runner() { return runner_; }

    // The stages besides the geometry; null where the settings have none.
    const SegmentationStage* segmentation() const { return pointer_to(stages_.segmentation); }
    const ReflectanceStage* reflectance() const { return pointer_to(stages_.reflectance); }
    const SpecularStage* specular() const { return pointer_to(stages_.specular); }
    const TrackingStage* tracking() const { return pointer_to(stages_.tracking); }
    const KeyframeStage* keyframes() const { return pointer_to(stages_.keyframes); }

  private:
    using UseTile = std::function<void(graph::FrameGraph&, const RefinedPart&)>;

    void fuse_waiting();
    /// A frame for each part of the records, with all on the device that shades it.
    void for_each_tile(const UseTile& use);
    MeshReflectance sample_part_by_part(const Mesh& mesh);
    TextureLayout sampled_between_vertices(const TextureLayout& layout);

    graph::Runner runner_;
    Stages stages_;
    Streaming streaming_;
    PosedFusion fusion_;
    std::optional<TrackedFusion> tracked_;   ///< empty where poses are given
    std::optional<ShownPictures> pictures_;  ///< of views; empty without
    uint32_t low_exposures_ = 0;             ///< frames of low exposure so far
    uint32_t gathered_after_ = 0;            ///< frames, when refine_all() gathered light last
};

}  // namespace patina
