#pragma once

#include <vector>

#include "passes/kinect2/measure_phases.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/kinect2/sensor.h"
#include "tests/reference/kinect2/decode.h"

namespace patina {

/// What add_unwrap_phases returned.
struct Readings {
    Image<float> depth_mm, amplitude, infrared;
    Image<uint8_t> even;  ///< 0 where the phases around a pixel disagree
};

/// A camera's tables on the device, and images that go there and back.
class Kinect2Test : public GpuTest {
  protected:
    static const kinect2::CameraModel& model() {
        static const kinect2::CameraModel kModel = test_camera();
        return kModel;
    }
    kinect2::Tables& tables() { return tables_; }

    static graph::ImageId upload(graph::FrameGraph& frame, const char* name, const std::vector<glm::vec4>& pixels) {
        return frame.upload(name, {kinect2::kInfraredExtent, vulkan::Format::kRgba32f},
                            std::as_bytes(std::span(pixels)));
    }

    static kinect2::PhasorIds upload(graph::FrameGraph& frame, const reference::kinect2::Phasors& phasors) {
        std::vector<glm::vec4> ab, c;
        for (size_t i = 0; i < kinect2::kInfraredExtent.area(); ++i) {
            const glm::dvec2 pixel[] = {phasors[0].pixels()[i], phasors[1].pixels()[i], phasors[2].pixels()[i]};
            ab.emplace_back(pixel[0].x, pixel[0].y, pixel[1].x, pixel[1].y);
            c.emplace_back(pixel[2].x, pixel[2].y, 0, 0);
        }
        return {upload(frame, "phasors_ab", ab), upload(frame, "phasors_c", c)};
    }

    static graph::ImageId upload(graph::FrameGraph& frame, const reference::kinect2::Unwrapped& readings,
                                 const Image<uint8_t>& even) {
        std::vector<glm::vec4> pixels;
        for (size_t i = 0; i < even.pixels().size(); ++i) {
            const double amplitude = readings.amplitude.pixels()[i];
            pixels.emplace_back(readings.depth_mm.pixels()[i], even.pixels()[i] != 0 ? amplitude : -amplitude, i, 0);
        }
        return upload(frame, "readings", pixels);
    }

    static Readings readings_of(const graph::Readback& image) {
        const auto pixels = image.as<glm::vec4>();
        const Image<float> empty(kinect2::kInfraredExtent);
        Readings readings{empty, empty, empty, Image<uint8_t>(kinect2::kInfraredExtent)};
        for (size_t i = 0; i < pixels.size(); ++i) {
            readings.depth_mm.pixels()[i] = pixels[i].x;
            readings.amplitude.pixels()[i] = std::abs(pixels[i].y);
            readings.even.pixels()[i] = pixels[i].y >= 0;
            readings.infrared.pixels()[i] = pixels[i].z;
        }
        return readings;
    }

    static reference::kinect2::Phasors constant_phasors(glm::dvec2 phasor) {
        reference::kinect2::Phasors phasors;
        phasors.fill(Image<glm::dvec2>(kinect2::kInfraredExtent, phasor));
        return phasors;
    }

  private:
    kinect2::Tables tables_{device(), model()};
};

/// The share of pixels that are valid in one of two depth pictures alone.
template <class A, class B>
double differing_validity(const Image<A>& a, const Image<B>& b) {
    size_t differing = 0;
    for (size_t i = 0; i < a.pixels().size(); ++i) differing += (a.pixels()[i] > 0) != (b.pixels()[i] > 0);
    return static_cast<double>(differing) / static_cast<double>(a.pixels().size());
}

/// The largest difference of depths where both pictures have one.
template <class A, class B>
double largest_difference(const Image<A>& a, const Image<B>& b) {
    double largest = 0;
    for (size_t i = 0; i < a.pixels().size(); ++i) {
        if (a.pixels()[i] > 0 && b.pixels()[i] > 0)
            largest = std::max(largest, std::abs(static_cast<double>(a.pixels()[i]) - b.pixels()[i]));
    }
    return largest;
}

/// The share of pixels that are valid.
template <class T>
double valid_share(const Image<T>& picture) {
    size_t valid = 0;
    for (const T value : picture.pixels()) valid += value > 0;
    return static_cast<double>(valid) / static_cast<double>(picture.pixels().size());
}

}  // namespace patina
