#include "tools/viewer/gui.h"

#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

namespace patina::tools {

namespace {

constexpr uint32_t kBuffers = 3;  // of vertices: more than frames are in flight

void expect_success(VkResult result) {
    if (result == VK_ERROR_DEVICE_LOST) throw Error("the Vulkan device was lost while drawing the user interface");
    if (result < 0)
        throw Error("the user interface could not be drawn: ", vk::to_string(static_cast<vk::Result>(result)));
}

void set_style() {
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = 4;
    style.FrameRounding = 3;
    style.Colors[ImGuiCol_WindowBg].w = 0.85f;
}

}  // namespace

Gui::Gui(const std::shared_ptr<vulkan::Context>& context, Display& display, vk::RenderPass pass)
    : context_(context), display_(display) {
    vulkan::guarded("preparing the user interface", [&] {
        const vk::DescriptorPoolSize size(vk::DescriptorType::eCombinedImageSampler, 4);
        descriptors_ =
            context->device().createDescriptorPool({vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 4, size});
    });
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // windows stand where they are put, in each run alike
    set_style();
    display.attach_ui();
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = *context->instance();
    info.PhysicalDevice = *context->physical();
    info.Device = *context->device();
    info.QueueFamily = context->queue_family();
    info.Queue = *context->queue();
    info.DescriptorPool = *descriptors_;
    info.MinImageCount = kBuffers;
    info.ImageCount = kBuffers;
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    info.CheckVkResultFn = expect_success;
    ImGui_ImplVulkan_Init(&info, pass);
    load_fonts();
}

void Gui::load_fonts() {
    vulkan::guarded("loading the user interface's font", [&] {
        vulkan::submit_and_wait(*context_,
                                [](vk::CommandBuffer commands) { ImGui_ImplVulkan_CreateFontsTexture(commands); });
    });
    ImGui_ImplVulkan_DestroyFontUploadObjects();
}

Gui::~Gui() {
    try {
        context_->device().waitIdle();
        ImGui_ImplVulkan_Shutdown();
    } catch (const std::exception&) {
        // Of a lost device nothing is given back; whoever submitted to it has been told.
    }
    display_.detach_ui();
    ImGui::DestroyContext();
}

void Gui::begin() {
    ImGui_ImplVulkan_NewFrame();
    display_.begin_ui();
    ImGui::NewFrame();
}

void Gui::end() { ImGui::Render(); }

void Gui::record(vk::CommandBuffer commands) const { ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands); }

}  // namespace patina::tools
