#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "engine/vulkan/device.h"
#include "patina/image.h"
#include "scenes/files/scene_file.h"

namespace patina::tools {

/// Errors of poses, per axis.
struct PoseNoise {
    double translation_m = 0;
    double rotation_degrees = 0;
};

/// What `patina synth` was asked to do. What is empty stays as the scene says.
struct SynthOptions {
    std::string scene;  ///< name or file, as load_scene takes it
    std::filesystem::path out;
    uint32_t frames = 120;
    uint32_t truth_every = 0;  ///< truth/frames/NNNNNN.exr of every so many frames; 0 writes none
    uint32_t novel = 0;        ///< views that the path never has, in truth/novel and truth/relit; 0 writes none
    bool lighting = true;      ///< write lighting/ where the scene has a lighting sequence
    bool quiet = false;
    scenes::SceneChanges changes{};
    std::optional<std::string> noise{};  ///< name of a preset; poses keep their noise
    std::optional<PoseNoise> pose_noise{};
    std::optional<bool> shadows{};
    std::optional<bool> area_lights{};
    std::optional<uint32_t> bounces{};
    std::optional<uint32_t> samples{};
    std::optional<std::filesystem::path> environment{};  ///< picture of radiance, .hdr or .exr
    std::optional<bool> exr{};
    std::optional<Extent2D> extent{};  ///< of the depth camera; a colour camera of its own scales likewise
};

/// Records a scene as a sequence folder with truth/ (lights.json, materials.json, trajectory.txt, labels/NNNNNN.png in
/// the depth camera's pixels, frames/NNNNNN.exr in the colour camera's) and, where the scene has one, lighting/, a
/// sequence of its own with truth/. In truth/frames, kd_segment is the object's kd, for a texture its picture's mean;
/// rgb is radiance without noise or clipping, and there is no rgb_segment. truth/novel and truth/relit are sequences of
/// their own with truth (scenes/description/never_recorded.h): the same views under the recording's lamps and under
/// others. The folder appears whole or not at all.
/// Throws Error when the scene is unknown or wrong, an option is out of range, or the folder exists and is not empty or
/// cannot be written; Interrupted when the user stops it.
void synthesise(vulkan::Device& device, const SynthOptions& options);

}  // namespace patina::tools
