#include "scenes/render/synthetic_source.h"

#include <algorithm>
#include <utility>

#include "scenes/description/pose_noise.h"
#include "scenes/render/encode.h"

namespace patina::scenes {
namespace {

SequenceInfo info_of(const SyntheticScene& scene, uint32_t frames) {
    SequenceInfo info;
    info.name = scene.name;
    info.format = "synthetic";
    info.fps = scene.fps;
    info.frames = frames;
    info.color = info.depth = scene.camera;
    if (scene.color_camera) {
        info.color = scene.color_camera->camera;
        info.color_from_depth = scene.color_camera->color_from_depth;
    }
    info.metres_per_unit = scene.metres_per_unit;
    info.max_metres = scene.max_metres;
    info.has_poses = info.exposure_known = true;
    info.motion_blur = false;
    info.indirect_light = scene.recording.render.bounces > 0;
    return info;
}

/// A picture made of what was read back: an element per pixel, and padding.
template <class Pixel, class Element, class Unpack>
Image<Pixel> unpacked(const graph::Readback& readback, Extent2D extent, Unpack unpack) {
    const std::vector<Element> elements = readback.as<Element>();
    Image<Pixel> image(extent);
    std::transform(elements.begin(), elements.begin() + static_cast<std::ptrdiff_t>(extent.area()),
                   image.pixels().begin(), unpack);
    return image;
}

}  // namespace

SyntheticSource::SyntheticSource(vulkan::Device& device, SyntheticScene scene, const SyntheticOptions& options)
    : runner_(device),
      scene_(std::move(scene)),
      options_(options),
      model_(runner_, scene_),
      info_(info_of(scene_, options.frames)) {}

void SyntheticSource::submit_next() {
    const uint32_t index = next_index_++;
    const Recording& recording = scene_.recording;
    const NoiseKey key{recording.seed, index};
    Pending pending;
    pending.frame.index = index;
    pending.frame.timestamp_s = index / scene_.fps;
    pending.frame.exposure.exposure_s *= options_.exposure;
    pending.true_pose = world_from_camera(scene_.path, pending.frame.timestamp_s);
    pending.frame.world_from_camera = with_pose_noise(pending.true_pose, recording.noise, key);

    graph::FrameGraph frame = runner_.begin();
    const auto seen_by = [&](const Intrinsics& camera, const RigidTransform& pose) {
        return add_render(frame, model_, camera, pose, recording.render, index);
    };
    const RenderedImages by_depth = seen_by(info_.depth, pending.true_pose);
    const RenderedImages by_color =
        scene_.color_camera ? seen_by(info_.color, pending.true_pose * rigid_inverse(info_.color_from_depth))
                            : by_depth;
    pending.depth_and_ids =
        frame.read_back(add_encode_depth(frame, by_depth, info_.metres_per_unit, recording.noise, key));
    const graph::ImageId linear = add_expose_color(frame, by_color.radiance, options_.exposure, recording.noise, key);
    pending.color = recording.exr ? frame.read_back(linear) : frame.read_back(add_encode_color(frame, linear));
    if (options_.truth_every > 0 && index % options_.truth_every == 0) {
        pending.seen = PendingSeen{frame.read_back(by_color.radiance),  frame.read_back(by_color.depth_m),
                                   frame.read_back(by_color.object_id), frame.read_back(by_color.normal),
                                   frame.read_back(by_color.kd),        frame.read_back(by_color.ks_alpha)};
    }
    runner_.submit(std::move(frame));
    pending_.push_back(std::move(pending));
}

Frame SyntheticSource::finished(Pending pending) {
    truth_.world_from_camera = pending.true_pose;
    truth_.labels = unpacked<uint16_t, uint32_t>(pending.depth_and_ids, info_.depth.extent,
                                                 [](uint32_t p) { return static_cast<uint16_t>(p >> 16); });
    truth_.seen.reset();
    if (const auto& seen = pending.seen) {
        truth_.seen = {seen->radiance.image<glm::vec4>(), seen->depth_m.image<float>(),
                       seen->object_id.image<uint32_t>(), seen->normal.image<glm::vec4>(),
                       seen->kd.image<glm::vec4>(),       seen->ks_alpha.image<glm::vec4>()};
    }
    pending.frame.depth = unpacked<uint16_t, uint32_t>(pending.depth_and_ids, info_.depth.extent,
                                                       [](uint32_t p) { return static_cast<uint16_t>(p); });
    if (scene_.recording.exr) {
        pending.frame.color = unpacked<glm::vec3, glm::vec4>(pending.color, info_.color.extent,
                                                             [](const glm::vec4& p) { return glm::vec3(p); });
    } else {
        pending.frame.color = unpacked<SrgbPixel, uint32_t>(pending.color, info_.color.extent,
                                                            [](uint32_t p) { return SrgbPixel(p, p >> 8, p >> 16); });
    }
    return std::move(pending.frame);
}

std::optional<Reading> SyntheticSource::next() {
    // The runner keeps two frames in flight: beginning the third from here brings this one's results home.
    while (next_index_ < info_.frames && pending_.size() < 3) submit_next();
    if (pending_.empty()) return std::nullopt;
    if (!pending_.front().depth_and_ids.ready()) runner_.wait();
    Pending oldest = std::move(pending_.front());
    pending_.pop_front();
    return finished(std::move(oldest));
}

}  // namespace patina::scenes
