#include "tools/viewer/marks.h"

#include <array>

#include <fmt/format.h>
#include <imgui.h>

#include "tools/viewer/light_handles.h"

namespace patina::tools {

namespace {

constexpr double kFrustum_m = 0.25;  // how long the sensor's is drawn
constexpr ImU32 kLamp = IM_COL32(255, 214, 90, 255), kHeld = IM_COL32(255, 140, 40, 255),
                kDark = IM_COL32(0, 0, 0, 160), kSensor = IM_COL32(120, 200, 255, 220),
                kPicked = IM_COL32(255, 255, 255, 230);

ImVec2 pixel(glm::dvec2 at) { return {static_cast<float>(at.x) + 0.5f, static_cast<float>(at.y) + 0.5f}; }

void draw_line(const ViewedFrom& from, glm::dvec3 a_m, glm::dvec3 b_m) {
    const auto a = appears_at(from.camera, from.pose, a_m), b = appears_at(from.camera, from.pose, b_m);
    if (a && b) ImGui::GetBackgroundDrawList()->AddLine(pixel(*a), pixel(*b), kSensor, 1.5f);
}

void draw_frustum(const ViewedFrom& from, const Intrinsics& field_of, const RigidTransform& sensor) {
    std::array<glm::dvec3, 4> corners;
    for (size_t i = 0; i < 4; ++i) {
        const double x = i == 1 || i == 2 ? field_of.extent.width : 0, y = i >= 2 ? field_of.extent.height : 0;
        const glm::dvec3 ray((x - field_of.cx) / field_of.fx, (y - field_of.cy) / field_of.fy, 1);
        corners[i] = glm::dvec3(sensor * glm::dvec4(kFrustum_m * ray, 1));
    }
    for (size_t i = 0; i < 4; ++i) {
        draw_line(from, glm::dvec3(sensor[3]), corners[i]);
        draw_line(from, corners[i], corners[(i + 1) % 4]);
    }
}

}  // namespace

void draw_marks(const ViewedFrom& from, const ViewerState& state, const std::optional<RigidTransform>& sensor,
                const Intrinsics& field_of, std::span<const Light> lights) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    if (sensor) draw_frustum(from, field_of, *sensor);
    const std::span<const Light> shown = state.other ? std::span<const Light>(state.other->lights) : lights;
    for (size_t i = 0; i < shown.size(); ++i) {
        const auto at = appears_at(from.camera, from.pose, shown[i].position_m);
        if (!at) continue;
        const ImVec2 center = pixel(*at);
        list.AddCircleFilled(center, 8, kDark);
        list.AddCircleFilled(center, 6, state.held_light == i ? kHeld : kLamp);
        list.AddText({center.x + 11, center.y - 7}, kLamp, fmt::format("{}", i + 1).c_str());
    }
    if (!state.picked || !state.picked->hit) return;
    if (const auto at = appears_at(from.camera, from.pose, glm::dvec3(state.picked->position_m)))
        list.AddCircle(pixel(*at), 5, kPicked, 0, 2);
}

}  // namespace patina::tools
