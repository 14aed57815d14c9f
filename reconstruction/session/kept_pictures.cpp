#include "reconstruction/session/kept_pictures.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "engine/core/luminance.h"
#include "reconstruction/pipeline.h"
#include "sensor/recording/payload_codec.h"

namespace patina {
namespace {

// A stretch of the way ends where the camera has moved or turned by this much.
constexpr double kStep_m = 0.05, kStep_rad = 0.045;
constexpr float kLonger = 1.3f;  // stretches become, where there are too many

Extent2D extent_of(const ColorImage& color) {
    return std::visit([](const auto& image) { return image.extent(); }, color);
}

float brightness(SrgbPixel pixel) { return pixel.g; }
float brightness(glm::vec3 pixel) { return luminance(pixel); }

/// How much neighbouring pixels differ, squared, over their brightness; every second pixel of every second row is
/// looked at.
template <class Pixel>
float sharpness_of(const Image<Pixel>& image) {
    double differences = 0, total = 1e-6;
    for (uint32_t y = 0; y + 1 < image.extent().height; y += 2) {
        for (uint32_t x = 0; x + 1 < image.extent().width; x += 2) {
            const float here = brightness(image.at(x, y));
            const float right = brightness(image.at(x + 1, y)) - here, down = brightness(image.at(x, y + 1)) - here;
            differences += double{right * right + down * down};
            total += double{here * here};
        }
    }
    return static_cast<float>(differences / total);
}

/// Edge of a pixel on the surface, of the nearest tenth of the readings.
float finest_pixel_m(const SequenceInfo& info, const DepthImage& depth) {
    std::vector<float> readings_m;
    const auto collect = [&](const auto& image, double metres) {
        for (size_t i = 0; i < image.pixels().size(); i += 7) {
            const double reading_m = static_cast<double>(image.pixels()[i]) * metres;
            if (reading_m > 0 && reading_m <= info.max_metres) readings_m.push_back(static_cast<float>(reading_m));
        }
    };
    if (const auto* units = std::get_if<Image<uint16_t>>(&depth)) {
        collect(*units, info.metres_per_unit);
    } else {
        collect(std::get<Image<float>>(depth), 1.0);
    }
    if (readings_m.empty()) return 0;
    const auto tenth = readings_m.begin() + static_cast<std::ptrdiff_t>(readings_m.size() / 10);
    std::nth_element(readings_m.begin(), tenth, readings_m.end());
    return *tenth / static_cast<float>(info.color.fx);
}

std::vector<std::byte> packed(const ColorImage& color) {
    const std::vector<uint8_t> bytes = sensor::encode(color);
    const std::span<const std::byte> whole = std::as_bytes(std::span(bytes));
    return {whole.begin(), whole.end()};
}

}  // namespace

bool KeptPictures::is_apart(const RigidTransform& a, const RigidTransform& b) const {
    const double moved = glm::distance(glm::dvec3(a[3]), glm::dvec3(b[3])) / kStep_m;
    const double cosine = std::clamp(glm::dot(glm::dvec3(a[2]), glm::dvec3(b[2])), -1.0, 1.0);
    return moved + std::acos(cosine) / kStep_rad > double{spacing_};
}

void KeptPictures::add(const SequenceInfo& info, const Frame& frame, uint32_t order) {
    Picture picture;
    picture.order = order;
    picture.extent = extent_of(frame.color);
    picture.linear = std::holds_alternative<Image<glm::vec3>>(frame.color);
    picture.sharpness = std::visit([](const auto& image) { return sharpness_of(image); }, frame.color);
    picture.world_from_color = *frame.world_from_camera * rigid_inverse(info.color_from_depth);
    picture.stretch = picture.world_from_color;
    if (current_ && is_apart(current_->picture.stretch, picture.world_from_color)) settle();
    if (current_) {
        if (picture.sharpness <= current_->picture.sharpness) return;
        picture.stretch = current_->picture.stretch;
    }
    picture.finest_m = patina::finest_pixel_m(info, frame.depth);
    current_ = Current{picture, frame.color};
}

void KeptPictures::keep_first(uint32_t frames) {
    std::erase_if(kept_, [&](const Kept& kept) { return kept.picture.order >= frames; });
    if (current_ && current_->picture.order >= frames) current_.reset();
}

/// The stretch at hand has come to its end.
void KeptPictures::settle() {
    kept_.push_back({current_->picture, packed(current_->color)});
    current_.reset();
    const auto bytes = [&] {
        uint64_t sum = 0;
        for (const Kept& kept : kept_) sum += kept.packed.size();
        return sum;
    };
    while (kept_.size() > 1 && (kept_.size() > kMostPictures || bytes() > kMostBytes)) thin();
}

void KeptPictures::thin() {
    spacing_ *= kLonger;
    std::vector<Kept> fewer;
    for (Kept& kept : kept_) {
        if (fewer.empty() || is_apart(fewer.back().picture.stretch, kept.picture.stretch)) {
            fewer.push_back(std::move(kept));
        } else if (kept.picture.sharpness > fewer.back().picture.sharpness) {
            kept.picture.stretch = fewer.back().picture.stretch;
            fewer.back() = std::move(kept);
        }
    }
    kept_ = std::move(fewer);
}

ColorImage KeptPictures::unpack(const Kept& kept) {
    const std::string_view encoding = kept.picture.linear != 0 ? sensor::kRgbFloat : sensor::kRgb8;
    const auto* bytes = reinterpret_cast<const uint8_t*>(kept.packed.data());
    return sensor::decode_color(encoding, {bytes, bytes + kept.packed.size()}, kept.picture.extent,
                                fmt::format("the picture of frame {} that was kept", kept.picture.order));
}

void KeptPictures::give(const SequenceInfo& info, std::span<const gpu::ColorGains> gains,
                        const std::function<void(const TexturePicture&)>& take) {
    const auto give_one = [&](const Picture& picture, const ColorImage& color) {
        TexturePicture given;
        std::visit([&](const auto& image) { given.color.pixels = std::span(std::as_const(image).pixels()); }, color);
        given.color.camera = info.color;
        given.world_from_camera = picture.world_from_color;
        if (picture.order < gains.size()) given.gain = glm::vec3(gains[picture.order].gain);
        take(given);
    };
    for (const Kept& kept : kept_) give_one(kept.picture, unpack(kept));
    if (current_) give_one(current_->picture, current_->color);
}

void KeptPictures::show_in(Pipeline& pipeline, const SequenceInfo& info) {
    pipeline.show_pictures(info.color, size(),
                           [&](const Pipeline::TakePicture& take) { give(info, pipeline.gains(), take); });
}

double KeptPictures::finest_pixel_m() const {
    double finest_m = 0;
    const auto look_at = [&](const Picture& picture) {
        if (picture.finest_m > 0 && (finest_m == 0 || double{picture.finest_m} < finest_m))
            finest_m = double{picture.finest_m};
    };
    for (const Kept& kept : kept_) look_at(kept.picture);
    if (current_) look_at(current_->picture);
    return finest_m;
}

void KeptPictures::visit(graph::StateVisitor& visitor) {
    std::vector<Picture> pictures;
    for (const Kept& kept : kept_) pictures.push_back(kept.picture);
    uint32_t at_hand = current_ ? 1 : 0;  // its pixels are kept as those of the others
    if (current_) {
        pictures.push_back(current_->picture);
        kept_.push_back({current_->picture, packed(current_->color)});
        current_.reset();
    }
    visitor.value("pictures.spacing", spacing_);
    visitor.value("pictures.at_hand", at_hand);
    visitor.values("pictures.list", pictures);
    kept_.resize(pictures.size());
    for (size_t i = 0; i < pictures.size(); ++i) {
        kept_[i].picture = pictures[i];
        visitor.bytes(fmt::format("pictures.{}", i), kept_[i].packed);
    }
    if (at_hand == 0 || kept_.empty()) return;
    current_ = Current{kept_.back().picture, unpack(kept_.back())};
    kept_.pop_back();
}

}  // namespace patina
