#include "tests/reference/segmentation/labels.h"

#include <algorithm>
#include <cmath>

namespace patina::reference {

VoxelLabel LabelVolume::at(glm::dvec3 point_m) const {
    BlockCoordinates block{};
    size_t index = 0;
    for (size_t i = 3; i-- > 0;) {
        const int voxel = static_cast<int>(std::floor(point_m[static_cast<int>(i)] / voxel_m));
        block[i] = static_cast<int>(std::floor(voxel / 8.0));
        index = index * 8 + static_cast<size_t>(voxel - 8 * block[i]);
    }
    const auto found = blocks.find(block);
    return found == blocks.end() ? VoxelLabel{} : found->second[index];
}

uint32_t sampled_label(const LabelVolume& volume, const std::vector<uint32_t>& roots, glm::dvec3 point_m,
                       glm::dvec3 normal) {
    for (const double along_vox : {0.0, -0.75, 0.75}) {
        const uint32_t label = roots.at(volume.at(point_m + normal * along_vox * volume.voxel_m).label);
        if (label != 0) return label;
    }
    return 0;
}

VoxelLabel relabelled(VoxelLabel known, const std::vector<uint32_t>& roots) {
    const uint32_t root = roots.at(known.label);
    return root == 0 ? VoxelLabel{} : VoxelLabel{root, known.confidence};
}

uint32_t pixel_label(uint32_t map_label, uint32_t segment, const std::vector<uint32_t>& roots,
                     const std::vector<uint32_t>& segment_labels) {
    const uint32_t known = roots.at(map_label);
    return known == 0 ? segment_labels.at(segment) : known;
}

namespace {

/// What the pixel that was looked at, counted in strides, says of a point.
uint32_t label_of_pixel(const LabelledView& view, glm::ivec2 looked_at, glm::dvec3 center_m, double near_m) {
    constexpr double kLeastCosine = 0.1;
    const glm::dvec3 camera_m(view.world_from_camera[3]);
    const glm::ivec2 pixel = looked_at * view.stride;
    if (!view.camera.extent.contains(pixel.x, pixel.y)) return 0;
    const auto x = static_cast<uint32_t>(pixel.x), y = static_cast<uint32_t>(pixel.y);
    const glm::dvec3 point_m(view.position_m.at(x, y)), normal(view.normal.at(x, y));
    if (glm::dot(normal, glm::normalize(camera_m - center_m)) < kLeastCosine) return 0;
    if (std::abs(glm::dot(normal, center_m - point_m)) > near_m) return 0;
    const glm::uvec2 place(looked_at);
    return view.segment_labels.at(view.segment.at(place.x, place.y));
}

}  // namespace

uint32_t seen_label(const LabelledView& view, glm::dvec3 center_m, const VoxelLabel& known) {
    const double near_m = view.voxel_m * (known.label == 0 ? 2 : 1);
    const glm::dvec3 at(rigid_inverse(view.world_from_camera) * glm::dvec4(center_m, 1));
    if (at.z <= 0) return 0;
    const glm::dvec2 place = project(view.camera, at) / double(view.stride);
    const glm::ivec2 nearest(glm::floor(place + 0.5));
    if (view.stride == 1) return label_of_pixel(view, nearest, center_m, near_m);
    const glm::ivec2 low(glm::floor(place));
    const int x = nearest.x == low.x ? low.x + 1 : low.x, y = nearest.y == low.y ? low.y + 1 : low.y;
    for (const glm::ivec2 pixel : {nearest, glm::ivec2(x, nearest.y), glm::ivec2(nearest.x, y), glm::ivec2(x, y)}) {
        if (const uint32_t label = label_of_pixel(view, pixel, center_m, near_m)) return label;
    }
    return 0;
}

VoxelLabel voted(VoxelLabel known, uint32_t label) {
    if (known.label == label) return {label, std::min(known.confidence + 1, 255u)};
    return known.confidence > 1 ? VoxelLabel{known.label, known.confidence - 1} : VoxelLabel{label, 1};
}

}  // namespace patina::reference
