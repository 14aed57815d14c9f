#include "tools/viewer/viewer_keys.h"

#include <algorithm>
#include <array>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace patina::tools {

namespace {

constexpr double kTurn_px = 15 / 0.4;  // as many degrees: FreeCamera::orbit

constexpr std::array kCameraKeys{GLFW_KEY_KP_1,   GLFW_KEY_KP_2,        GLFW_KEY_KP_3,       GLFW_KEY_KP_4,
                                 GLFW_KEY_KP_6,   GLFW_KEY_KP_7,        GLFW_KEY_KP_8,       GLFW_KEY_KP_9,
                                 GLFW_KEY_KP_ADD, GLFW_KEY_KP_SUBTRACT, GLFW_KEY_KP_DECIMAL, GLFW_KEY_F};

void move_camera(const KeyPress& press, ViewerState& state) {
    FreeCamera& camera = state.camera;
    switch (press.key) {
        case GLFW_KEY_KP_1: return camera.look_along(press.control ? AxisView::kBack : AxisView::kFront);
        case GLFW_KEY_KP_3: return camera.look_along(press.control ? AxisView::kLeft : AxisView::kRight);
        case GLFW_KEY_KP_7: return camera.look_along(press.control ? AxisView::kBottom : AxisView::kTop);
        case GLFW_KEY_KP_9: return camera.opposite();
        case GLFW_KEY_KP_4: return camera.orbit({kTurn_px, 0});
        case GLFW_KEY_KP_6: return camera.orbit({-kTurn_px, 0});
        case GLFW_KEY_KP_8: return camera.orbit({0, kTurn_px});
        case GLFW_KEY_KP_2: return camera.orbit({0, -kTurn_px});
        case GLFW_KEY_KP_ADD: return camera.dolly(1);
        case GLFW_KEY_KP_SUBTRACT: return camera.dolly(-1);
        default:
            if (state.picked && state.picked->hit) camera.set_pivot(glm::dvec3(state.picked->position_m));
    }
}

}  // namespace

bool moves_camera(const KeyPress& press) { return std::ranges::find(kCameraKeys, press.key) != kCameraKeys.end(); }

void take_key(const KeyPress& press, ViewerState& state) {
    if (moves_camera(press)) return move_camera(press, state);
    if (press.key >= GLFW_KEY_1 && press.key <= GLFW_KEY_9) {
        state.layer = kLayers[static_cast<size_t>(press.key - GLFW_KEY_1)].layer;
        return;
    }
    switch (press.key) {
        case GLFW_KEY_KP_0:
        case GLFW_KEY_0: state.follow = !state.follow; break;
        case GLFW_KEY_SPACE: state.paused = !state.paused; break;
        case GLFW_KEY_R: state.record_asked = true; break;
        case GLFW_KEY_Z: state.undo_asked = state.undo_asked || press.control; break;
        case GLFW_KEY_E: state.export_asked = true; break;
        case GLFW_KEY_H: state.help = !state.help; break;
        default: break;
    }
}

}  // namespace patina::tools
