#include "sensor/files/exr_file.h"

#include <array>
#include <string>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "sensor/files/exr_input.h"
#include "sensor/output/exr_stream.h"

namespace patina::sensor {
namespace {

/// Runs `work` on the opened picture; what OpenEXR throws becomes an Error that names the file.
template <class Work>
auto with_exr(const std::string& name, std::span<const uint8_t> bytes, Work work) {
    try {
        ExrInput input(name, bytes);
        return work(input);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        throw Error(name, " cannot be decoded: ", reason_of(error));
    }
}

/// Reads whole channels into the floats that make up `image`'s pixels, in the order of `channels`.
template <class Pixel, size_t N>
Image<Pixel> read_channels(ExrInput& input, const std::array<const char*, N>& channels) {
    static_assert(sizeof(Pixel) == N * sizeof(float));
    Imf::InputFile& file = input.file();
    const Imath::Box2i window = file.header().dataWindow();
    Image<Pixel> image(input.extent());
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

Image<glm::vec3> read_exr_color(const std::string& name, std::span<const uint8_t> bytes) {
    return with_exr(name, bytes, [](ExrInput& input) {
        return read_channels<glm::vec3>(input, std::array<const char*, 3>{"R", "G", "B"});
    });
}

Image<float> read_exr_depth(const std::string& name, std::span<const uint8_t> bytes) {
    return with_exr(name, bytes, [](ExrInput& input) {
        for (const char* channel : {"Z", "depth", "Y", "R"}) {
            if (input.file().header().channels().findChannel(channel)) {
                return read_channels<float>(input, std::array<const char*, 1>{channel});
            }
        }
        throw Error(input.file().fileName(), " has no depth channel: none of Z, depth, Y and R");
    });
}

Image<glm::vec3> read_exr_color(const std::filesystem::path& file) {
    return read_exr_color(file.string(), read_file(file, limits::kPictureBytes));
}

Image<float> read_exr_depth(const std::filesystem::path& file) {
    return read_exr_depth(file.string(), read_file(file, limits::kPictureBytes));
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
        ExrStream stream(path);
        {
            Imf::OutputFile file(stream, header);
            file.setFrameBuffer(pixels);
            file.writePixels(static_cast<int>(height));
        }
        stream.close();
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        throw Error(path.string(), " cannot be written: ", error.what());
    }
}

}  // namespace patina::sensor
