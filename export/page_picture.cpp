#include "export/page_picture.h"

#include <cmath>

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

Image<SrgbPixel> page_picture(const TexturePage& page, const std::vector<TextureBox>& boxes, uint32_t number,
                              const std::function<float(uint32_t)>& factor_of) {
    Level colors{page.kd.extent(), std::vector<glm::vec4>(page.kd.extent().area(), glm::vec4(0))};
    for (const TextureBox& box : boxes) {
        if (box.page != number) continue;
        const float factor = factor_of(box.label);
        for (uint32_t y = box.low.y; y < box.high.y; ++y) {
            for (uint32_t x = box.low.x; x < box.high.x; ++x) {
                if (page.states.at(x, y) == TexelState::kEmpty) continue;
                colors.colors[size_t{y} * colors.extent.width + x] = glm::vec4(factor * page.kd.at(x, y), 1);
            }
        }
    }
    fill_gaps(colors);
    const SrgbTable table;
    Image<SrgbPixel> picture(colors.extent);
    for (size_t i = 0; i < colors.colors.size(); ++i) picture.pixels()[i] = table.of(glm::vec3(colors.colors[i]));
    return picture;
}

EncodedPicture encoded(const Image<SrgbPixel>& picture) {
    const auto width = static_cast<int>(picture.extent().width), height = static_cast<int>(picture.extent().height);
    cv::Mat bgr(height, width, CV_8UC3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const SrgbPixel pixel = picture.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
            bgr.at<cv::Vec3b>(y, x) = {pixel.b, pixel.g, pixel.r};
        }
    }
    const bool png = picture.extent().area() <= kMostOfPng;
    EncodedPicture result{png ? "image/png" : "image/jpeg", {}};
    const std::vector<int> how = png ? std::vector<int>{cv::IMWRITE_PNG_COMPRESSION, 6}
                                     : std::vector<int>{cv::IMWRITE_JPEG_QUALITY, kJpegQuality};
    if (!cv::imencode(png ? ".png" : ".jpg", bgr, result.bytes, how))
        throw Error("a texture page of ", picture.extent(), " texels could not be encoded as ", result.mime_type);
    return result;
}

}  // namespace patina
