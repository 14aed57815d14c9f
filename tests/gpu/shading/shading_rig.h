#pragma once

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "passes/state/lights.h"
#include "passes/state/reflectance_state.h"
#include "passes/state/segment_materials.h"
#include "shared/reflectance/reflectance.h"
#include "shared/shading/reflect_surroundings.h"
#include "shared/shading/sample_reflectance.h"
#include "tests/gpu/observation/observation_rig.h"
#include "tests/reference/reflectance/smooth_irradiance.h"
#include "tests/reference/shading/predict_radiance.h"

namespace patina {

/// Where a record lies.
struct RecordPlace {
    std::array<int, 3> voxel{};
    glm::dvec3 point_m{0};  ///< of its surface, below the voxel's centre
    glm::dvec3 normal{0};
    uint32_t observations = 0;
};

/// What the shading makes of a view.
struct ShadedView {
    Image<glm::vec4> position_m, normal, kd, ks_alpha, rgb, light, coverage;
    Image<uint32_t> label;
    Image<glm::vec4> picture_kd;
    std::vector<gpu::GlossyPixel> glossy;  ///< where gloss is apart
};

/// A model whose geometry and records come from the passes, and whose albedo, visibility and labels are painted on, for
/// tests.
class ShadingRig {
  public:
    ShadingRig(vulkan::Device& device, graph::Runner& runner, float voxel_m);

    /// Fuses and observes a scene from one pose.
    void see(const reference::DistanceField& field, const RigidTransform& world_from_camera);

    /// Gives every record what `paint` returns; normal and offset stay its own.
    void paint(const std::function<reference::ShadedRecord(const RecordPlace&)>& paint);

    ShadedView predict(const Intrinsics& camera, const RigidTransform& world_from_camera, bool shadows = true);

    /// What the model knows of these points, of these normals.
    std::vector<gpu::SampledReflectance> sample(const std::vector<glm::vec3>& points_m,
                                                const std::vector<glm::vec3>& normals);

    /// The sums of the first 64 segments.
    std::vector<gpu::SegmentAlbedo> average_segments();

    /// The painted model with the lights as the reference takes it.
    reference::ShadedScene scene() const;

    static const Intrinsics& camera();

    Lights lights;
    SegmentMaterials materials;
    std::optional<reference::GatheredRays> incident;  ///< light from all around of every record that is painted

    bool of_picture = false;            ///< views have the kd that their pictures are made with
    bool gloss_apart = false;           ///< PredictRadianceInputs::gloss_apart
    std::map<uint32_t, float> mirrors;  ///< SegmentMaterial::mirror by label, of materials that are set

  private:
    struct Stored {
        std::vector<gpu::VoxelRecord> records;
        std::vector<glm::uvec2> albedo, visibility;
        std::vector<gpu::RecordStatus> status;
        std::vector<gpu::RecordSurroundings> gathered;
    };
    Stored read();
    void set_mirror(uint32_t label, float mirror);
    void write(const Stored& stored);

    double voxel_m_;
    graph::Runner& runner_;
    ObservationRig observations_;
    ReflectanceState state_;
    std::map<std::array<int, 3>, reference::ShadedRecord> painted_;
};

}  // namespace patina
