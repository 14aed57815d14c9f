#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "engine/vulkan/device.h"
#include "patina/scene.h"
#include "reconstruction/pipeline.h"

namespace patina {

/// The model of a session's map, to look at: without a source, so that nothing is fused any more.
class StoredMap {
  public:
    /// Reads it. Throws Error where the file is missing, no map or damaged, or the device lacks memory. The device must
    /// outlive this.
    StoredMap(vulkan::Device& device, const std::filesystem::path& file);

    Pipeline& pipeline() { return *pipeline_; }
    const Intrinsics& camera() const { return camera_; }            ///< the depth camera of its recording
    const std::vector<TimedPose>& poses() const { return poses_; }  ///< of the depth camera, in frames that were fused
    const Lighting& lighting() const { return lighting_; }          ///< in the model's world

    /// Surface, materials, lights and trajectory; waits.
    Scene scene();

  private:
    std::string name_;
    Intrinsics camera_;
    std::vector<TimedPose> poses_;
    Lighting lighting_;
    glm::dvec3 world_offset_m_{0};
    std::unique_ptr<Pipeline> pipeline_;
};

}  // namespace patina
