#include "tools/run/held_out.h"

#include <algorithm>

#include <fmt/format.h>

#include "engine/core/srgb.h"
#include "tools/report/drawing.h"
#include "tools/report/previews.h"
#include "tools/run/frame_dumps.h"

namespace patina::tools {

namespace {

Image<glm::vec3> linear_of(const ColorImage& color) {
    if (const auto* linear = std::get_if<Image<glm::vec3>>(&color)) return *linear;
    const auto& encoded = std::get<Image<SrgbPixel>>(color);
    Image<glm::vec3> linear(encoded.extent());
    std::transform(encoded.pixels().begin(), encoded.pixels().end(), linear.pixels().begin(), linear_color);
    return linear;
}

/// What a pinhole camera would have seen, each pixel the nearest of the picture's; black beyond its border.
Image<glm::vec3> undistorted(Image<glm::vec3> picture, const Intrinsics& camera) {
    if (!camera.distorted()) return picture;
    Image<glm::vec3> pinhole(picture.extent());
    for (uint32_t y = 0; y < picture.extent().height; ++y) {
        for (uint32_t x = 0; x < picture.extent().width; ++x) {
            const glm::dvec3 ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1);
            const glm::ivec2 source(glm::floor(project(camera, ray) + 0.5));
            if (!picture.extent().contains(source.x, source.y)) continue;
            pinhole.at(x, y) = picture.at(static_cast<uint32_t>(source.x), static_cast<uint32_t>(source.y));
        }
    }
    return pinhole;
}

/// A model's colours as the camera would have recorded them.
Image<glm::vec4> at_gain(Image<glm::vec4> colors, glm::vec3 gain) {
    for (glm::vec4& pixel : colors.pixels()) pixel *= glm::vec4(gain, 1);
    return colors;
}

std::string line_of(const PictureScore& score) {
    return fmt::format(" {:.4f} {:.3f} {:.3f}", score.coverage, score.psnr_linear_db, score.psnr_srgb_db);
}

/// Of all pictures, as they are rendered, and with a gain that brings each nearest to the picture.
struct Scores {
    std::vector<PictureScore> plain, own_gain;

    /// Returns both as text.
    std::string add(const Image<glm::vec3>& seen, const Image<glm::vec4>& predicted) {
        plain.push_back(score_picture(seen, predicted));
        own_gain.push_back(score_picture(seen, at_gain(predicted, gain_between(seen, predicted))));
        return line_of(plain.back()) + line_of(own_gain.back());
    }
};

}  // namespace

void HeldOut::keep(const Frame& frame, uint32_t order) {
    kept_.push_back({frame.index, order, frame.color, *frame.world_from_camera});
}

void HeldOut::keep_first(size_t pictures) {
    if (pictures < kept_.size()) kept_.erase(kept_.begin() + static_cast<std::ptrdiff_t>(pictures), kept_.end());
}

void HeldOut::visit(graph::StateVisitor& visitor) {
    struct Picture {
        uint32_t index, order;
        Extent2D extent;
        RigidTransform world_from_depth;
        bool linear;
    };
    std::vector<Picture> pictures;
    for (const Kept& kept : kept_) {
        const auto extent = std::visit([](const auto& image) { return image.extent(); }, kept.color);
        const bool linear = std::holds_alternative<Image<glm::vec3>>(kept.color);
        pictures.push_back({kept.index, kept.order, extent, kept.world_from_depth, linear});
    }
    visitor.values("run.held_out", pictures);
    kept_.resize(pictures.size());
    for (size_t i = 0; i < pictures.size(); ++i) {
        const Picture& picture = pictures[i];
        Kept& kept = kept_[i];
        kept.index = picture.index;
        kept.order = picture.order;
        kept.world_from_depth = picture.world_from_depth;
        const auto visit_pixels = [&]<class Pixel>(Image<Pixel> empty) {
            auto* held = std::get_if<Image<Pixel>>(&kept.color);
            std::vector<Pixel> pixels = held ? held->pixels() : empty.pixels();
            visitor.values(fmt::format("run.held_out_{}", picture.index), pixels);
            kept.color = Image<Pixel>(picture.extent, std::move(pixels));
        };
        if (picture.linear) {
            visit_pixels(Image<glm::vec3>());
        } else {
            visit_pixels(Image<SrgbPixel>());
        }
    }
}

HeldOutSummary HeldOut::compare(Pipeline& pipeline, const SequenceInfo& info, OutputFolder& folder) const {
    pipeline.wait();
    const std::span<const gpu::ColorGains> gains = pipeline.gains();
    Scores mean_color, reflectance, records;
    std::string lines =
        "# index; coverage, PSNR linear and PSNR sRGB in dB of the mean colour; the same with a gain of the picture's "
        "own; then both of the re-rendering; then both of the re-rendering by records alone\n";
    for (const Kept& kept : kept_) {
        const ViewReadback pending =
            pipeline.view(info.color, kept.world_from_depth * rigid_inverse(info.color_from_depth));
        pipeline.wait();
        ModelView view = pending.get();
        // Of the frame that was fused before it: this one has no part in gains, either.
        const glm::vec3 gain = kept.order < gains.size() ? glm::vec3(gains[kept.order].gain) : glm::vec3(1);
        const Image<glm::vec3> seen = undistorted(linear_of(kept.color), info.color);
        view.color = at_gain(std::move(view.color), gain);
        lines += std::to_string(kept.index) + mean_color.add(seen, view.color);
        if (view.reflectance) {
            view.reflectance->rgb = at_gain(std::move(view.reflectance->rgb), gain);
            lines += reflectance.add(seen, view.reflectance->rgb);
            lines += records.add(seen, at_gain(std::move(view.reflectance->model_rgb), gain));
        }
        lines += '\n';
        folder.write(fmt::format("held_out/{:06}.png", kept.index),
                     preview_png(seen, to_dump(view), {.title = fmt::format("frame {}, held out", kept.index)}));
    }
    folder.write("held_out/scores.txt", lines);
    HeldOutSummary summary{kept_.size(), median_of(mean_color.plain), {}, median_of(mean_color.own_gain), {}};
    if (!reflectance.plain.empty()) {
        summary.reflectance = median_of(reflectance.plain);
        summary.reflectance_own_gain = median_of(reflectance.own_gain);
        summary.records = median_of(records.plain);
    }
    return summary;
}

}  // namespace patina::tools
