#include "tools/eval/seen_pixels.h"

#include <type_traits>
#include <variant>

#include "engine/core/error.h"
#include "sensor/open.h"
#include "sensor/prefetch.h"

namespace patina::eval {
namespace {

namespace fs = std::filesystem;

/// Readings in metres; 0 where there is none, or it is too far to be used.
Image<float> readings_m(const DepthImage& depth, const SequenceInfo& info) {
    return std::visit(
        [&]<class Pixel>(const Image<Pixel>& raw) {
            const double metres = std::is_same_v<Pixel, float> ? 1 : info.metres_per_unit;
            Image<float> result(raw.extent());
            for (size_t i = 0; i < raw.pixels().size(); ++i) {
                const double reading = raw.pixels()[i] * metres;
                result.pixels()[i] = reading > 0 && reading <= info.max_metres ? static_cast<float>(reading) : 0.0f;
            }
            return result;
        },
        depth);
}

}  // namespace

SeenPixels::SeenPixels(const fs::path& sequence, const std::map<uint32_t, fs::path>& truth_frames,
                       uint32_t least_frames)
    : trajectory_file_((sequence / "truth" / "trajectory.txt").string()),
      poses_(sensor::read_trajectory(trajectory_file_)),
      surface_(least_frames) {
    sensor::PrefetchSource source(sensor::open_sequence(sequence));
    const SequenceInfo& info = source.info();
    color_ = info.color;
    depth_from_color_ = rigid_inverse(info.color_from_depth);
    const uint32_t last = truth_frames.rbegin()->first;
    if (last >= poses_.size()) {
        throw Error(trajectory_file_, " has ", poses_.size(), " poses, but truth/frames has a frame ", last);
    }
    for (const auto& [frame, file] : truth_frames) {
        visit_surface(frame, ExrPlanes::read(file, {"depth", "valid"}),
                      [&](size_t, glm::dvec3 point_m) { surface_.add(point_m); });
    }
    while (const auto reading = source.next()) {
        const auto* frame = std::get_if<Frame>(&*reading);
        if (!frame) continue;
        if (frame->index > last) break;
        surface_.count(frame->index,
                       {readings_m(frame->depth, info), info.depth, poses_[frame->index].world_from_camera});
    }
}

template <class Visit>
void SeenPixels::visit_surface(uint32_t frame, const ExrPlanes& truth, Visit visit) const {
    if (truth.extent() != color_.extent) {
        throw Error(truth.file(), " is ", truth.extent(), " pixels, but the sequence's colour is ", color_.extent);
    }
    const std::vector<float>&depth_m = truth.plane("depth"), &valid = truth.plane("valid");
    const RigidTransform world_from_color = poses_[frame].world_from_camera * depth_from_color_;
    for (size_t i = 0; i < depth_m.size(); ++i) {
        if (!(valid[i] > 0.5f && depth_m[i] > 0)) continue;
        const auto x = static_cast<double>(i % color_.extent.width), y = static_cast<double>(i / color_.extent.width);
        const double z = depth_m[i];
        const glm::dvec4 point((x - color_.cx) / color_.fx * z, (y - color_.cy) / color_.fy * z, z, 1);
        visit(i, glm::dvec3(world_from_color * point));
    }
}

Image<uint8_t> SeenPixels::mask(uint32_t frame, const ExrPlanes& truth) const {
    Image<uint8_t> mask(truth.extent());
    visit_surface(frame, truth, [&](size_t pixel, glm::dvec3 point_m) {
        mask.pixels()[pixel] = surface_.is_seen(point_m, frame) ? 1 : 0;
    });
    return mask;
}

}  // namespace patina::eval
