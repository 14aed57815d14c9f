#include "tools/eval/exr_planes.h"

#include <charconv>
#include <optional>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>

#include "engine/core/error.h"

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
    if (!fs::exists(path)) throw Error(path.string(), " is missing");
    ExrPlanes picture;
    picture.file_ = path.string();
    try {
        Imf::InputFile file(path.c_str());
        const Imath::Box2i window = file.header().dataWindow();
        picture.extent_ = {static_cast<uint32_t>(window.max.x - window.min.x + 1),
                           static_cast<uint32_t>(window.max.y - window.min.y + 1)};
        Imf::FrameBuffer target;
        const Imf::ChannelList& channels = file.header().channels();
        for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
            if (!only.empty() && !only.contains(channel.name())) continue;
            std::vector<float>& plane = picture.planes_[channel.name()];
            plane.resize(picture.extent_.area());
            target.insert(channel.name(), Imf::Slice::Make(Imf::FLOAT, plane.data(), window));
        }
        file.setFrameBuffer(target);
        file.readPixels(window.min.y, window.max.y);
    } catch (const std::exception& failure) {
        throw Error(path.string(), " cannot be decoded: ", failure.what());
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
    if (!fs::exists(folder)) return frames;
    try {
        for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
            if (const auto index = frame_index(entry.path())) frames.emplace(*index, entry.path());
        }
    } catch (const fs::filesystem_error& failure) {
        throw Error(folder.string(), " cannot be read: ", failure.code().message());
    }
    return frames;
}

}  // namespace patina::eval
