#include "sensor/synthetic/synthetic_source.h"

#include <algorithm>
#include <utility>

#include "sensor/synthetic/encode.h"

namespace patina::sensor {
namespace {

SequenceInfo info_of(const Scene& scene, uint32_t frames) {
    SequenceInfo info;
    info.name = scene.name;
    info.format = "synthetic";
    info.fps = scene.fps;
    info.frames = frames;
    info.color = info.depth = scene.camera;
    info.metres_per_unit = scene.metres_per_unit;
    info.max_metres = scene.max_metres;
    info.has_poses = true;
    return info;
}

/// One field of every pixel that add_encode_frame packed.
template <class Pixel, class Unpack>
Image<Pixel> unpacked(const Image<glm::uvec2>& encoded, Unpack unpack) {
    Image<Pixel> image(encoded.extent());
    std::transform(encoded.pixels().begin(), encoded.pixels().end(), image.pixels().begin(), unpack);
    return image;
}

}  // namespace

SyntheticSource::SyntheticSource(vulkan::Device& device, Scene scene, uint32_t frames)
    : runner_(device), scene_(std::move(scene)), model_(runner_, scene_), info_(info_of(scene_, frames)) {}

Image<glm::uvec2> SyntheticSource::render(const RigidTransform& world_from_camera) {
    graph::Frame frame = runner_.begin();
    const RenderedImages rendered =
        add_render(frame, model_, scene_.camera, world_from_camera, scene_.recording.render, next_index_ - 1);
    const graph::Readback encoded = frame.read_back(add_encode_frame(frame, rendered, scene_.metres_per_unit));
    runner_.submit(std::move(frame));
    runner_.wait();
    return {scene_.camera.extent, encoded.as<glm::uvec2>()};
}

std::optional<Reading> SyntheticSource::next() {
    if (next_index_ == info_.frames) return std::nullopt;
    Frame frame;
    frame.index = next_index_++;
    frame.timestamp_s = frame.index / scene_.fps;
    frame.world_from_camera = world_from_camera(scene_.path, frame.timestamp_s);
    const Image<glm::uvec2> encoded = render(*frame.world_from_camera);
    frame.color = unpacked<SrgbPixel>(encoded, [](glm::uvec2 p) { return SrgbPixel(p.x, p.x >> 8, p.x >> 16); });
    frame.depth = unpacked<uint16_t>(encoded, [](glm::uvec2 p) { return static_cast<uint16_t>(p.y); });
    labels_ = unpacked<uint16_t>(encoded, [](glm::uvec2 p) { return static_cast<uint16_t>(p.y >> 16); });
    return frame;
}

}  // namespace patina::sensor
