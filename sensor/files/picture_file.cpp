#include "sensor/files/picture_file.h"

#include <cmath>
#include <cstring>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "sensor/files/exr_file.h"
#include "sensor/files/picture_container.h"
#include "sensor/files/text_file.h"

namespace patina::sensor {
namespace {

/// A picture file's bytes, found whole, and what they hold.
struct PictureFile {
    std::string name;
    std::span<const uint8_t> bytes;
    PictureFormat format;
    Extent2D extent;
};

PictureFile examined(const std::string& name, std::span<const uint8_t> bytes) {
    PictureFile file{name, bytes, PictureFormat::kPng, {}};
    const std::optional<PictureFormat> format = picture_format(file.bytes);
    if (!format) throw Error(file.name, " is neither PNG, JPEG nor OpenEXR: it has ", file.bytes.size(), " bytes");
    file.format = *format;
    switch (file.format) {
        case PictureFormat::kPng: file.extent = check_png(file.bytes, file.name); break;
        case PictureFormat::kJpeg: file.extent = check_jpeg(file.bytes, file.name); break;
        case PictureFormat::kExr: file.extent = check_exr(file.bytes, file.name); break;
    }
    return file;
}

const PictureFile& of_size(const PictureFile& file, Extent2D expected) {
    if (file.extent != expected) {
        throw Error(file.name, " is ", file.extent, " pixels, but the sequence says ", expected);
    }
    return file;
}

/// The pixels of a PNG or JPEG file. The decoder may find another size than the header said.
cv::Mat decode(const PictureFile& file) {
    cv::Mat picture;
    try {
        // OpenCV only reads them.
        const cv::Mat bytes(1, static_cast<int>(file.bytes.size()), CV_8U, const_cast<uint8_t*>(file.bytes.data()));
        picture = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
    } catch (const cv::Exception& error) {
        throw Error(file.name, " cannot be decoded: ", error.err);
    }
    if (picture.empty()) throw Error(file.name, " cannot be decoded: its ", file.bytes.size(), " bytes are damaged");
    const Extent2D decoded{static_cast<uint32_t>(picture.cols), static_cast<uint32_t>(picture.rows)};
    if (decoded != file.extent)
        throw Error(file.name, " is damaged: its header says ", file.extent, " pixels, but it holds ", decoded);
    return picture;
}

template <class Pixel>
Image<Pixel> to_image(const cv::Mat& picture, Extent2D extent) {
    PATINA_ASSERT(picture.isContinuous() && picture.total() * picture.elemSize() == extent.area() * sizeof(Pixel),
                  "extent ", extent, ", bytes per pixel ", picture.elemSize());
    Image<Pixel> image(extent);
    std::memcpy(image.pixels().data(), picture.data, extent.area() * sizeof(Pixel));
    return image;
}

int rgb_conversion(int channels) {
    if (channels == 1) return cv::COLOR_GRAY2RGB;
    return channels == 3 ? cv::COLOR_BGR2RGB : cv::COLOR_BGRA2RGB;
}

void encode_png(const std::filesystem::path& file, const cv::Mat& picture) {
    const std::vector<int> settings{cv::IMWRITE_PNG_COMPRESSION, 3, cv::IMWRITE_PNG_STRATEGY,
                                    cv::IMWRITE_PNG_STRATEGY_DEFAULT};
    std::vector<uint8_t> bytes;
    if (!cv::imencode(".png", picture, bytes, settings)) throw Error(file.string(), " cannot be encoded as PNG");
    write_bytes(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

/// The image's pixels as an OpenCV matrix that borrows them and is only read.
template <class Pixel>
cv::Mat borrowed(const Image<Pixel>& image, int type) {
    const auto [width, height] = image.extent();
    return {static_cast<int>(height), static_cast<int>(width), type, const_cast<Pixel*>(image.pixels().data())};
}

ColorImage color_in(const PictureFile& file) {
    if (file.format == PictureFormat::kExr) return read_exr_color(file.name, file.bytes);
    cv::Mat picture = decode(file);
    if (picture.depth() != CV_8U) {
        throw Error(file.name, " has ", 8 * picture.elemSize1(), " bits per channel, but colour must have 8");
    }
    if (picture.channels() == 2) throw Error(file.name, " has 2 channels, but colour must have 1, 3 or 4");
    cv::cvtColor(picture, picture, rgb_conversion(picture.channels()));
    return to_image<SrgbPixel>(picture, file.extent);
}

DepthImage depth_in(const PictureFile& file, uint16_t invalid) {
    if (file.format == PictureFormat::kExr) {
        Image<float> depth_m = read_exr_depth(file.name, file.bytes);
        for (float& z : depth_m.pixels()) z = std::isfinite(z) && z > 0 ? z : 0.0f;
        return depth_m;
    }
    const cv::Mat picture = decode(file);
    if (picture.type() != CV_16UC1) {
        throw Error(file.name, " has ", picture.channels(), " channel(s) of ", 8 * picture.elemSize1(),
                    " bits, but depth must have 1 of 16");
    }
    auto depth = to_image<uint16_t>(picture, file.extent);
    if (invalid != 0) std::replace(depth.pixels().begin(), depth.pixels().end(), invalid, uint16_t{0});
    return depth;
}

}  // namespace

Extent2D picture_extent(const std::filesystem::path& file) {
    const std::vector<uint8_t> bytes = read_file(file, limits::kPictureBytes);
    return examined(file.string(), bytes).extent;
}

ColorImage read_color(const std::filesystem::path& file, Extent2D expected) {
    return decode_color(file.string(), read_file(file, limits::kPictureBytes), expected);
}

ColorImage decode_color(const std::string& name, std::span<const uint8_t> bytes, Extent2D expected) {
    return color_in(of_size(examined(name, bytes), expected));
}

DepthImage read_depth(const std::filesystem::path& file, Extent2D expected, uint16_t invalid) {
    const std::vector<uint8_t> bytes = read_file(file, limits::kPictureBytes);
    return depth_in(of_size(examined(file.string(), bytes), expected), invalid);
}

DepthImage decode_depth(const std::string& name, std::span<const uint8_t> bytes, Extent2D expected) {
    return depth_in(of_size(examined(name, bytes), expected), 0);
}

std::string picture_stem(uint32_t index) {
    const std::string digits = std::to_string(index);
    return std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits;
}

void write_png(const std::filesystem::path& file, const Image<SrgbPixel>& image) {
    cv::Mat bgr;
    cv::cvtColor(borrowed(image, CV_8UC3), bgr, cv::COLOR_RGB2BGR);
    encode_png(file, bgr);
}

void write_png(const std::filesystem::path& file, const Image<uint16_t>& image) {
    encode_png(file, borrowed(image, CV_16UC1));
}

}  // namespace patina::sensor
