#include "tools/viewer/file_display.h"

#include <fmt/format.h>
#include <imgui.h>

#include "engine/graph/runner.h"
#include "sensor/files/text_file.h"
#include "sensor/output/apart.h"
#include "sensor/output/output_file.h"

namespace patina::tools {

namespace {

constexpr float kFrame_s = 1.0f / 30;  // of the user interface's clock: the same in each run

}  // namespace

FileDisplay::FileDisplay(const std::filesystem::path& file, Extent2D extent, double fps,
                         const std::vector<std::filesystem::path>& inputs)
    : file_(file), extent_(extent), inputs_(inputs) {
    sensor::expect_apart(file, inputs);
    if (file.extension() == ".png") return;
    if (file.extension() != ".mp4" && file.extension() != ".avi")
        throw Error("frames cannot be drawn to '", file.string(), "': it must be a .png, an .mp4 or an .avi");
    video_.emplace(file, extent, fps, inputs);
}

vk::Format FileDisplay::open(vulkan::Device& device) {
    device_ = &device;
    image_ = device.create_image({"viewer.target", extent_, vulkan::Format::kRgba8, true});
    return vulkan::vk_format(vulkan::Format::kRgba8);
}

void FileDisplay::begin_ui() {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {static_cast<float>(extent_.width), static_cast<float>(extent_.height)};
    io.DeltaTime = kFrame_s;
}

std::optional<vulkan::ComposeTarget> FileDisplay::begin() {
    const vulkan::ImageObject& object = image_->object();
    return vulkan::ComposeTarget{*object.image, *object.view, extent_, {}, {}};
}

void FileDisplay::show() {
    graph::Runner runner(*device_);
    graph::FrameGraph graph = runner.begin();
    const graph::Readback read = graph.read_back(graph.import(image_));
    runner.submit(std::move(graph));
    runner.wait();
    Drawing drawing(extent_);
    const std::vector<glm::u8vec4> pixels = read.as<glm::u8vec4>();
    for (size_t i = 0; i < pixels.size(); ++i) drawing.pixels()[i] = {pixels[i].r, pixels[i].g, pixels[i].b};
    if (video_) {
        video_->write(drawing);
    } else if (numbered(0) == file_) {
        last_ = std::move(drawing);
    } else {
        write_picture(numbered(count_), drawing);
    }
    ++count_;
}

std::filesystem::path FileDisplay::numbered(uint32_t number) const {
    const std::string name = file_.filename().string();
    const size_t first = name.find('#');
    if (first == std::string::npos) return file_;
    const size_t end = std::min(name.find_first_not_of('#', first), name.size());
    return file_.parent_path() /
           fmt::format("{}{:0{}}{}", name.substr(0, first), number, end - first, name.substr(end));
}

void FileDisplay::write_picture(const std::filesystem::path& file, const Drawing& drawing) const {
    sensor::OutputFile output(file, inputs_);
    sensor::write_bytes(output.partial_path(), png_of(drawing));
    output.finish();
}

void FileDisplay::finish() {
    if (video_ && count_ > 0) video_->finish();
    if (last_) write_picture(file_, *last_);
    last_.reset();
    video_.reset();
}

}  // namespace patina::tools
