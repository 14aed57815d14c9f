#include "tools/bench/recording.h"

#include <fstream>
#include <type_traits>

#include <nlohmann/json.hpp>

#include "cameras/open_sequence.h"
#include "engine/core/error.h"
#include "scenes/files/scene_file.h"
#include "scenes/render/synthetic_source.h"
#include "sensor/open.h"
#include "sensor/resample.h"

namespace patina::bench {

namespace {

constexpr std::string_view kSynthetic = "synthetic:";

Recording read_all(std::unique_ptr<Source> source, const RecordingOptions& options) {
    if (options.extent) {
        source = std::make_unique<sensor::ResampledSource>(std::move(source), *options.extent, *options.extent);
    }
    Recording recording{source->info(), {}};
    while (recording.frames.size() < options.frames) {
        auto reading = source->next();
        if (!reading) break;
        auto* frame = std::get_if<Frame>(&*reading);
        if (frame && frame->world_from_camera) recording.frames.push_back(std::move(*frame));
    }
    if (recording.frames.size() < options.frames) {
        throw Error("the sequence '", options.sequence, "' has ", recording.frames.size(),
                    " usable frames with poses, ", options.frames, " are asked for");
    }
    return recording;
}

template <class Variant>
uint64_t picture_bytes(const Variant& picture) {
    return std::visit([](const auto& image) { return image.pixels().size() * sizeof(image.pixels().front()); },
                      picture);
}

template <class Value>
void append(std::ofstream& out, const std::vector<Value>& values) {
    out.write(reinterpret_cast<const char*>(values.data()),
              static_cast<std::streamsize>(values.size() * sizeof(Value)));
}

std::vector<float> metres(const DepthImage& depth, double metres_per_unit) {
    return std::visit(
        [&](const auto& image) {
            std::vector<float> out(image.pixels().begin(), image.pixels().end());
            if constexpr (std::is_same_v<std::decay_t<decltype(image)>, Image<uint16_t>>) {
                for (float& value : out) value *= static_cast<float>(metres_per_unit);
            }
            return out;
        },
        depth);
}

nlohmann::json camera_json(const Intrinsics& camera) {
    return {{"width", camera.extent.width},
            {"height", camera.extent.height},
            {"fx", camera.fx},
            {"fy", camera.fy},
            {"cx", camera.cx},
            {"cy", camera.cy}};
}

nlohmann::json pose_json(const RigidTransform& pose) {
    nlohmann::json rows;
    for (int row = 0; row < 4; ++row) rows.push_back({pose[0][row], pose[1][row], pose[2][row], pose[3][row]});
    return rows;
}

}  // namespace

uint64_t Recording::bytes() const {
    uint64_t total = 0;
    for (const Frame& frame : frames) total += picture_bytes(frame.color) + picture_bytes(frame.depth);
    return total;
}

Recording load(const RecordingOptions& options, const vulkan::DeviceOptions& device_options) {
    if (!options.sequence.starts_with(kSynthetic)) {
        std::optional<vulkan::Device> device;  // for raw recordings alone
        const auto decoders = cameras::payload_decoders(
            [&]() -> vulkan::Device& { return device ? *device : device.emplace(device_options); });
        return read_all(sensor::open_sequence(options.sequence, options.format, decoders), options);
    }
    vulkan::Device device(device_options);
    auto scene = scenes::load_scene(options.sequence.substr(kSynthetic.size()));
    const scenes::SyntheticOptions frames{.frames = options.frames};
    return read_all(std::make_unique<scenes::SyntheticSource>(device, std::move(scene), frames), options);
}

void dump(const Recording& recording, const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    std::ofstream depth(folder / "depth_m.f32", std::ios::binary), color(folder / "color.u8", std::ios::binary);
    nlohmann::json poses;
    for (const Frame& frame : recording.frames) {
        append(depth, metres(frame.depth, recording.info.metres_per_unit));
        if (const auto* picture = std::get_if<Image<SrgbPixel>>(&frame.color)) append(color, picture->pixels());
        poses.push_back(pose_json(*frame.world_from_camera));
    }
    std::ofstream description(folder / "recording.json");
    description << nlohmann::json{{"name", recording.info.name},
                                  {"depth", camera_json(recording.info.depth)},
                                  {"color", camera_json(recording.info.color)},
                                  {"world_from_depth", poses}};
    if (!depth.flush() || !color.flush() || !description.flush()) {
        throw Error("the frames cannot be written to '", folder.string(), "'");
    }
}

}  // namespace patina::bench
