#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include "reconstruction/pipeline.h"
#include "tools/viewer/draw_budget.h"
#include "tools/viewer/gui.h"
#include "tools/viewer/viewer_state.h"

namespace patina::tools {

/// What the viewer looks at.
struct Scenery {
    Pipeline* pipeline = nullptr;          ///< null before there is one
    Intrinsics camera;                     ///< the vertical field of view of all views is its
    std::optional<RigidTransform> sensor;  ///< where the sensor is (world_from_camera); empty before it is known
    std::optional<glm::dvec3> up;          ///< empty: that of the sensor
    Lighting lighting;                     ///< of the reconstruction
};

/// Draws a model as it grows, with a user interface over it, and moves its camera. The picture stays on the device.
class Viewer {
  public:
    /// Opens the display on the device. `share`: of the time, that drawing may take where the display does not want all
    /// frames. Without `panels`, pictures alone. Both must outlive this.
    Viewer(vulkan::Device& device, Display& display, double share, bool panels);
    ~Viewer();

    /// Whether a frame is to be drawn now; else there is no time for it.
    bool due();

    /// Fusion begins again after a pause: what was drawn meanwhile took none of its time.
    void resume();

    /// Draws a frame and shows it, after it took what the user did. Throws Error when the device was lost.
    void draw(const Scenery& scenery, ViewerFacts facts);

    ViewerState& state() { return state_; }
    Display& display() { return display_; }

    /// What drawing took so far, seconds, as far as it is known: the device's time where it measures it.
    double spent_s() const { return spent_s_; }
    uint32_t drawn() const { return drawn_; }  ///< frames

  private:
    /// A click whose answer is on its way.
    struct Pick {
        graph::Readback position_m, normal;
        std::optional<graph::Readback> label, kd, ks_alpha, coverage;
    };
    /// A frame whose time is not known yet.
    struct Cost {
        graph::FrameTime model;
        bool has_model = false;
        double began_s = 0, shown_s = 0;  ///< the clock then, and what showing it took
    };
    /// What the picture shows; another one is drawn only where that has changed.
    struct Shown {
        RigidTransform pose{1.0};
        Layer layer = Layer::kColor;
        float exposure = 0;
        uint32_t frames = 0;
        std::optional<OtherLights> other;
        Extent2D extent;
        bool operator==(const Shown&) const = default;
    };
    double now_s() const;
    void settle_cost();
    RigidTransform pose_of(const Scenery& scenery);
    void take_keys(const Scenery& scenery);
    void take_mouse(const Scenery& scenery, const RigidTransform& pose);
    void hold_light(const Scenery& scenery, const Intrinsics& camera, const RigidTransform& pose);
    void lay_out_panels(const Scenery& scenery, const ViewerFacts& facts);
    void draw_model(const Scenery& scenery, const RigidTransform& pose, Extent2D window, Cost& cost);
    void ask_for_pixel(graph::FrameGraph& graph, const ModelImages& model, Extent2D extent);
    void take_pick();
    void leave_sensor(const Scenery& scenery);

    vulkan::Device& device_;
    Display& display_;
    bool panels_;
    vulkan::Composer composer_;
    std::optional<Gui> gui_;
    DrawBudget budget_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    ViewerState state_;
    vulkan::ImageRef picture_;  ///< null before there is a model
    Shown shown_;
    std::optional<Cost> cost_;
    std::optional<glm::dvec2> clicked_;  ///< in parts of the window
    std::optional<Pick> pick_;
    bool placed_ = false;  ///< the free camera has been brought to the scene
    double spent_s_ = 0;
    uint32_t drawn_ = 0;
};

/// The slowest passes of the last frames, slowest first.
std::vector<PassMean> slowest_passes(const graph::Runner& runner);

/// What the user is shown of the memory that a device holds.
std::pair<std::string, std::string> memory_line(uint64_t held_bytes);

}  // namespace patina::tools
