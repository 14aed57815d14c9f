// What the scenes in assets/scenes look like.

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "scenes/files/scene_file.h"
#include "scenes/render/render.h"
#include "tests/gpu/gpu_test.h"

namespace patina::builtin_scenes_test {
namespace {

using namespace scenes;
using namespace sensor;

/// A scene's camera with another number of pixels on the same sensor.
Intrinsics resized(Intrinsics camera, Extent2D extent) {
    const glm::dvec2 scale(double(extent.width) / camera.extent.width, double(extent.height) / camera.extent.height);
    camera.extent = extent;
    camera.fx *= scale.x;
    camera.fy *= scale.y;
    camera.cx = (camera.cx + 0.5) * scale.x - 0.5;  // pixel centres lie at integers
    camera.cy = (camera.cy + 0.5) * scale.y - 0.5;
    return camera;
}

double srgb_code(float linear) {
    const double v = std::clamp(double(linear), 0.0, 1.0);
    return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
}

class BuiltinScenesOnGpu : public GpuTest, public ::testing::WithParamInterface<const char*> {
  protected:
    struct View {
        std::vector<glm::vec4> radiance;
        std::vector<uint32_t> object_id;
        std::vector<float> depth_m;
    };

    View view(const SceneModel& model, const Intrinsics& camera, const RigidTransform& world_from_camera) {
        graph::FrameGraph frame = runner().begin();
        const RenderedImages rendered = add_render(frame, model, camera, world_from_camera);
        const graph::Readback radiance = frame.read_back(rendered.radiance);
        const graph::Readback object_id = frame.read_back(rendered.object_id);
        const graph::Readback depth_m = frame.read_back(rendered.depth_m);
        run(std::move(frame));
        return {radiance.as<glm::vec4>(), object_id.as<uint32_t>(), depth_m.as<float>()};
    }
};

INSTANTIATE_TEST_SUITE_P(All, BuiltinScenesOnGpu, ::testing::Values("balls", "bunnies", "cubes", "office", "print"),
                         [](const auto& p) { return std::string(p.param); });

double period_s(const CameraPath& path) {
    const auto* tour = std::get_if<WaypointPath>(&path);
    return tour ? tour->period_s : std::get<OrbitPath>(path).azimuth_period_s;
}

TEST_P(BuiltinScenesOnGpu, AreWellExposedAndEveryObjectIsSeenOften) {
    constexpr int kFrames = 60, kOften = 10;
    const SyntheticScene scene = load_scene(GetParam());
    const SceneModel model(runner(), scene);
    const Intrinsics camera = resized(scene.camera, {128, 106});
    std::map<uint32_t, int> frames_with;
    double pixels = 0, codes = 0, clipped = 0;
    for (int i = 0; i < kFrames; ++i) {
        const View seen = view(model, camera, world_from_camera(scene.path, period_s(scene.path) * i / kFrames));
        std::map<uint32_t, int> pixels_of;
        for (size_t p = 0; p < seen.object_id.size(); ++p) {
            if (seen.object_id[p] == 0) continue;  // a lamp or nothing
            ++pixels_of[seen.object_id[p]];
            const glm::vec4 value = seen.radiance[p];
            ++pixels;
            codes += (srgb_code(value.r) + srgb_code(value.g) + srgb_code(value.b)) / 3;
            clipped += std::max({value.r, value.g, value.b}) >= 1;
        }
        for (const auto& [id, count] : pixels_of) ++frames_with[id];
    }
    EXPECT_LT(clipped / pixels, 0.01);
    EXPECT_GT(codes / pixels, 90);
    EXPECT_LT(codes / pixels, 170);
    for (const SceneObject& object : scene.objects)
        EXPECT_GE(frames_with[object.material.id], kOften) << object.material.name;
}

TEST_P(BuiltinScenesOnGpu, LightingPathSeesEveryLamp) {
    constexpr uint32_t kViews = 12;  // of the 60 frames; 10 of those are 2 of these
    const SyntheticScene scene = load_scene(GetParam());
    ASSERT_TRUE(scene.lighting);
    const SceneModel model(runner(), scene);
    const Intrinsics camera = resized(scene.camera, {256, 212});
    std::vector<uint32_t> views_with(scene.lights.size(), 0);
    for (uint32_t i = 0; i < kViews; ++i) {
        const RigidTransform pose =
            world_from_camera(scene.lighting->path, i * scene.lighting->frames / kViews / scene.fps);
        const View seen = view(model, camera, pose);
        for (size_t lamp = 0; lamp < scene.lights.size(); ++lamp) {
            const Light& light = scene.lights[lamp];
            const glm::dvec3 p(rigid_inverse(pose) * glm::dvec4(light.position_m, 1));
            const glm::dvec2 pixel(camera.fx * p.x / p.z + camera.cx, camera.fy * p.y / p.z + camera.cy);
            const glm::ivec2 at(glm::round(pixel));
            if (p.z <= 0 || !camera.extent.contains(at.x, at.y)) continue;
            const size_t index = size_t(at.y) * camera.extent.width + size_t(at.x);
            const bool is_lamp = seen.object_id[index] == 0 && std::abs(seen.depth_m[index] - p.z) < light.radius_m;
            views_with[lamp] += is_lamp && p.z < scene.max_metres && seen.radiance[index].g > 1;
        }
    }
    for (const uint32_t views : views_with) EXPECT_GE(views, 2u);
}

}  // namespace
}  // namespace patina::builtin_scenes_test
