#include "export/page_picture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <opencv2/imgcodecs.hpp>

#include "engine/core/error.h"
#include "engine/core/srgb.h"

namespace patina {
namespace {

constexpr size_t kMostOfPng = size_t{1} << 20;  // texels
constexpr int kJpegQuality = 92;
constexpr int kSteps = 4096;  // of the table, over the square root of a linear value

/// sRGB codes of linear values; a table, as there are millions of them.
class SrgbTable {
  public:
    SrgbTable() {
        for (int i = 0; i <= kSteps; ++i) {
            const double root = static_cast<double>(i) / kSteps;
            codes_.push_back(static_cast<uint8_t>(std::lround(255 * srgb_encoded(root * root))));
        }
    }

    SrgbPixel of(glm::vec3 linear) const {
        const glm::ivec3 at(glm::sqrt(glm::clamp(linear, 0.0f, 1.0f)) * static_cast<float>(kSteps) + 0.5f);
        return {codes_[static_cast<size_t>(at.r)], codes_[static_cast<size_t>(at.g)],
                codes_[static_cast<size_t>(at.b)]};
    }

  private:
    std::vector<uint8_t> codes_;
};

/// Colours of a picture at half the resolution again and again, each the mean of those that are known.
struct Level {
    Extent2D extent;
    std::vector<glm::vec4> colors;  ///< a: 1 where one is known
};

Level halved(const Level& fine) {
    Level coarse{{(fine.extent.width + 1) / 2, (fine.extent.height + 1) / 2}, {}};
    coarse.colors.resize(coarse.extent.area(), glm::vec4(0));
    for (uint32_t y = 0; y < fine.extent.height; ++y)
        for (uint32_t x = 0; x < fine.extent.width; ++x)
            coarse.colors[size_t{y / 2} * coarse.extent.width + x / 2] +=
                fine.colors[size_t{y} * fine.extent.width + x];
    for (glm::vec4& color : coarse.colors)
        if (color.a > 0) color /= color.a;
    return coarse;
}

/// Gives what has no colour that of the nearest level that knows one there, so that filters and compression find
/// nothing foreign beside a chart (Gortler et al. 1996, "The lumigraph": pull-push).
void fill_gaps(Level& finest) {
    std::vector<Level> levels;
    levels.push_back(halved(finest));
    while (levels.back().extent.area() > 1) levels.push_back(halved(levels.back()));
    const auto fill_from = [](Level& fine, const Level& coarse) {
        for (uint32_t y = 0; y < fine.extent.height; ++y) {
            for (uint32_t x = 0; x < fine.extent.width; ++x) {
                glm::vec4& color = fine.colors[size_t{y} * fine.extent.width + x];
                if (color.a == 0) color = coarse.colors[size_t{y / 2} * coarse.extent.width + x / 2];
            }
        }
    };
    for (size_t i = levels.size() - 1; i > 0; --i) fill_from(levels[i - 1], levels[i]);
    fill_from(finest, levels.front());
}

}  // namespace

PagePicture page_picture(const TexturePage& page, const std::vector<TextureBox>& boxes, uint32_t number,
                         const std::function<float(uint32_t)>& factor_of) {
    uint64_t clamped = 0;
    Level colors{page.kd.extent(), std::vector<glm::vec4>(page.kd.extent().area(), glm::vec4(0))};
    for (const TextureBox& box : boxes) {
        if (box.page != number) continue;
        const float factor = factor_of(box.label);
        for (uint32_t y = box.low.y; y < box.high.y; ++y) {
            for (uint32_t x = box.low.x; x < box.high.x; ++x) {
                if (page.states.at(x, y) == TexelState::kEmpty) continue;
                const glm::vec3 color = factor * page.kd.at(x, y);
                clamped += glm::any(glm::greaterThan(color, glm::vec3(1)));
                colors.colors[size_t{y} * colors.extent.width + x] = glm::vec4(color, 1);
            }
        }
    }
    fill_gaps(colors);
    const SrgbTable table;
    Image<SrgbPixel> picture(colors.extent);
    for (size_t i = 0; i < colors.colors.size(); ++i) picture.pixels()[i] = table.of(glm::vec3(colors.colors[i]));
    return {std::move(picture), clamped};
}

Image<SrgbPixel> detail_picture(const Image<glm::vec3>& detail) {
    Image<SrgbPixel> picture(detail.extent());
    std::ranges::transform(detail.pixels(), picture.pixels().begin(), [](glm::vec3 normal) {
        const glm::vec3 shown = normal == glm::vec3(0) ? glm::vec3(0, 0, 1) : normal;
        return SrgbPixel(glm::round(glm::clamp(127.5f * shown + 127.5f, 0.0f, 255.0f)));
    });
    return picture;
}

namespace {

EncodedPicture encoded(const Image<SrgbPixel>& picture, const char* mime_type, const std::vector<int>& how) {
    const auto width = static_cast<int>(picture.extent().width), height = static_cast<int>(picture.extent().height);
    cv::Mat bgr(height, width, CV_8UC3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const SrgbPixel pixel = picture.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
            bgr.at<cv::Vec3b>(y, x) = {pixel.b, pixel.g, pixel.r};
        }
    }
    EncodedPicture result{mime_type, {}};
    if (!cv::imencode(extension_of(result), bgr, result.bytes, how))
        throw Error("a texture page of ", picture.extent(), " texels could not be encoded as ", result.mime_type);
    return result;
}

}  // namespace

