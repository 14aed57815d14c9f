#include "tests/gpu/observation/observed_scene.h"

#include <algorithm>
#include <cmath>

#include "tests/reference/observation/observation_set.h"

namespace patina::observed_scene {
namespace {

Image<glm::vec4> ramp_image(Extent2D extent) {
    Image<glm::vec4> image(extent);
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) image.at(x, y) = ramp(x, y);
    }
    return image;
}

}  // namespace

reference::ObservedVoxel unpack(const RecordContent& content) {
    const auto snorm16 = [](uint32_t bits) { return static_cast<int16_t>(bits & 0xffff) / 32767.0; };
    reference::ObservedVoxel voxel;
    const double x = snorm16(content.record.normal), y = snorm16(content.record.normal >> 16);
    const double z = 1 - std::abs(x) - std::abs(y);
    voxel.normal =
        glm::normalize(z >= 0 ? glm::dvec3(x, y, z)
                              : glm::dvec3(std::copysign(1 - std::abs(y), x), std::copysign(1 - std::abs(x), y), z));
    voxel.offset_vox = snorm16(content.record.state >> 16);
    voxel.surface_samples = static_cast<int>(content.record.state >> 11 & 31);
    voxel.label = content.record.label & 0xffff;
    voxel.confidence = static_cast<int>(content.record.label >> 16);
    for (uint32_t i = 0; i < content.count(); ++i) {
        const uint32_t word = content.directions[i], color = content.colors[i];
        reference::SeenColor seen;
        seen.direction = reference::unpack_direction(word);
        const glm::dvec3 mantissa(color & 511, color >> 9 & 511, color >> 18 & 511);
        seen.color = mantissa * std::ldexp(1.0, static_cast<int>(color >> 27) - 24);
        for (uint32_t c = 0; c < 3; ++c) seen.clipped[c] = word >> (26 + c) & 1;
        seen.samples = static_cast<int>(word >> 29) + 1;
        voxel.seen.push_back(seen);
    }
    return voxel;
}

double degrees_between(glm::dvec3 a, glm::dvec3 b) {
    return glm::degrees(2 * std::asin(std::min(glm::distance(glm::normalize(a), glm::normalize(b)) / 2, 1.0)));
}

RigFrame frame_of(const reference::DistanceField& field, const RigidTransform& pose) {
    return {kCamera,
            pose,
            reference::render_depth(field, kCamera, pose, 5),
            {kCamera, pose, ramp_image(kCamera.extent)},
            {}};
}

}  // namespace patina::observed_scene
