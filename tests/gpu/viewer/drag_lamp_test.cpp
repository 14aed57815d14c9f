// A lamp that is dragged with the mouse: how many frames pass until the picture shows it.

#include <cmath>
#include <vector>

#include <glm/gtc/type_precision.hpp>
#include <gmock/gmock.h>
#include <imgui.h>

#include "engine/graph/runner.h"
#include "patina/session.h"
#include "reconstruction/api/access.h"
#include "reconstruction/session/session_core.h"
#include "tests/gpu/scenes/wall_frame.h"
#include "tools/viewer/display.h"
#include "tools/viewer/viewer.h"

namespace patina::tools::drag_lamp_test {
namespace {

using Picture = std::vector<glm::u8vec4>;

constexpr Extent2D kWindow{800, 400};
constexpr glm::ivec2 kLeftTop{250, 20}, kRightBottom{450, 340};  // between the panels
constexpr int kMark_px = 40;                                     // a handle, its number
constexpr int kNoise = 2;                                        // of 255

/// A window that nobody sees, with a mouse.
class MouseDisplay : public Display {
  public:
    void move(glm::vec2 to) { mouse_ = to; }
    void press(bool down) { down_ = down; }
    const Picture& shown() const { return shown_; }

    void ask(vulkan::DeviceOptions& options) const override { options.graphics = true; }
    vk::Format open(vulkan::Device& device) override {
        device_ = &device;
        image_ = device.create_image({"target", kWindow, vulkan::Format::kRgba8, true});
        return vulkan::vk_format(vulkan::Format::kRgba8);
    }
    Extent2D extent() const override { return kWindow; }
    void poll(double) override {}
    bool closed() const override { return false; }
    std::vector<KeyPress> take_keys() override { return {}; }
    void attach_ui() override {}
    void begin_ui() override {
        ImGuiIO& io = ImGui::GetIO();
        io.DisplaySize = {float{kWindow.width}, float{kWindow.height}};
        io.DeltaTime = 1.0f / 30;
        io.MousePos = {mouse_.x, mouse_.y};
        io.MouseDown[0] = down_;
    }
    void detach_ui() override {}
    std::optional<vulkan::ComposeTarget> begin() override {
        const vulkan::ImageObject& object = image_->object();
        return vulkan::ComposeTarget{*object.image, *object.view, kWindow, {}, {}};
    }
    void show() override {
        graph::Runner runner(*device_);
        graph::FrameGraph graph = runner.begin();
        const graph::Readback read = graph.read_back(graph.import(image_));
        runner.submit(std::move(graph));
        runner.wait();
        shown_ = read.as<glm::u8vec4>();
    }
    void finish() override {}
    bool wants_all() const override { return true; }

  private:
    vulkan::Device* device_ = nullptr;
    vulkan::ImageRef image_;
    glm::vec2 mouse_{0};
    bool down_ = false;
    Picture shown_;
};

/// Of the pixels between the panels, away from the lamp's handle, those that are not the same in both pictures.
double changed_share(const Picture& a, const Picture& b, const std::vector<glm::vec2>& handles) {
    int changed = 0, count = 0;
    for (int y = kLeftTop.y; y < kRightBottom.y; ++y)
        for (int x = kLeftTop.x; x < kRightBottom.x; ++x) {
            bool marked = false;
            for (const glm::vec2 at : handles) marked = marked || glm::distance(at, glm::vec2(x, y)) < kMark_px;
            if (marked) continue;
            const size_t i = static_cast<size_t>(y) * kWindow.width + static_cast<size_t>(x);
            const glm::ivec3 off = glm::abs(glm::ivec3(a[i]) - glm::ivec3(b[i]));
            changed += off.x > kNoise || off.y > kNoise || off.z > kNoise;
            ++count;
        }
    return static_cast<double>(changed) / count;
}

/// A grey wall 1 m before a camera that rests.
class Wall : public Source {
  public:
    Wall() {
        info_.depth = info_.color = {{64, 48}, 50, 50, 31.5, 23.5, {}};
        info_.has_poses = info_.exposure_known = true;
        info_.frames = kFrames;
    }
    const SequenceInfo& info() const override { return info_; }
    std::optional<Reading> next() override {
        if (next_ == kFrames) return std::nullopt;
        const uint32_t index = next_++;
        Frame frame = wall_frame(info_, index, SrgbPixel(128));
        std::get<Image<SrgbPixel>>(frame.color).at(0, 0).r = static_cast<uint8_t>(index);
        return frame;
    }

  private:
    static constexpr uint32_t kFrames = 2;
    SequenceInfo info_;
    uint32_t next_ = 0;
};

vulkan::DeviceOptions device_options(const Display& display) {
    vulkan::DeviceOptions options = Access::options({.validation = true});
    display.ask(options);
    return options;
}

TEST(DragLamp, EachMoveIsInThePictureTwoFramesLaterAtMost) {
    MouseDisplay display;
    Device device = Access::device(device_options(display));
    SessionOptions options;
    options.materials = Materials::kFit;
    options.settings.set("map.voxel_m", "0.02");
    options.settings.set("fusion.truncation_m", "0.06");
    const RigidTransform pose(1.0);
    options.lighting = Lighting{.lights = {{{0, 0, 0.6}, glm::dvec3(1)}}};
    Session session(device, std::make_unique<Wall>(), options);
    while (session.step()) EXPECT_TRUE(session.last()->fused) << session.last()->reason;
    SessionCore& core = Access::core(session);
    {
        Viewer viewer(Access::vulkan(device), display, 1, true);
        viewer.state().layer = Layer::kRerendering;
        const Scenery scenery{&core.pipeline(), core.info().depth, pose, std::nullopt, core.lighting()};
        const auto drawn = [&] {
            viewer.draw(scenery, {});
            core.pipeline().wait();
            return display.shown();
        };
        // The lamp is on the camera's axis.
        const Intrinsics camera = with_extent(core.info().depth, kWindow);
        std::vector<glm::vec2> at{{camera.cx, camera.cy}};
        display.move(at.back());
        drawn();
        display.press(true);
        drawn();
        ASSERT_TRUE(viewer.state().held_light);
        Picture before = drawn();
        EXPECT_EQ(changed_share(before, drawn(), at), 0) << "a lamp that rests";
        for (const glm::vec2 moved : {glm::vec2(50, 0), {0, 60}, {-70, -30}}) {
            at.push_back(at.back() + moved);
            display.move(at.back());
            uint32_t frames = 0;
            Picture after;
            do {
                after = drawn();
                ++frames;
            } while (changed_share(before, after, at) < 0.3 && frames < 5);
            EXPECT_LE(frames, 2u) << "to " << at.back().x << ", " << at.back().y;
            before = drawn();
            EXPECT_EQ(changed_share(before, after, at), 0) << "all of the answer came at once";
        }
        display.press(false);
        for (int i = 0; i < 4; ++i) drawn();
        EXPECT_FALSE(viewer.state().held_light);
        EXPECT_FALSE(viewer.state().picked) << "a lamp that is let go of is no click";
    }
    EXPECT_THAT(device.validation_messages(), ::testing::IsEmpty());
}

}  // namespace
}  // namespace patina::tools::drag_lamp_test
