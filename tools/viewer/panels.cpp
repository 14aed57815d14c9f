#include "tools/viewer/panels.h"

#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>

namespace patina::tools {

namespace {

constexpr float kMargin = 10, kLeftWidth = 230, kRightWidth = 330;
constexpr size_t kShownPasses = 12;

void place(ImVec2 at, float width) {
    ImGui::SetNextWindowPos(at, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize({width, 0}, ImGuiCond_FirstUseEver);
}

void say(const std::string& text) { ImGui::TextUnformatted(text.c_str(), text.c_str() + text.size()); }

void show_scale(Layer layer) {
    const auto scale = scale_of(layer);
    if (!scale) return;
    constexpr int kSteps = 32;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, height = ImGui::GetTextLineHeight();
    for (int i = 0; i < kSteps; ++i) {
        const glm::vec3 color = scale_color((static_cast<float>(i) + 0.5f) / kSteps);
        ImGui::GetWindowDrawList()->AddRectFilled({at.x + width * static_cast<float>(i) / kSteps, at.y},
                                                  {at.x + width * static_cast<float>(i + 1) / kSteps, at.y + height},
                                                  ImGui::ColorConvertFloat4ToU32({color.r, color.g, color.b, 1}));
    }
    ImGui::Dummy({width, height});
    const std::string low = fmt::format("{:g}", scale->x), high = fmt::format("{:g}", scale->y);
    say(low);
    ImGui::SameLine(width - ImGui::CalcTextSize(high.c_str()).x + ImGui::GetStyle().WindowPadding.x);
    say(high);
}

void show_layers(ViewerState& state, const ViewerFacts& facts) {
    place({kMargin, kMargin}, kLeftWidth);
    ImGui::Begin("View");
    for (const LayerText& text : kLayers) {
        ImGui::BeginDisabled(!has_layer(text.layer, facts.reflectance, facts.segmentation));
        const std::string title = fmt::format("{}  {}", static_cast<int>(text.layer) + 1, text.title);
        if (ImGui::RadioButton(title.c_str(), state.layer == text.layer)) state.layer = text.layer;
        ImGui::EndDisabled();
    }
    ImGui::Separator();
    ImGui::TextWrapped("%.*s", static_cast<int>(text_of(state.layer).help.size()), text_of(state.layer).help.data());
    show_scale(state.layer);
    ImGui::Separator();
    ImGui::Checkbox("Follow the sensor (0)", &state.follow);
    ImGui::SliderFloat("exposure", &state.exposure, 0.1f, 10, "%.2f", ImGuiSliderFlags_Logarithmic);
    if (ImGui::Button("Help (H)")) state.help = !state.help;
    ImGui::End();
}

void show_table(const std::vector<std::pair<std::string, std::string>>& lines, const char* name) {
    if (lines.empty() || !ImGui::BeginTable(name, 2)) return;
    ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthStretch, 0.4f);
    ImGui::TableSetupColumn("how", ImGuiTableColumnFlags_WidthStretch, 0.6f);
    for (const auto& [what, how] : lines) {
        ImGui::TableNextColumn();
        ImGui::TextDisabled("%s", what.c_str());
        ImGui::TableNextColumn();
        say(how);
    }
    ImGui::EndTable();
}

void show_pools(const std::vector<PoolUse>& pools) {
    for (const PoolUse& pool : pools) {
        const float share = static_cast<float>(pool.used) / static_cast<float>(std::max<uint64_t>(pool.capacity, 1));
        const std::string text = fmt::format("{} of {} {}", pool.used, pool.capacity, pool.name);
        ImGui::ProgressBar(share, {-1, 0}, text.c_str());
        if (pool.refused > 0)
            ImGui::TextColored({1, 0.5f, 0.3f, 1}, "full: %llu refused", static_cast<unsigned long long>(pool.refused));
    }
}

void show_statistics(const ViewerFacts& facts, float window_width) {
    place({window_width - kRightWidth - kMargin, kMargin}, kRightWidth);
    ImGui::Begin("Reconstruction");
    show_table(facts.lines, "facts");
    if (ImGui::CollapsingHeader("Memory", ImGuiTreeNodeFlags_DefaultOpen)) show_pools(facts.pools);
    if (!facts.passes.empty() && ImGui::CollapsingHeader("Slowest passes")) {
        std::vector<std::pair<std::string, std::string>> lines;
        for (size_t i = 0; i < std::min(kShownPasses, facts.passes.size()); ++i)
            lines.emplace_back(fmt::format("{:.2f} ms", facts.passes[i].ms), facts.passes[i].name);
        show_table(lines, "passes");
    }
    ImGui::End();
}

void show_lights(ViewerState& state, const ViewerFacts& facts, const Lighting& lighting) {
    if (!facts.reflectance || lighting.empty()) return;
    place({kMargin, 420}, kLeftWidth);
    ImGui::Begin("Lamps");
    const std::vector<Light>& shown = state.other ? state.other->lights : lighting.lights;
    for (size_t i = 0; i < shown.size(); ++i) {
        const glm::dvec3 power = lighting.lights[i].intensity, now = shown[i].intensity;
        float factor = static_cast<float>(power.g > 0 ? now.g / power.g : 1);
        const std::string name = fmt::format("lamp {}", i + 1);
        if (!ImGui::SliderFloat(name.c_str(), &factor, 0, 4, "x %.2f")) continue;
        own_lights(state, lighting).lights[i].intensity = power * double{factor};
        state.layer = Layer::kRerendering;
    }
    float ambient = static_cast<float>((state.other ? state.other->ambient : lighting.ambient).g);
    if (ImGui::SliderFloat("ambient", &ambient, 0, 1)) {
        own_lights(state, lighting).ambient = glm::dvec3(double{ambient});
        state.layer = Layer::kRerendering;
    }
    ImGui::BeginDisabled(!state.other);
    if (ImGui::Button("Reset")) state.other.reset();
    if (facts.can_cast_shadows) {
        ImGui::SameLine();
        if (ImGui::Button("Cast shadows")) state.shadows_asked = true;
    }
    ImGui::EndDisabled();
    ImGui::End();
}

void show_picked(const ViewerState& state, Extent2D window) {
    if (!state.picked || !state.picked->hit) return;
    const PickedSurface& at = *state.picked;
    place({static_cast<float>(window.width) - kRightWidth - kMargin, static_cast<float>(window.height) - 200},
          kRightWidth);
    ImGui::Begin("Surface");
    const auto triple = [](glm::vec3 v) { return fmt::format("{:.3f}  {:.3f}  {:.3f}", v.x, v.y, v.z); };
    std::vector<std::pair<std::string, std::string>> lines{
        {"segment", at.label > 0 ? std::to_string(at.label) : "none"},
        {"position", triple(at.position_m) + " m"},
        {"normal", triple(at.normal)}};
    lines.emplace_back("kd", at.kd ? triple(*at.kd) : "not known");
    lines.emplace_back("ks", at.ks ? triple(*at.ks) : "not known");
    if (at.ks) lines.emplace_back("alpha", fmt::format("{:.3f}", at.alpha));
    lines.emplace_back("observations", fmt::format("{:.1f}", at.observations));
    lines.emplace_back("certainty", fmt::format("{:.2f}", at.certainty));
    show_table(lines, "surface");
    ImGui::End();
}

/// Whether it was pressed. Why it cannot be is shown under the mouse.
bool show_button(const char* text, const Button& button) {
    ImGui::BeginDisabled(!button.can());
    const bool pressed = ImGui::Button(text);
    ImGui::EndDisabled();
    if (!button.can() && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
        ImGui::SetTooltip("%s", button.lacks.c_str());
    return pressed;
}

void show_buttons(ViewerState& state, const ViewerFacts& facts, Extent2D window) {
    // As large as the last message asks for, from the bottom up.
    const ImVec2 bottom(static_cast<float>(window.width) / 2, static_cast<float>(window.height) - kMargin);
    ImGui::SetNextWindowPos(bottom, ImGuiCond_Always, {0.5f, 1});
    ImGui::Begin("Run", nullptr, ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize);
    if (facts.can_pause) {
        if (ImGui::Button(state.paused ? "Go on (space)" : "Pause (space)")) state.paused = !state.paused;
        ImGui::SameLine();
    }
    if (facts.record.shown) {
        if (show_button(facts.recording ? "Stop recording (R)" : "Record (R)", facts.record)) state.record_asked = true;
        ImGui::SameLine();
    }
    if (facts.undo.shown) {
        if (show_button("Undo (ctrl Z)", facts.undo)) state.undo_asked = true;
        ImGui::SameLine();
    }
    ImGui::BeginDisabled(!facts.can_export);
    if (ImGui::Button("Export (E)")) state.export_asked = true;
    ImGui::EndDisabled();
    if (!facts.message.empty()) say(facts.message);
    ImGui::End();
}

void show_help(ViewerState& state, Extent2D window) {
    if (!state.help) return;
    place({static_cast<float>(window.width) / 2 - 210, 80}, 420);
    ImGui::Begin("Help", &state.help);
    show_table({{"middle button", "turn around the point in the middle"},
                {"shift + middle", "move along the picture"},
                {"wheel", "nearer, farther; beside a held lamp: push it"},
                {"left click", "a surface: its segment and material"},
                {"left drag on a lamp", "move it"},
                {"1 to 9", "layers"},
                {"numpad 1, 3, 7", "from the front, the right, the top"},
                {"with control", "from the back, the left, below"},
                {"numpad 9", "from the other side"},
                {"numpad 4, 6, 8, 2", "turn by 15 degrees"},
                {"numpad + and -", "nearer, farther"},
                {"numpad . or F", "turn around the clicked surface"},
                {"numpad 0", "follow the sensor, or free"},
                {"space", "pause"},
                {"R", "record a live source, or stop that"},
                {"control + Z", "undo: back to the last checkpoint"},
                {"E", "export"},
                {"H", "this list"},
                {"control + Q", "close"}},
               "keys");
    ImGui::End();
}

}  // namespace

OtherLights& own_lights(ViewerState& state, const Lighting& lighting) {
    if (!state.other) state.other = OtherLights{lighting.lights, lighting.ambient, true};
    return *state.other;
}

void show_panels(ViewerState& state, const ViewerFacts& facts, const Lighting& lighting, Extent2D window) {
    show_layers(state, facts);
    show_statistics(facts, static_cast<float>(window.width));
    show_lights(state, facts, lighting);
    show_picked(state, window);
    show_buttons(state, facts, window);
    show_help(state, window);
}

}  // namespace patina::tools
