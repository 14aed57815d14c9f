#include "sensor/repeated.h"

#include "engine/core/error.h"

namespace patina::sensor {

namespace {

template <class Picture>
bool same(const Picture& a, const Picture& b) {
    if (a.index() != b.index()) return false;
    return std::visit(
        [&](const auto& image) {
            const auto& other = std::get<std::decay_t<decltype(image)>>(b);
            return image.extent() == other.extent() && image.pixels() == other.pixels();
        },
        a);
}

}  // namespace

bool same_pixels(const ColorImage& a, const ColorImage& b) { return same(a, b); }
bool same_pixels(const DepthImage& a, const DepthImage& b) { return same(a, b); }

std::optional<std::string> repeats(const Frame& frame, const Frame& before) {
    if (frame.timestamp_s == before.timestamp_s) return text("it has the time of frame ", before.index);
    if (same_pixels(frame.depth, before.depth) && same_pixels(frame.color, before.color))
        return text("its picture and depth are those of frame ", before.index);
    return std::nullopt;
}

}  // namespace patina::sensor
