#include "export/write_exr.h"

#include <exception>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include "engine/core/error.h"
#include "sensor/output/exr_stream.h"

namespace patina {
namespace {

void check_channels(const std::filesystem::path& path, std::span<const ExrChannel> channels) {
    if (channels.empty()) throw Error(path, ": a picture without channels cannot be written");
    const ExrChannel& first = channels.front();
    for (const ExrChannel& channel : channels) {
        if (channel.extent.area() == 0) throw Error(path, ": channel ", channel.name, " is empty: ", channel.extent);
        if (channel.extent != first.extent) {
            throw Error(path, ": channel ", channel.name, " is ", channel.extent, " but ", first.name, " is ",
                        first.extent);
        }
    }
}

Imf::Slice slice_of(const ExrChannel& channel) {
    const size_t pixel_bytes = channel.step * sizeof(float);
    const Imath::Box2i window(
        {0, 0}, {static_cast<int>(channel.extent.width) - 1, static_cast<int>(channel.extent.height) - 1});
    return Imf::Slice::Make(Imf::FLOAT, channel.first, window, pixel_bytes, pixel_bytes * channel.extent.width);
}

void add_channel(const std::filesystem::path& path, const ExrChannel& channel, Imf::Header& header,
                 Imf::FrameBuffer& pixels) {
    if (header.channels().findChannel(channel.name)) throw Error(path, ": channel ", channel.name, " is given twice");
    header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
    pixels.insert(channel.name, slice_of(channel));
}

std::vector<ExrChannel> vector_channels(const std::string& name, const Image<glm::vec3>& image,
                                        const char* components) {
    static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
    std::vector<ExrChannel> channels;
    for (size_t i = 0; i < 3; ++i) {
        const float* first = image.empty() ? nullptr : &image.pixels().front().x + i;
        channels.push_back({name + "." + components[i], image.extent(), first, 3});
    }
    return channels;
}

}  // namespace

ExrChannel scalar_channel(const std::string& name, const Image<float>& image) {
    return {name, image.extent(), image.pixels().data(), 1};
}

std::vector<ExrChannel> rgb_channels(const std::string& name, const Image<glm::vec3>& image) {
    return vector_channels(name, image, "RGB");
}

std::vector<ExrChannel> xyz_channels(const std::string& name, const Image<glm::vec3>& image) {
    return vector_channels(name, image, "XYZ");
}

void write_exr(const std::filesystem::path& path, std::span<const ExrChannel> channels, const std::string& run_id) {
    check_channels(path, channels);
    const Extent2D extent = channels.front().extent;
    Imf::Header header(static_cast<int>(extent.width), static_cast<int>(extent.height));
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer pixels;
    for (const ExrChannel& channel : channels) add_channel(path, channel, header, pixels);
    if (!run_id.empty()) header.insert(kRunIdAttribute, Imf::StringAttribute(run_id));
    try {
        sensor::ExrStream stream(path);
        {
            Imf::OutputFile file(stream, header);
            file.setFrameBuffer(pixels);
            file.writePixels(static_cast<int>(extent.height));
        }
        stream.close();
    } catch (const Error&) {
        throw;
    } catch (const std::exception& failure) {
        throw Error(path, ": cannot be written: ", failure.what());
    }
}

std::vector<ExrChannel> channels_of(const FrameDump& frame) {
    std::vector<ExrChannel> channels;
    const auto append = [&](const std::vector<ExrChannel>& group) {
        channels.insert(channels.end(), group.begin(), group.end());
    };
    append(rgb_channels("rgb", frame.rgb));
    append({scalar_channel("depth", frame.depth_m)});
    append(xyz_channels("normal", frame.normal));
    append({scalar_channel("valid", frame.valid)});
    if (!frame.kd.empty()) append(rgb_channels("kd", frame.kd));
    if (!frame.ks.empty()) append(rgb_channels("ks", frame.ks));
    if (!frame.alpha.empty()) append({scalar_channel("alpha", frame.alpha)});
    if (!frame.kd_segment.empty()) append(rgb_channels("kd_segment", frame.kd_segment));
    if (!frame.rgb_segment.empty()) append(rgb_channels("rgb_segment", frame.rgb_segment));
    if (!frame.kd_shown.empty()) append(rgb_channels("kd_shown", frame.kd_shown));
    if (!frame.rgb_shown.empty()) append(rgb_channels("rgb_shown", frame.rgb_shown));
    if (!frame.label.empty()) append({scalar_channel("label", frame.label)});
    if (!frame.visibility.empty()) append({scalar_channel("visibility", frame.visibility)});
    return channels;
}

}  // namespace patina
