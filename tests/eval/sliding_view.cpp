#include "tests/eval/sliding_view.h"

#include <glm/gtc/matrix_transform.hpp>

#include "sensor/files/picture_file.h"
#include "sensor/files/text_file.h"
#include "sensor/write_sequence.h"
#include "tests/eval/pictures.h"

namespace patina::test {

namespace fs = std::filesystem;

RigidTransform SlidingView::world_from_camera(uint32_t frame) {
    // Wall points lie 5 mm and more from the sides of their cells.
    return glm::translate(RigidTransform(1), {0.03 + kPixel_m * kStep * frame, 0.03, 0.01});
}

eval::DepthView SlidingView::view(uint32_t frame) {
    return {Image<float>(kExtent, kWall_m), camera(), world_from_camera(frame)};
}

glm::dvec3 SlidingView::point(uint32_t x, uint32_t y, uint32_t frame) {
    const glm::dvec4 in_camera((x - camera().cx) * kPixel_m, (y - camera().cy) * kPixel_m, kWall_m, 1);
    return glm::dvec3(world_from_camera(frame) * in_camera);
}

fs::path SlidingRig::frame_file(const fs::path& folder, uint32_t index) {
    return folder / "frames" / (sensor::picture_stem(index) + ".exr");
}

EvalFrame SlidingRig::frame() {
    EvalFrame frame;
    for (auto* picture :
         {&frame.kd, &frame.kd_segment, &frame.kd_shown, &frame.ks, &frame.rgb, &frame.rgb_segment, &frame.rgb_shown}) {
        *picture = Image<glm::vec3>(SlidingView::kExtent, glm::vec3(0.5f));
    }
    frame.normal = Image<glm::vec3>(SlidingView::kExtent, glm::vec3(0, 0, -1));
    for (auto* picture : {&frame.alpha, &frame.label, &frame.valid}) *picture = Image<float>(SlidingView::kExtent, 1);
    frame.depth = Image<float>(SlidingView::kExtent, SlidingView::kWall_m);
    return frame;
}

SlidingRig::SlidingRig() {
    SequenceInfo info;
    info.name = "wall";
    info.color = info.depth = SlidingView::camera();
    info.color_from_depth = glm::translate(RigidTransform(1), {-SlidingView::kPixel_m, 0, 0});
    sensor::SequenceWriter writer(sequence(), info);
    std::vector<sensor::StampedPose> poses;
    for (uint32_t i = 0; i < kFrames; ++i) {
        poses.push_back({i / info.fps, SlidingView::world_from_camera(i)});
        writer.write({i,
                      poses.back().timestamp_s,
                      Image<SrgbPixel>(SlidingView::kExtent),
                      Image<float>(SlidingView::kExtent, SlidingView::kWall_m),
                      std::nullopt,
                      0,
                      {}});
    }
    writer.finish();
    const fs::path truth = sequence() / "truth";
    for (const fs::path& folder : {truth, run()}) {
        fs::create_directories(folder / "frames");
        for (uint32_t i = 0; i < kFrames; i += kEvery) write_frame(frame_file(folder, i), frame());
    }
    sensor::write_bytes(run() / "run.json", "{}");
    sensor::write_trajectory(truth / "trajectory.txt", poses);
}

}  // namespace patina::test
