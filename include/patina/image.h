#pragma once

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <utility>
#include <vector>

#include "patina/error.h"

namespace patina {

/// Width and height in pixels.
struct Extent2D {
    uint32_t width = 0;
    uint32_t height = 0;

    bool operator==(const Extent2D&) const = default;
    size_t area() const { return size_t{width} * height; }
    bool contains(int x, int y) const {
        return x >= 0 && y >= 0 && static_cast<uint32_t>(x) < width && static_cast<uint32_t>(y) < height;
    }
};

inline std::ostream& operator<<(std::ostream& out, Extent2D extent) {
    return out << extent.width << " x " << extent.height;
}

/// A picture in host memory, rows top to bottom without padding. Throws Error where pixels do not fill the extent.
template <class Pixel>
class Image {
  public:
    Image() = default;
    explicit Image(Extent2D extent, Pixel value = {}) : extent_(extent), pixels_(extent.area(), value) {}
    Image(Extent2D extent, std::vector<Pixel> pixels) : extent_(extent), pixels_(std::move(pixels)) {
        if (pixels_.size() != extent.area())
            throw Error("an image of ", extent, " pixels was given ", pixels_.size(), " pixels");
    }

    Extent2D extent() const { return extent_; }
    bool empty() const { return pixels_.empty(); }
    Pixel& at(uint32_t x, uint32_t y) { return pixels_[size_t{y} * extent_.width + x]; }
    const Pixel& at(uint32_t x, uint32_t y) const { return pixels_[size_t{y} * extent_.width + x]; }
    std::vector<Pixel>& pixels() { return pixels_; }
    const std::vector<Pixel>& pixels() const { return pixels_; }

  private:
    Extent2D extent_;
    std::vector<Pixel> pixels_;
};

}  // namespace patina
