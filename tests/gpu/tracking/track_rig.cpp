#include "tests/gpu/tracking/track_rig.h"

#include <cmath>

#include <glm/gtc/packing.hpp>
#include <glm/gtc/quaternion.hpp>

namespace patina {

SeenScene see(const reference::DistanceField& scene, const Paint& paint, const Intrinsics& camera,
              const RigidTransform& world_from_camera) {
    SeenScene seen{reference::render_depth(scene, camera, world_from_camera, 8),
                   Image<glm::vec4>(camera.extent, glm::vec4(0)), Image<glm::vec4>(camera.extent, glm::vec4(0)),
                   Image<glm::vec4>(camera.extent, glm::vec4(0))};
    for (uint32_t y = 0; y < camera.extent.height; ++y) {
        for (uint32_t x = 0; x < camera.extent.width; ++x) {
            const double z = seen.depth_m.at(x, y);
            if (z <= 0) continue;
            const glm::dvec4 local(z * (x - camera.cx) / camera.fx, z * (y - camera.cy) / camera.fy, z, 1);
            const glm::dvec3 world(world_from_camera * local);
            seen.position_m.at(x, y) = glm::vec4(world, z);
            seen.normal.at(x, y) = glm::vec4(reference::normal_at(scene, world), 0);
            seen.color.at(x, y) = glm::vec4(paint(world), 1);
        }
    }
    return seen;
}

std::vector<uint64_t> to_halves(const Image<glm::vec4>& image) {
    std::vector<uint64_t> halves;
    for (const glm::vec4& pixel : image.pixels()) halves.push_back(glm::packHalf4x16(pixel));
    return halves;
}

Image<glm::vec4> rounded_to_halves(const Image<glm::vec4>& image) {
    Image<glm::vec4> rounded(image.extent());
    const std::vector<uint64_t> halves = to_halves(image);
    for (size_t i = 0; i < halves.size(); ++i) rounded.pixels()[i] = glm::unpackHalf4x16(halves[i]);
    return rounded;
}

graph::ImageId TrackTest::upload_floats(graph::FrameGraph& frame, const Image<float>& image) {
    return frame.upload("floats", {image.extent(), vulkan::Format::kR32f}, std::as_bytes(std::span(image.pixels())));
}

graph::ImageId TrackTest::upload_halves(graph::FrameGraph& frame, const Image<glm::vec4>& image) {
    const std::vector<uint64_t> halves = to_halves(image);
    return frame.upload("halves", {image.extent(), vulkan::Format::kRgba16f}, std::as_bytes(std::span(halves)));
}

TrackLevel TrackTest::pack_frame(graph::FrameGraph& frame, const SeenScene& seen, const Intrinsics& camera,
                                 const std::optional<reference::TrackPicture>& picture, bool half) {
    std::optional<TrackColor> color;
    if (picture) color = {upload_halves(frame, picture->linear), picture->camera, picture->color_from_depth};
    return add_pack_frame(frame, upload_floats(frame, seen.depth_m), camera, color, 6, half);
}

TrackLevel TrackTest::pack_model(graph::FrameGraph& frame, const SeenScene& seen, const Intrinsics& camera,
                                 const RigidTransform& world_from_camera, bool colored, bool half) {
    const RaycastImages surface{frame.upload("position", {camera.extent, vulkan::Format::kRgba32f},
                                             std::as_bytes(std::span(seen.position_m.pixels()))),
                                upload_halves(frame, seen.normal)};
    std::optional<graph::ImageId> color;
    if (colored) color = upload_halves(frame, seen.color);
    const Intrinsics level = half ? halved(camera) : camera;
    const auto target = frame.create_image("model", {level.extent, vulkan::Format::kRgba32u});
    return {add_pack_model(frame, {surface, color, make_camera(camera, world_from_camera)}, target), level};
}

Image<reference::TrackReading> TrackTest::readings(const std::vector<uint32_t>& words, Extent2D extent) {
    Image<reference::TrackReading> image(extent);
    for (size_t i = 0; i < extent.area(); ++i) {
        const uint32_t shade = words[i] >> 20;
        image.pixels()[i] = {(words[i] & 0xfffff) / 65536.0, shade == 0xfff ? -1 : shade / 2047.0};
    }
    return image;
}

Image<reference::TrackSurface> TrackTest::surfaces(const std::vector<uint32_t>& words, Extent2D extent) {
    const auto part = [](uint32_t bits, double units) { return static_cast<int16_t>(bits & 0xffff) / units; };
    Image<reference::TrackSurface> image(extent);
    for (size_t i = 0; i < extent.area(); ++i) {
        const uint32_t* const word = &words[4 * i];
        const glm::dvec3 normal(part(word[1], 32767), part(word[1] >> 16, 32767), part(word[2], 32767));
        image.pixels()[i] = {glm::uintBitsToFloat(word[0]),
                             normal,
                             {part(word[3], 32767), part(word[3] >> 16, 32767)},
                             part(word[2] >> 16, 16383)};
    }
    return image;
}

gpu::TrackState state_at(const RigidTransform& model_from_frame, double center_m, double lever_m, double gain) {
    const glm::dquat q = glm::quat_cast(glm::dmat3(model_from_frame));
    gpu::TrackState state{};
    state.rotation = glm::vec4(q.x, q.y, q.z, q.w);
    state.translation_m = glm::vec4(glm::dvec3(model_from_frame[3]), 0);
    state.gain = static_cast<float>(gain);
    state.center_m = static_cast<float>(center_m);
    state.lever_m = static_cast<float>(lever_m);
    return state;
}

}  // namespace patina
