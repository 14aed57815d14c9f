#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "patina/camera.h"
#include "patina/image.h"
#include "patina/lighting.h"

namespace patina {

/// A welded triangle mesh in world coordinates (metres). The three vertex arrays have one length. Triangles are
/// counter-clockwise seen from outside (free space).
struct Mesh {
    std::vector<glm::vec3> positions_m;
    std::vector<glm::vec3> normals;  ///< unit length, towards free space
    std::vector<glm::vec3> colors;   ///< linear RGB; zero where no colour was seen
    std::vector<std::array<uint32_t, 3>> triangles;
};

/// Ward's specular material (paper, Eq. 2-4).
struct WardGloss {
    glm::vec3 ks{0};                    ///< RGB specular albedo
    float alpha = 1;                    ///< roughness, in (0, 1]
    std::optional<float> confidence{};  ///< of an estimate: 0 to 1
};

/// Where a segment's material lies with some probability.
struct MaterialInterval {
    glm::vec3 kd_low{0}, kd_high{1};  ///< RGB diffuse albedo
    glm::vec3 ks_low{0}, ks_high{1};  ///< RGB specular albedo
    float alpha_low = 0, alpha_high = 1;
};

/// Probabilities of a segment's intervals.
inline constexpr std::array kIntervalLevels = {0.5, 0.8, 0.9, 0.95};
/// The one that is reported first.
inline constexpr size_t kIntervalLevel = 2;

/// What is known of a segment.
struct SegmentReflectance {
    std::optional<glm::vec3> kd;     ///< mean over its voxels; empty where too few know it
    std::optional<WardGloss> gloss;  ///< empty: all is diffuse
    uint32_t voxels = 0;             ///< that were observed
    uint32_t observations = 0;       ///< kept by them
    float confidence = 0;            ///< mean certainty of kd over its voxels, of the least sure channel: 0 to 1
    /// One per kIntervalLevels, where a fit estimated the gloss. Each holds the estimate; kd's is 0 to 1 without one.
    std::optional<std::array<MaterialInterval, kIntervalLevels.size()>> intervals{};
};

/// What the surface of a mesh reflects.
struct MeshReflectance {
    std::vector<glm::vec4> kd;     ///< by vertex: diffuse albedo; a: 1 known, 0.5 its segment's, 0 unknown (all is 0)
    std::vector<uint32_t> labels;  ///< by vertex: segment, 0 for none
    std::vector<SegmentReflectance> segments;  ///< by label; label 0 is no segment
};

/// A camera's pose at a time.
struct TimedPose {
    double timestamp_s = 0;
    RigidTransform world_from_camera{1.0};
};

/// A finished reconstruction. Mesh, lights and trajectory are in one world, whose origin is at `world_offset_m` of the
/// recording's: 0 but for a recording that is more than 1 km from its own origin.
struct Scene {
    std::string name = "scene";
    Mesh mesh;
    MeshReflectance reflectance;             ///< of the mesh; empty where there was no light to find it by
    std::vector<std::string> segment_names;  ///< by label, where they are known
    Lighting lighting;
    std::vector<TimedPose> trajectory;  ///< of the depth camera, in the frames that were fused
    glm::dvec3 world_offset_m{0};
    std::optional<glm::dvec3> gravity{};  ///< direction in which things fall; empty where it is not recorded
    /// What pictures showed where there is no surface, such as a sky, and in windows: a square octahedral map of
    /// directions in the world, +z in the middle, -z in the corners. rgb: radiance, linear pixel value; a: 1 where a
    /// picture looked, else 0, and ambient light arrives. Empty where no light was gathered.
    Image<glm::vec4> far_field{};

    /// Writes a binary glTF 2.0 with materials and lights, upright and on the floor, whole or not at all. Throws Error
    /// for a value that is not finite, a mesh that is too large for glTF, or a file that cannot be written.
    void save_glb(const std::filesystem::path& file) const;

    /// Writes scene.glb, trajectory.txt and, where there are any, materials.json, lights.json and environment.exr (the
    /// light from afar) into a folder, which is created where there is none. Throws Error as save_glb() does.
    void save(const std::filesystem::path& folder) const;
};

}  // namespace patina