EncodedPicture seen_mask(const Image<TexelState>& states) {
    constexpr uint32_t kBlock = 4;
    const Extent2D fine = states.extent();
    cv::Mat mask(static_cast<int>((fine.height + kBlock - 1) / kBlock),
                 static_cast<int>((fine.width + kBlock - 1) / kBlock), CV_8UC1);
    for (int row = 0; row < mask.rows; ++row) {
        for (int column = 0; column < mask.cols; ++column) {
            const uint32_t x0 = static_cast<uint32_t>(column) * kBlock, y0 = static_cast<uint32_t>(row) * kBlock;
            int filled = 0, seen = 0;
            for (uint32_t y = y0; y < std::min(y0 + kBlock, fine.height); ++y) {
                for (uint32_t x = x0; x < std::min(x0 + kBlock, fine.width); ++x) {
                    filled += states.at(x, y) == TexelState::kFilled;
                    seen += states.at(x, y) == TexelState::kSeen;
                }
            }
            mask.at<uchar>(row, column) = filled > 0 && filled >= seen ? 0 : 255;
        }
    }
    EncodedPicture result{"image/png", {}};
    if (!cv::imencode(".png", mask, result.bytes, {cv::IMWRITE_PNG_COMPRESSION, 9}))
        throw Error("a mask of ", fine, " texels could not be encoded");
    return result;
}

const char* extension_of(const EncodedPicture& picture) { return picture.mime_type == "image/png" ? ".png" : ".jpg"; }

EncodedPicture encoded(const Image<SrgbPixel>& picture) {
    if (picture.extent().area() > kMostOfPng) return encoded_as_jpeg(picture, kJpegQuality);
    return encoded_as_png(picture);
}

EncodedPicture encoded_as_png(const Image<SrgbPixel>& picture) {
    return encoded(picture, "image/png", {cv::IMWRITE_PNG_COMPRESSION, 6});
}

EncodedPicture encoded_as_jpeg(const Image<SrgbPixel>& picture, int quality) {
    return encoded(picture, "image/jpeg", {cv::IMWRITE_JPEG_QUALITY, quality});
}

Image<SrgbPixel> decoded(const EncodedPicture& picture) {
    cv::Mat bgr;
    try {
        bgr = cv::imdecode(picture.bytes, cv::IMREAD_COLOR);
    } catch (const cv::Exception& failure) {
        throw Error("a texture page cannot be decoded: ", failure.what());
    }
    if (bgr.empty()) throw Error("a texture page of ", picture.bytes.size(), " bytes cannot be decoded");
    Image<SrgbPixel> pixels({static_cast<uint32_t>(bgr.cols), static_cast<uint32_t>(bgr.rows)});
    for (int y = 0; y < bgr.rows; ++y) {
        for (int x = 0; x < bgr.cols; ++x) {
            const auto& pixel = bgr.at<cv::Vec3b>(y, x);
            pixels.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y)) = {pixel[2], pixel[1], pixel[0]};
        }
    }
    return pixels;
}

Image<SrgbPixel> halved(const Image<SrgbPixel>& fine) {
    Image<SrgbPixel> coarse({std::max(fine.extent().width / 2, 1u), std::max(fine.extent().height / 2, 1u)});
    for (uint32_t y = 0; y < coarse.extent().height; ++y) {
        for (uint32_t x = 0; x < coarse.extent().width; ++x) {
            glm::uvec3 sum(2);
            for (const auto& [i, k] : {std::pair(0u, 0u), {1u, 0u}, {0u, 1u}, {1u, 1u}}) {
                sum += glm::uvec3(fine.at(std::min(2 * x + i, fine.extent().width - 1),
                                          std::min(2 * y + k, fine.extent().height - 1)));
            }
            coarse.at(x, y) = SrgbPixel(sum / 4u);
        }
    }
    return coarse;
}

Image<glm::vec3> linear_page(const EncodedPicture& picture) {
    const Image<SrgbPixel> codes = decoded(picture);
    Image<glm::vec3> linear(codes.extent());
    std::ranges::transform(codes.pixels(), linear.pixels().begin(), linear_color);
    return linear;
}

glm::vec3 texel_at(const Image<glm::vec3>& page, glm::vec2 place) {
    const glm::ivec2 last(static_cast<int>(page.extent().width) - 1, static_cast<int>(page.extent().height) - 1);
    const glm::vec2 at = glm::clamp(place * glm::vec2(last + 1) - 0.5f, glm::vec2(0), glm::vec2(last));
    const glm::ivec2 low(at), high = glm::min(low + 1, last);
    const glm::vec2 part = at - glm::vec2(low);
    const auto texel = [&](int x, int y) { return page.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y)); };
    return glm::mix(glm::mix(texel(low.x, low.y), texel(high.x, low.y), part.x),
                    glm::mix(texel(low.x, high.y), texel(high.x, high.y), part.x), part.y);
}

}  // namespace patina
