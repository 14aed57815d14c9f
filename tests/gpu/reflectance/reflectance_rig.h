#pragma once

#include <functional>
#include <vector>

#include "engine/graph/runner.h"
#include "passes/reflectance/reflectance.h"
#include "tests/reference/reflectance/smooth_irradiance.h"

namespace patina {

/// A record with what was made of its observations.
struct RefinedRecord {
    glm::ivec3 voxel{0};  ///< spans [v, v + 1) times its size from the world's origin
    glm::dvec3 point_m{0}, normal{0};
    uint32_t observations = 0;
    glm::dvec3 kd{0}, certainty{0};
    uint64_t visible = 0, uncertain = 0;  ///< a bit per light
    glm::uvec2 albedo{0};                 ///< as stored
    uint32_t label = 0;                   ///< of its segment; 0: none
    glm::dvec3 raw_kd{0};                 ///< kd where the light explains more than 1
    glm::dvec3 around{0};                 ///< albedo of the surface around; 0: not known
    reference::GatheredRays gathered;     ///< its own rays
    reference::GatheredRays incident;     ///< and of the records beside it
    glm::dvec3 bright{0};                 ///< at low exposure; 0: not known
};

/// As RecordStatus::incident holds them.
glm::uvec2 pack_rays(const reference::GatheredRays& rays);

/// Lights, materials and the refinement for maps that another rig fills, for tests.
class ReflectanceRig {
  public:
    ReflectanceRig(vulkan::Device& device, graph::Runner& runner, const VoxelMap& voxel_map,
                   const ObservationMap& observation_map);

    /// Gives the first `count` records this light from all around; what else they have stays.
    void set_incident(uint32_t count, const reference::GatheredRays& rays);

    /// The same with light of their own for the first records.
    void set_incident(const std::vector<reference::GatheredRays>& rays);

    /// Gives the first records the radiance that low exposure showed.
    void set_bright(const std::vector<glm::vec3>& radiance);

    /// Lets records tell each other of their albedo (passes/reflectance/surface_albedo.h).
    void share_albedo(const glm::vec4& cube_m = RefinedPart{}.cube_m);

    /// Lets a pass add to the state, such as to its surroundings.
    void change(const std::function<void(graph::FrameGraph&, ReflectanceStateIds&)>& add);

    /// Sets how sure a label's segment is to have no diffuse part, beside its material.
    void set_mirror(uint32_t label, float mirror);
    /// Sets which share of a label's ks is a guess.
    void set_unobserved(uint32_t label, float share);

    struct Counts {
        uint32_t marched = 0, refined = 0;
    };
    using Fill = std::function<RecordList(graph::FrameGraph&, ObservationMapIds&)>;
    /// One frame's update; `fill` makes the list of changed records, none without it.
    Counts update(const ReflectanceSettings& settings, const Fill& fill = {});
    Counts update_all(const ReflectanceSettings& settings);
    /// One turn of putting all records under other lights; the first forgets all colours.
    void relight(const RelightTurn& turn);

    /// The first `count` records; without it all of the table, by voxel.
    std::vector<RefinedRecord> records(uint32_t count);
    std::vector<RefinedRecord> records();

    const ReflectanceState& state() const { return state_; }

    Lights lights;
    SegmentMaterials materials;
    ReflectanceAccess access;
    RefinedPart part;

  private:
    ReflectanceModels models() { return {voxel_map_, observation_map_, lights, materials, state_, part}; }
    void change_status(const std::function<void(std::vector<gpu::RecordStatus>&)>& change_all);
    void set_of_material(uint32_t label, uint64_t offset, float value);
    Counts submit(graph::FrameGraph frame, const ObservationMapIds& ids, const RefinedReflectance& refined);

    graph::Runner& runner_;
    const VoxelMap& voxel_map_;
    const ObservationMap& observation_map_;
    ReflectanceState state_;
};

}  // namespace patina
