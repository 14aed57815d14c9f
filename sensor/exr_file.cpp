#include "sensor/exr_file.h"

#include <array>
#include <string>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>

namespace patina::sensor {
namespace {

Extent2D extent_of(const Imath::Box2i& window) {
    return {static_cast<uint32_t>(window.max.x - window.min.x + 1),
            static_cast<uint32_t>(window.max.y - window.min.y + 1)};
}

/// Runs `work` on the opened file; what OpenEXR throws becomes an Error that names the file.
template <class Work>
auto with_exr(const std::filesystem::path& path, Work work) {
    try {
        Imf::InputFile file(path.c_str());
        return work(file);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        throw Error(path.string(), " cannot be decoded: ", error.what());
    }
}

/// Reads whole channels into the floats that make up `image`'s pixels, in the order of `channels`.
template <class Pixel, size_t N>
Image<Pixel> read_channels(Imf::InputFile& file, const std::array<const char*, N>& channels) {
    static_assert(sizeof(Pixel) == N * sizeof(float));
    const Imath::Box2i window = file.header().dataWindow();
    Image<Pixel> image(extent_of(window));
    Imf::FrameBuffer target;
    for (size_t i = 0; i < N; ++i) {
        if (!file.header().channels().findChannel(channels[i]))
            throw Error(file.fileName(), " has no channel ", channels[i]);
        char* first = reinterpret_cast<char*>(image.pixels().data()) + i * sizeof(float);
        target.insert(channels[i], Imf::Slice::Make(Imf::FLOAT, first, window, sizeof(Pixel)));
    }
    file.setFrameBuffer(target);
    file.readPixels(window.min.y, window.max.y);
    return image;
}

}  // namespace

Extent2D exr_extent(const std::filesystem::path& path) {
    return with_exr(path, [](Imf::InputFile& file) { return extent_of(file.header().dataWindow()); });
}

Image<glm::vec3> read_exr_color(const std::filesystem::path& path) {
    return with_exr(path, [](Imf::InputFile& file) {
        return read_channels<glm::vec3>(file, std::array<const char*, 3>{"R", "G", "B"});
    });
}

Image<float> read_exr_depth(const std::filesystem::path& path) {
    return with_exr(path, [](Imf::InputFile& file) {
        for (const char* channel : {"Z", "depth", "Y", "R"}) {
            if (file.header().channels().findChannel(channel)) {
                return read_channels<float>(file, std::array<const char*, 1>{channel});
            }
        }
        throw Error(file.fileName(), " has no depth channel: none of Z, depth, Y and R");
    });
}

void write_exr_color(const std::filesystem::path& path, const Image<glm::vec3>& image) {
    const auto [width, height] = image.extent();
    Imf::Header header(static_cast<int>(width), static_cast<int>(height));
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer pixels;
    for (int i = 0; i < 3; ++i) {
        const std::string name(1, "RGB"[i]);
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        const float* first = &image.pixels().front().r + i;
        pixels.insert(name, Imf::Slice::Make(Imf::FLOAT, first, header.dataWindow(), sizeof(glm::vec3)));
    }
    try {
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(pixels);
        file.writePixels(static_cast<int>(height));
    } catch (const std::exception& error) {
        throw Error(path.string(), " cannot be written: ", error.what());
    }
}

}  // namespace patina::sensor
