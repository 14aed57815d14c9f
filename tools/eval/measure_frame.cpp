#include "tools/eval/measure_frame.h"

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "tools/eval/frame_channels.h"
#include "tools/eval/metrics.h"

namespace patina::eval {
namespace {

/// The pixels from first to last, both inclusive.
struct Box {
    glm::uvec2 first{~0u};
    glm::uvec2 last{0};

    Extent2D extent() const { return {last.x - first.x + 1, last.y - first.y + 1}; }
};

/// An object's region in a frame.
struct Region {
    Box box;
    uint64_t pixels = 0;
};

Image<uint8_t> validity(const ExrPlanes& frame) {
    Image<uint8_t> valid(frame.extent());
    const std::vector<float>& plane = frame.plane("valid");
    std::transform(plane.begin(), plane.end(), valid.pixels().begin(), [](float v) { return v > 0.5f ? 1 : 0; });
    return valid;
}

/// Labels as integers; 0 where a frame is not valid or its label is no number from 1 on.
Image<uint32_t> labels_in(const ExrPlanes& frame, const Image<uint8_t>& valid) {
    constexpr float kMost = 1 << 24;  // beyond, floats skip integers
    Image<uint32_t> labels(frame.extent());
    const std::vector<float>& plane = frame.plane("label");
    for (size_t i = 0; i < plane.size(); ++i) {
        const bool labelled = valid.pixels()[i] && plane[i] >= 1 && plane[i] <= kMost;
        labels.pixels()[i] = labelled ? static_cast<uint32_t>(std::lround(plane[i])) : 0;
    }
    return labels;
}

void expect_finite(const ExrPlanes& truth, const Image<uint8_t>& valid) {
    for (const auto& [channel, plane] : truth.planes()) {
        for (size_t i = 0; i < plane.size(); ++i) {
            if (!valid.pixels()[i] || std::isfinite(plane[i])) continue;
            const size_t width = truth.extent().width;
            throw Error(truth.file(), ": channel ", channel, " is ", plane[i], " at pixel (", i % width, ", ",
                        i / width, "), must be finite where valid");
        }
    }
}

std::map<uint32_t, Region> regions_in(const Image<uint32_t>& objects) {
    std::map<uint32_t, Region> regions;
    for (uint32_t y = 0; y < objects.extent().height; ++y) {
        for (uint32_t x = 0; x < objects.extent().width; ++x) {
            const uint32_t id = objects.at(x, y);
            if (id == 0) continue;
            Region& region = regions[id];
            region.box.first = glm::min(region.box.first, glm::uvec2(x, y));
            region.box.last = glm::max(region.box.last, glm::uvec2(x, y));
            ++region.pixels;
        }
    }
    return regions;
}

template <class Pixel>
Image<Pixel> cropped(const std::vector<Pixel>& plane, Extent2D extent, const Box& box) {
    Image<Pixel> part(box.extent());
    for (uint32_t y = 0; y < part.extent().height; ++y) {
        const auto row =
            plane.begin() + static_cast<std::ptrdiff_t>(size_t{box.first.y + y} * extent.width + box.first.x);
        std::copy_n(row, part.extent().width, &part.at(0, y));
    }
    return part;
}

/// Two frames and what is read from them once.
struct ComparedFrames {
    const ExrPlanes& truth;
    const ExrPlanes& run;
    Image<uint8_t> truth_valid;
    Image<uint8_t> run_valid;
    Image<uint32_t> objects;
    const Image<uint8_t>& seen;  ///< empty: everywhere
};

std::vector<Image<float>> cropped_channels(const ExrPlanes& frame, const std::string& group, const Box& box,
                                           bool displayed) {
    std::vector<Image<float>> channels;
    for (const std::string& name : channel_names(group)) {
        Image<float>& channel = channels.emplace_back(cropped(frame.plane(name), frame.extent(), box));
        if (!displayed) continue;
        for (float& value : channel.pixels()) {
            // What is not finite stays so, and counts as unfilled.
            if (std::isfinite(value)) value = std::clamp(value, 0.0f, 1.0f);
        }
    }
    return channels;
}

ObjectPictures pictures_of(const ComparedFrames& frames, uint32_t object, const Box& box,
                           const QuantityChannels& channels) {
    ObjectPictures pictures;
    const Image<uint32_t> objects = cropped(frames.objects.pixels(), frames.objects.extent(), box);
    pictures.region = Image<uint8_t>(box.extent());
    std::transform(objects.pixels().begin(), objects.pixels().end(), pictures.region.pixels().begin(),
                   [&](uint32_t id) { return id == object ? 1 : 0; });
    pictures.truth = cropped_channels(frames.truth, channels.truth, box, channels.displayed);
    pictures.run = cropped_channels(frames.run, channels.run, box, channels.displayed);
    pictures.is_rgb = channels.displayed;
    pictures.filled = cropped(frames.run_valid.pixels(), frames.run_valid.extent(), box);
    for (size_t i = 0; i < box.extent().area(); ++i) {
        uint8_t& filled = pictures.filled.pixels()[i];
        filled &= pictures.region.pixels()[i];
        for (const Image<float>& channel : pictures.run) filled &= std::isfinite(channel.pixels()[i]) ? 1 : 0;
    }
    if (!frames.seen.empty()) {
        pictures.seen = cropped(frames.seen.pixels(), frames.seen.extent(), box);
        for (size_t i = 0; i < box.extent().area(); ++i) pictures.seen.pixels()[i] &= pictures.filled.pixels()[i];
    }
    return pictures;
}

FramePoint measure_object(uint32_t index, const ObjectPictures& pictures) {
    return {index, mean_over(pictures.region, pictures.truth).value(), mean_over(pictures.filled, pictures.run),
            compare(pictures)};
}

/// By object.
std::map<uint32_t, uint64_t> seen_pixels_of(const ComparedFrames& frames) {
    std::map<uint32_t, uint64_t> seen;
    for (size_t i = 0; i < frames.objects.pixels().size(); ++i)
        seen[frames.objects.pixels()[i]] += frames.seen.empty() ? 1 : frames.seen.pixels()[i];
    return seen;
}

void measure_objects(uint32_t index, const ComparedFrames& frames, FrameMeasurement& result) {
    const std::set<std::string> groups = groups_of(frames.run);
    std::map<uint32_t, uint64_t> seen = seen_pixels_of(frames);
    for (const auto& [id, region] : regions_in(frames.objects)) {
        ObjectMeasurement& object = result.objects[id];
        object.pixels = region.pixels;
        object.seen_pixels = seen[id];
        if (region.pixels < kSmallestRegion) continue;
        for (const Quantity quantity : kQuantities) {
            const QuantityChannels channels = channels_for(quantity);
            if (!groups.contains(channels.run)) continue;
            object.points[quantity] = measure_object(index, pictures_of(frames, id, region.box, channels));
        }
    }
}

void measure_labels(const ComparedFrames& frames, LabelOverlap& overlap) {
    const Image<uint32_t> labels = labels_in(frames.run, frames.run_valid);
    const std::vector<uint32_t>&objects = frames.objects.pixels(), &of_run = labels.pixels();
    for (size_t begin = 0, end = 0; begin < objects.size(); begin = end) {
        while (end < objects.size() && objects[end] == objects[begin] && of_run[end] == of_run[begin]) ++end;
        overlap.add(objects[begin], of_run[begin], end - begin);
    }
}

std::vector<float> depth_errors_mm(const ComparedFrames& frames) {
    const std::vector<float>&truth_m = frames.truth.plane("depth"), &run_m = frames.run.plane("depth");
    std::vector<float> errors;
    for (size_t i = 0; i < truth_m.size(); ++i) {
        const bool valid = frames.truth_valid.pixels()[i] && frames.run_valid.pixels()[i] && std::isfinite(run_m[i]);
        if (valid) errors.push_back(1000 * std::abs(run_m[i] - truth_m[i]));
    }
    return errors;
}

double angle_deg(glm::dvec3 a, glm::dvec3 b) {
    // Exact for small angles, where the cosine is flat.
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

/// The three planes of a frame's normals.
struct Normals {
    explicit Normals(const ExrPlanes& frame)
        : x(frame.plane("normal.X")), y(frame.plane("normal.Y")), z(frame.plane("normal.Z")) {}
    glm::dvec3 at(size_t pixel) const { return {x[pixel], y[pixel], z[pixel]}; }

    const std::vector<float>&x, &y, &z;
};

std::vector<float> normal_errors_deg(const ComparedFrames& frames, const glm::dmat3& truth_from_run) {
    const Normals truth(frames.truth), run(frames.run);
    std::vector<float> errors;
    for (size_t i = 0; i < frames.truth.extent().area(); ++i) {
        if (!frames.truth_valid.pixels()[i] || !frames.run_valid.pixels()[i]) continue;
        const glm::dvec3 of_run = run.at(i);
        const double length = glm::length(of_run);
        if (!(length > 0 && std::isfinite(length))) continue;
        errors.push_back(static_cast<float>(angle_deg(truth.at(i), truth_from_run * of_run)));
    }
    return errors;
}

}  // namespace

FrameMeasurement measure_frame(uint32_t index, const ExrPlanes& truth, const ExrPlanes& run, const Image<uint8_t>& seen,
                               const glm::dmat3& truth_from_run) {
    ComparedFrames frames{truth, run, validity(truth), validity(run), {}, seen};
    expect_finite(truth, frames.truth_valid);
    frames.objects = labels_in(truth, frames.truth_valid);
    FrameMeasurement result;
    const std::vector<uint8_t>& valid = frames.truth_valid.pixels();
    result.truth_pixels = static_cast<uint64_t>(std::count(valid.begin(), valid.end(), 1));
    measure_objects(index, frames, result);
    const std::set<std::string> groups = groups_of(run);
    if (groups.contains("label")) measure_labels(frames, result.overlap);
    if (groups.contains("depth")) result.depth_errors_mm = depth_errors_mm(frames);
    if (groups.contains("normal")) result.normal_errors_deg = normal_errors_deg(frames, truth_from_run);
    return result;
}

}  // namespace patina::eval
