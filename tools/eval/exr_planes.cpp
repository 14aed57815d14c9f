#include "tools/eval/exr_planes.h"

#include <charconv>
#include <optional>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfStringAttribute.h>

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "sensor/files/exr_input.h"
#include "tools/report/run_id.h"

namespace patina::eval {
namespace {

namespace fs = std::filesystem;

/// The index that a picture's name stands for; empty for other files.
std::optional<uint32_t> frame_index(const fs::path& file) {
    const std::string stem = file.stem().string();
    uint32_t index = 0;
    const auto [end, failure] = std::from_chars(stem.data(), stem.data() + stem.size(), index);
    const bool whole = failure == std::errc{} && end == stem.data() + stem.size();
    return whole && file.extension() == ".exr" ? std::optional(index) : std::nullopt;
}

}  // namespace

ExrPlanes ExrPlanes::read(const fs::path& path, const std::set<std::string>& only) {
    ExrPlanes picture;
    picture.file_ = path.string();
    try {
        const std::vector<uint8_t> bytes = read_file(path, limits::kPlanesBytes);
        sensor::ExrInput input(picture.file_, bytes);
        picture.extent_ = input.extent();
        const auto* id = input.file().header().findTypedAttribute<Imf::StringAttribute>(kRunIdAttribute);
        if (id) picture.run_id_ = id->value();
        Imf::FrameBuffer target;
        const Imath::Box2i window = input.file().header().dataWindow();
        const Imf::ChannelList& channels = input.file().header().channels();
        for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
            if (!only.empty() && !only.contains(channel.name())) continue;
            std::vector<float>& plane = picture.planes_[channel.name()];
            plane.resize(picture.extent_.area());
            target.insert(channel.name(), Imf::Slice::Make(Imf::FLOAT, plane.data(), window));
        }
        input.file().setFrameBuffer(target);
        input.file().readPixels(window.min.y, window.max.y);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& failure) {
        throw Error(path.string(), " cannot be decoded: ", reason_of(failure));
    }
    return picture;
}

const std::vector<float>& ExrPlanes::plane(const std::string& channel) const {
    const auto found = planes_.find(channel);
    if (found == planes_.end()) throw Error(file_, " has no channel ", channel);
    return found->second;
}

Image<glm::vec3> ExrPlanes::rgb(const std::string& name) const {
    Image<glm::vec3> picture(extent_);
    for (int i = 0; i < 3; ++i) {
        const std::vector<float>& values = plane(name + "." + "RGB"[i]);
        for (size_t pixel = 0; pixel < values.size(); ++pixel) picture.pixels()[pixel][i] = values[pixel];
    }
    return picture;
}

std::map<uint32_t, fs::path> exr_frames(const fs::path& folder) {
    std::map<uint32_t, fs::path> frames;
    if (!path_exists(folder)) return frames;
    for (const fs::path& entry : entries_of(folder)) {
        if (const auto index = frame_index(entry)) frames.emplace(*index, entry);
    }
    return frames;
}

}  // namespace patina::eval
