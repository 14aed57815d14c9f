#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "engine/core/printable.h"
#include "export/upright.h"
#include "reconstruction/api/access.h"
#include "reconstruction/session/stored_map.h"
#include "tools/program/free_place.h"
#include "tools/program/map_text.h"
#include "tools/program/standard_streams.h"
#include "tools/render/orbit.h"
#include "tools/viewer/make_display.h"
#include "tools/viewer/viewer.h"
#include "tools/viewer/viewer_options.h"

namespace patina::tools {

namespace {

constexpr double kIdle_s = 1.0 / 20;  // between frames in which the user does nothing

/// Throws Error where there is none, with what to do about it.
std::filesystem::path map_of(const std::filesystem::path& input) {
    if (const auto map = map_at(input); !map.empty()) return map;
    const bool folder = std::filesystem::is_directory(input);
    throw Error("'", input.string(), "' ",
                !std::filesystem::exists(input) ? "does not exist"
                : folder                        ? "has no map.sqlite; patina run keeps one unless --no-map is given"
                                                : "is no map, and no folder that has one");
}

vulkan::DeviceOptions device_options(const DeviceChoice& choice, const Display& display) {
    vulkan::DeviceOptions options = Access::options(choice);
    display.ask(options);
    return options;
}

/// One map on a display.
class MapView {
  public:
    explicit MapView(const ViewOptions& options)
        : options_(options),
          file_(map_of(options.input)),
          display_(make_display(options.viewer, "patina: " + options.input.string(), {file_})),
          device_(Access::device(device_options(options.device, *display_))),
          map_(Access::vulkan(device_), file_),
          viewer_(Access::vulkan(device_), *display_, 1, options.viewer.panels) {
        viewer_.state().layer = options.viewer.layer;
        scenery_.pipeline = &map_.pipeline();
        scenery_.camera = map_.camera();
        scenery_.lighting = map_.lighting();
        std::vector<RigidTransform> poses;
        for (const TimedPose& pose : map_.poses()) poses.push_back(pose.world_from_camera);
        if (poses.empty()) throw Error("'", file_.string(), "' holds no frame: there is nothing to look at");
        scenery_.sensor = poses.back();
        scenery_.up = mean_up(poses);
    }

    /// Until the user closes the window.
    void show() {
        while (!display_->closed()) {
            display_->poll(kIdle_s);
            draw();
            take_wishes();
        }
    }

    void orbit(uint32_t count) {
        std::vector<RigidTransform> recorded, poses{*scenery_.sensor};
        for (const TimedPose& pose : map_.poses()) recorded.push_back(pose.world_from_camera);
        if (count > 1)
            poses = orbit_poses(recorded, median_point(map_.pipeline().extract_surface().positions_m), count);
        for (const RigidTransform& pose : poses) {
            scenery_.sensor = pose;
            draw();
        }
    }

    void finish() {
        display_->finish();
        if (const auto messages = device_.validation_messages(); !messages.empty())
            throw Error("the validation layer reported ", messages.size(), " messages, the first: ", messages.front());
        if (options_.quiet) return;
        const RigidTransform pose = viewer_.state().follow ? *scenery_.sensor : viewer_.state().camera.pose();
        print_out("{} frames; layer {}, from {:.3f}, {:.3f}, {:.3f} m\n", viewer_.drawn(),
                  text_of(viewer_.state().layer).word, pose[3].x, pose[3].y, pose[3].z);
    }

  private:
    void draw() {
        viewer_.draw(scenery_, facts());
        map_.pipeline().wait();
    }

    ViewerFacts facts() {
        ViewerFacts facts;
        const PipelineCounters counted = map_.pipeline().counters();
        facts.lines = {{"map", options_.input.filename().string()},
                       {"device", device_.name()},
                       {"frames", std::to_string(counted.frames)},
                       {"segments", std::to_string(counted.segments.live)},
                       {"lamps", std::to_string(scenery_.lighting.lights.size())},
                       memory_line(Access::vulkan(device_).held_memory())};
        for (const PoolState& pool : counted.pools)
            facts.pools.push_back({pool.name, pool.used, pool.capacity, pool.refused});
        facts.passes = slowest_passes(map_.pipeline().runner());
        facts.message = message_;
        facts.can_export = facts.can_cast_shadows = true;
        return facts;
    }

    void take_wishes() {
        ViewerState& state = viewer_.state();
        if (std::exchange(state.export_asked, false)) export_now();
        if (std::exchange(state.shadows_asked, false) && state.other) {
            map_.pipeline().relight(
                {.lights = state.other->lights, .ambient = state.other->ambient, .far_field = {}, .bounces = 0});
            scenery_.lighting.lights = state.other->lights;
            scenery_.lighting.ambient = state.other->ambient;
            state.other.reset();
        }
    }

    void export_now() {
        try {
            const std::filesystem::path folder = free_place_beside(options_.input, "export");
            map_.scene().save(folder);
            message_ = fmt::format("exported to {}", folder.string());
        } catch (const Error& error) {
            message_ = fmt::format("not exported: {}", error.what());
        }
    }

    const ViewOptions& options_;
    std::filesystem::path file_;
    std::unique_ptr<Display> display_;
    Device device_;
    StoredMap map_;
    Viewer viewer_;
    Scenery scenery_;
    std::string message_;
};

}  // namespace

void view(const ViewOptions& options) {
    MapView view(options);
    if (options.viewer.offscreen.empty())
        view.show();
    else
        view.orbit(options.orbit);
    view.finish();
}

}  // namespace patina::tools
