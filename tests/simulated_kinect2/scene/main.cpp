// kinect2_scene SCENE FRAMES FOLDER [SLOWER]: what the simulated Kinect v2 sees of a synthetic scene along its path, as
// the stand-in for libusb sends it: FOLDER/infrared.bin, FOLDER/color/NNNNNN.jpg, and FOLDER/trajectory.txt with the
// true poses of the depth camera at 30 frames a second. FOLDER/lights.json has the scene's lamps as the depth camera of
// the first frame sees them, which is the world of a camera that is tracked from there. SLOWER: the camera moves so
// many times slower along its path.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "cameras/kinect2_decoder.h"
#include "engine/vulkan/device.h"
#include "export/trajectory.h"
#include "scenes/files/scene_file.h"
#include "scenes/kinect2/infrared_frame.h"
#include "scenes/render/synthetic_source.h"
#include "sensor/truth.h"
#include "tests/simulated_kinect2/pages.h"

namespace patina::testing {
namespace {

namespace fs = std::filesystem;

constexpr double kWhiteAmplitude = 8000;      // of a white surface at 1 m
constexpr double kReflectance = 0.5;          // of all surfaces, in infrared
constexpr double kFloor = 25, kPhotons = 1;   // of the noise of measurements
constexpr Extent2D kRendered{960, 540};       // a quarter of the colour picture's pixels
constexpr double kRenderedFocalShare = 0.95;  // shows a little more than the distorted picture

/// The colour camera without its distortion, for the renderer.
Intrinsics pinhole_of(const Intrinsics& color) {
    const double scale = static_cast<double>(kRendered.width) / color.extent.width;
    Intrinsics pinhole = scaled_to(color, kRendered);
    pinhole.fx = color.fx * scale * kRenderedFocalShare;
    pinhole.fy = color.fy * scale * kRenderedFocalShare;
    pinhole.distortion = {};
    return pinhole;
}

/// Where each pixel of the colour picture, mirrored as the camera sends it, is in the rendered one.
cv::Mat2f places_of(const Intrinsics& color, const Intrinsics& pinhole) {
    const cv::Matx33d matrix(color.fx, 0, color.cx, 0, color.fy, color.cy, 0, 0, 1),
        rendered(pinhole.fx, 0, pinhole.cx, 0, pinhole.fy, pinhole.cy, 0, 0, 1);
    const cv::Mat distortion(1, static_cast<int>(color.distortion.size()), CV_64F,
                             const_cast<double*>(color.distortion.data()));
    std::vector<cv::Point2f> pixels, places;
    for (uint32_t y = 0; y < color.extent.height; ++y)
        for (uint32_t x = 0; x < color.extent.width; ++x)
            pixels.emplace_back(static_cast<float>(color.extent.width - 1 - x), static_cast<float>(y));
    cv::undistortPoints(pixels, places, matrix, distortion, cv::noArray(), rendered);
    return cv::Mat2f(static_cast<int>(color.extent.height), static_cast<int>(color.extent.width),
                     reinterpret_cast<cv::Vec2f*>(places.data()))
        .clone();
}

class SceneFrames {
  public:
    explicit SceneFrames(fs::path folder)
        : folder_(std::move(folder)),
          model_(cameras::camera_model(sensor::kinect2::testing::simulated_calibration())),
          info_(cameras::kinect2_info(model_, "")) {
        fs::create_directories(folder_ / "color");
        infrared_.open(folder_ / "infrared.bin", std::ios::binary);
        const Intrinsics pinhole = pinhole_of(info_.color);
        color_ = {pinhole, info_.color_from_depth};
        places_ = places_of(info_.color, pinhole);
    }

    const Intrinsics& depth_camera() const { return info_.depth; }
    const scenes::ColorCamera& color_camera() const { return color_; }

    void write(const Frame& frame, double metres_per_unit, const RigidTransform& pose) {
        write_infrared(std::get<Image<uint16_t>>(frame.depth), metres_per_unit, frame.index);
        write_color(std::get<Image<SrgbPixel>>(frame.color), frame.index);
        trajectory_.push_back({frame.index / 30.0, pose});
    }

    const std::vector<TimedPose>& trajectory() const { return trajectory_; }
    void finish() { std::ofstream(folder_ / "trajectory.txt") << trajectory_text(trajectory_); }

  private:
    void write_infrared(const Image<uint16_t>& units, double metres_per_unit, uint32_t index) {
        Image<float> picture(units.extent());
        std::ranges::transform(units.pixels(), picture.pixels().begin(),
                               [&](uint16_t unit) { return static_cast<float>(unit * metres_per_unit); });
        const Image<float> depth_m = scenes::kinect2::as_transmitted(model_.depth, picture, info_.depth);
        const Image<float> amplitude = scenes::kinect2::lit_amplitude(
            depth_m, Image<float>(depth_m.extent(), static_cast<float>(kReflectance)), kWhiteAmplitude);
        const std::vector<uint8_t> bytes =
            scenes::kinect2::infrared_frame({model_.depth, model_.p0}, {depth_m, amplitude}, {kFloor, kPhotons, index});
        infrared_.write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
    }

    void write_color(const Image<SrgbPixel>& rendered, uint32_t index) {
        const auto* pixels = reinterpret_cast<const uint8_t*>(rendered.pixels().data());
        const cv::Mat rgb(static_cast<int>(kRendered.height), static_cast<int>(kRendered.width), CV_8UC3,
                          const_cast<uint8_t*>(pixels));
        cv::Mat picture, bgr;
        cv::remap(rgb, picture, places_, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
        cv::cvtColor(picture, bgr, cv::COLOR_RGB2BGR);
        cv::imwrite(folder_ / "color" / fmt::format("{:06}.jpg", index), bgr, {cv::IMWRITE_JPEG_QUALITY, 90});
    }

    fs::path folder_;
    patina::kinect2::CameraModel model_;
    SequenceInfo info_;
    scenes::ColorCamera color_;
    cv::Mat2f places_;
    std::ofstream infrared_;
    std::vector<TimedPose> trajectory_;
};

void write_frames(const std::string& name, uint32_t frames, const fs::path& folder, double slower) {
    SceneFrames out(folder);
    scenes::SyntheticScene scene = scenes::load_scene(name);
    scene.fps *= slower;
    scene.camera = out.depth_camera();
    scene.color_camera = out.color_camera();
    std::vector<Light> lights = scene.lights;
    vulkan::Device device;
    scenes::SyntheticSource source(device, std::move(scene), {.frames = frames});
    while (const auto reading = source.next())
        out.write(std::get<Frame>(*reading), source.info().metres_per_unit, source.truth().world_from_camera);
    out.finish();
    const RigidTransform camera_from_world = rigid_inverse(out.trajectory().front().world_from_camera);
    for (Light& light : lights) light.position_m = glm::dvec3(camera_from_world * glm::dvec4(light.position_m, 1));
    sensor::write_lights(folder / "lights.json", lights);
}

}  // namespace
}  // namespace patina::testing

int main(int count, char** arguments) {
    if (count != 4 && count != 5) {
        std::fputs("usage: kinect2_scene SCENE FRAMES FOLDER [SLOWER]\n", stderr);
        return 2;
    }
    try {
        patina::testing::write_frames(arguments[1], static_cast<uint32_t>(std::atoi(arguments[2])), arguments[3],
                                      count == 5 ? std::atof(arguments[4]) : 1);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
