#include "sensor/resample.h"

#include <opencv2/imgproc.hpp>

namespace patina::sensor {
namespace {

template <class Pixel>
Image<Pixel> nearest(const Image<Pixel>& from, Extent2D extent) {
    Image<Pixel> to(extent);
    for (uint32_t y = 0; y < extent.height; ++y) {
        // The source pixel in which the target pixel's centre (y + 1/2) lies.
        const auto from_y = static_cast<uint32_t>((2 * uint64_t{y} + 1) * from.extent().height / (2 * extent.height));
        for (uint32_t x = 0; x < extent.width; ++x) {
            const auto from_x = static_cast<uint32_t>((2 * uint64_t{x} + 1) * from.extent().width / (2 * extent.width));
            to.at(x, y) = from.at(from_x, from_y);
        }
    }
    return to;
}

template <class Pixel>
cv::Mat borrowed(Image<Pixel>& image) {
    using Channel = typename Pixel::value_type;
    const auto [width, height] = image.extent();
    return {static_cast<int>(height), static_cast<int>(width), CV_MAKETYPE(cv::DataType<Channel>::depth, 3),
            image.pixels().data()};
}

template <class Pixel>
Image<Pixel> smooth(Image<Pixel>& from, Extent2D extent) {
    const bool shrinks = extent.width <= from.extent().width && extent.height <= from.extent().height;
    Image<Pixel> to(extent);
    cv::Mat target = borrowed(to);
    cv::resize(borrowed(from), target, target.size(), 0, 0, shrinks ? cv::INTER_AREA : cv::INTER_LINEAR);
    return to;
}

}  // namespace

ResampledSource::ResampledSource(std::unique_ptr<Source> source, Extent2D color_extent, Extent2D depth_extent)
    : source_(std::move(source)), info_(source_->info()) {
    if (color_extent.area() == 0 || depth_extent.area() == 0) {
        throw Error(info_.name, " cannot be resampled to ", color_extent, " and ", depth_extent, " pixels");
    }
    info_.color = scaled_to(info_.color, color_extent);
    info_.depth = scaled_to(info_.depth, depth_extent);
}

std::optional<Reading> ResampledSource::next() {
    std::optional<Reading> reading = source_->next();
    if (!reading) return reading;
    if (auto* frame = std::get_if<Frame>(&*reading)) {
        frame->color =
            std::visit([&](auto& image) { return ColorImage(smooth(image, info_.color.extent)); }, frame->color);
        frame->depth =
            std::visit([&](auto& image) { return DepthImage(nearest(image, info_.depth.extent)); }, frame->depth);
    }
    return reading;
}

}  // namespace patina::sensor
