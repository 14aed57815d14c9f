#include "tools/viewer/viewer.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>
#include <imgui.h>

#include "tools/program/mebibytes.h"
#include "tools/viewer/light_handles.h"
#include "tools/viewer/marks.h"
#include "tools/viewer/panels.h"
#include "tools/viewer/viewer_keys.h"

namespace patina::tools {

namespace {

constexpr double kFirstDistance_m = 2;  // before the first sensor, the scene is expected
constexpr double kHandle_px = 14;       // as near as a lamp is taken hold of
constexpr float kClick_px = 4;          // a mouse that moved farther dragged
constexpr size_t kMeanOf = 30;          // frames

enum MouseButton { kLeft = 0, kMiddle = 2 };

std::optional<glm::vec4> pixel_of(const std::optional<graph::Readback>& read) {
    if (!read) return std::nullopt;
    return glm::unpackHalf4x16(read->as<uint64_t>().front());
}

/// Known where its last component says so.
std::optional<glm::vec3> known(const std::optional<glm::vec4>& value) {
    return value && value->a > 0 ? std::optional(glm::vec3(*value)) : std::nullopt;
}

Extent2D ui_extent() {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    return {std::max(1u, static_cast<uint32_t>(size.x)), std::max(1u, static_cast<uint32_t>(size.y))};
}

}  // namespace

Viewer::Viewer(vulkan::Device& device, Display& display, double share, bool panels)
    : device_(device),
      display_(display),
      panels_(panels),
      composer_(device.shared_context(), display.open(device)),
      budget_(share) {
    if (panels_) gui_.emplace(device.shared_context(), display, composer_.overlay_pass());
}

Viewer::~Viewer() = default;

double Viewer::now_s() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Viewer::settle_cost() {
    if (!cost_) return;
    const bool timed = device_.caps().timestamps;
    if (timed && cost_->has_model && !cost_->model.ms()) return;
    double cost_s = cost_->shown_s;
    if (!timed) cost_s += DrawBudget::kSlow_s;  // nobody knows; better too few pictures than too many
    if (cost_->has_model && timed) cost_s += *cost_->model.ms() / 1000;
    if (composer_.ms()) cost_s += *composer_.ms() / 1000;
    budget_.spend(cost_->began_s, cost_s);
    spent_s_ += cost_s;
    cost_.reset();
}

bool Viewer::due() {
    settle_cost();
    return display_.wants_all() || (!cost_ && budget_.due(now_s()));
}

void Viewer::resume() {
    settle_cost();
    budget_.forgive(now_s());
}

RigidTransform Viewer::pose_of(const Scenery& scenery) {
    if (scenery.sensor && !placed_) {
        const RigidTransform& first = *scenery.sensor;
        state_.camera.set_up(scenery.up.value_or(-glm::dvec3(first[1])), glm::dvec3(first[2]));
        state_.camera.look_from(first, kFirstDistance_m);
        placed_ = true;
    }
    return state_.follow && scenery.sensor ? *scenery.sensor : state_.camera.pose();
}

void Viewer::leave_sensor(const Scenery& scenery) {
    if (state_.follow && scenery.sensor) state_.camera.look_from(*scenery.sensor, state_.camera.distance_m());
    state_.follow = false;
}

void Viewer::draw(const Scenery& scenery, ViewerFacts facts) {
    const Extent2D window = display_.extent();
    if (window.area() == 0) return;
    settle_cost();
    take_pick();
    facts.reflectance = scenery.pipeline && scenery.pipeline->reflectance();
    facts.segmentation = scenery.pipeline && scenery.pipeline->segmentation();
    if (!has_layer(state_.layer, facts.reflectance, facts.segmentation)) state_.layer = Layer::kColor;
    RigidTransform pose = pose_of(scenery);
    if (gui_ && drawn_ == 0) lay_out_panels(scenery, facts);
    if (gui_) {
        gui_->begin();
        take_keys(scenery);
        take_mouse(scenery, pose);
        pose = pose_of(scenery);
        draw_marks({with_extent(scenery.camera, ui_extent()), pose}, state_,
                   state_.follow ? std::nullopt : scenery.sensor, scenery.camera, scenery.lighting.lights);
        show_panels(state_, facts, scenery.lighting, ui_extent());
        gui_->end();
    }
    const auto target = display_.begin();
    if (!target) return;
    Cost cost;
    cost.began_s = now_s();
    if (scenery.pipeline && scenery.pipeline->frames() > 0) draw_model(scenery, pose, target->extent, cost);
    const vulkan::ComposeArea whole{{0, 0}, glm::ivec2(target->extent.width, target->extent.height)};
    composer_.draw(*target, picture_.get(), whole, [this](vk::CommandBuffer commands) {
        if (gui_) gui_->record(commands);
    });
    const double composed_s = now_s();
    display_.show();
    cost.shown_s = display_.wants_all() ? 0 : now_s() - composed_s;
    cost_ = std::move(cost);
    ++drawn_;
}

/// A panel is as large as what it holds, which is known once that was shown: it is hidden until then.
void Viewer::lay_out_panels(const Scenery& scenery, const ViewerFacts& facts) {
    for (int i = 0; i < 2; ++i) {
        gui_->begin();
        show_panels(state_, facts, scenery.lighting, ui_extent());
        gui_->end();
    }
}

void Viewer::draw_model(const Scenery& scenery, const RigidTransform& pose, Extent2D window, Cost& cost) {
    const Extent2D extent = display_.wants_all() ? window : budget_.picture_extent(window);
    const Shown shown{pose, state_.layer, state_.exposure, scenery.pipeline->frames(), state_.other, extent};
    if (picture_ && shown == shown_ && !clicked_) return;
    shown_ = shown;
    if (!picture_ || picture_->desc().extent != extent) {
        composer_.wait();
        picture_ = device_.create_image({"viewer.picture", extent, vulkan::Format::kRgba8});
    }
    const gpu::DrawLayerParams params = params_of(state_.layer, glm::dvec3(pose[3]), state_.exposure);
    cost.model =
        scenery.pipeline->draw(with_extent(scenery.camera, extent), pose, state_.other ? &*state_.other : nullptr,
                               [&](graph::FrameGraph& graph, const ModelImages& model) {
                                   add_layer(graph, model, state_.layer, params, graph.import(picture_));
                                   if (clicked_) ask_for_pixel(graph, model, extent);
                               });
    cost.has_model = true;
}

void Viewer::ask_for_pixel(graph::FrameGraph& graph, const ModelImages& model, Extent2D extent) {
    const glm::dvec2 at = *clicked_ * glm::dvec2(extent.width, extent.height);
    const glm::uvec2 pixel(glm::clamp(at, glm::dvec2(0), glm::dvec2(extent.width - 1, extent.height - 1)));
    const auto read = [&](graph::ImageId image) { return graph.read_back_pixel(image, pixel); };
    pick_.emplace(Pick{read(model.position_m), read(model.normal), {}, {}, {}, {}});
    if (model.label) pick_->label = read(*model.label);
    if (model.reflectance) {
        pick_->kd = read(model.reflectance->seen.kd);
        pick_->ks_alpha = read(model.reflectance->seen.ks_alpha);
        pick_->coverage = read(model.reflectance->coverage);
    }
    clicked_.reset();
}

void Viewer::take_pick() {
    if (!pick_ || !pick_->position_m.ready()) return;
    PickedSurface at;
    const glm::vec4 position_m = pick_->position_m.as<glm::vec4>().front();
    const auto ks_alpha = pixel_of(pick_->ks_alpha), coverage = pixel_of(pick_->coverage);
    at.hit = position_m.w > 0;
    at.position_m = glm::vec3(position_m);
    at.normal = glm::vec3(*pixel_of(pick_->normal));
    if (pick_->label) at.label = pick_->label->as<uint32_t>().front();
    at.kd = known(pixel_of(pick_->kd));
    at.ks = known(ks_alpha);
    at.alpha = ks_alpha ? ks_alpha->a : 0;
    at.observations = coverage ? coverage->r : 0;
    at.certainty = coverage ? coverage->g : 0;
    state_.picked = at;
    pick_.reset();
}

void Viewer::take_keys(const Scenery& scenery) {
    for (const KeyPress& press : display_.take_keys()) {
        if (ImGui::GetIO().WantTextInput) continue;
        if (moves_camera(press)) leave_sensor(scenery);
        take_key(press, state_);
    }
}

void Viewer::take_mouse(const Scenery& scenery, const RigidTransform& pose) {
    const ImGuiIO& io = ImGui::GetIO();
    const Intrinsics camera = with_extent(scenery.camera, ui_extent());
    if (state_.held_light && ImGui::IsMouseDown(kLeft)) return hold_light(scenery, camera, pose);
    if (std::exchange(state_.held_light, std::nullopt) || io.WantCaptureMouse) return;  // to let go is no click
    const glm::dvec2 moved(io.MouseDelta.x, io.MouseDelta.y), at(io.MousePos.x, io.MousePos.y);
    if (ImGui::IsMouseDown(kMiddle) && moved != glm::dvec2(0)) {
        leave_sensor(scenery);
        if (io.KeyShift)
            state_.camera.pan(moved, camera.fy);
        else
            state_.camera.orbit(moved);
    }
    if (io.MouseWheel != 0) {
        leave_sensor(scenery);
        state_.camera.dolly(double{io.MouseWheel});
    }
    const std::vector<Light>& lights = state_.other ? state_.other->lights : scenery.lighting.lights;
    if (ImGui::IsMouseClicked(kLeft)) state_.held_light = light_at(lights, camera, pose, at, kHandle_px);
    const bool dragged = io.MouseDragMaxDistanceSqr[kLeft] > kClick_px * kClick_px;  // since it was pressed
    if (ImGui::IsMouseReleased(kLeft) && !dragged)
        clicked_ = at / glm::dvec2(camera.extent.width, camera.extent.height);
}

void Viewer::hold_light(const Scenery& scenery, const Intrinsics& camera, const RigidTransform& pose) {
    const ImGuiIO& io = ImGui::GetIO();
    const glm::dvec2 moved(io.MouseDelta.x, io.MouseDelta.y);
    if (moved == glm::dvec2(0) && io.MouseWheel == 0) return;
    OtherLights& other = own_lights(state_, scenery.lighting);
    glm::dvec3& position_m = other.lights[*state_.held_light].position_m;
    position_m = pushed(dragged(position_m, camera, pose, moved), pose, double{io.MouseWheel});
    other.shadows = false;
    if (scenery.pipeline && scenery.pipeline->reflectance()) state_.layer = Layer::kRerendering;
}

std::vector<PassMean> slowest_passes(const graph::Runner& runner) {
    std::vector<PassMean> means;
    for (const graph::Timing& timing : runner.pass_timings()) {
        const size_t count = std::min(kMeanOf, timing.samples_ms.size());
        if (count == 0) continue;
        const double sum =
            std::accumulate(timing.samples_ms.end() - static_cast<std::ptrdiff_t>(count), timing.samples_ms.end(), 0.0);
        means.push_back({timing.name, sum / static_cast<double>(count)});
    }
    std::ranges::sort(means, std::greater(), &PassMean::ms);
    return means;
}

std::pair<std::string, std::string> memory_line(uint64_t held_bytes) {
    return {"memory", fmt::format("{:.0f} MiB of the device", mebibytes(held_bytes))};
}

}  // namespace patina::tools
