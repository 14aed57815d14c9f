#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/graph/frame_graph.h"
#include "engine/vulkan/device.h"
#include "patina/camera.h"
#include "shared/kinect2/infrared.h"

namespace patina::kinect2 {

inline constexpr Extent2D kInfraredExtent{gpu::kInfraredWidth, gpu::kInfraredHeight};

/// How colour pixels follow from depth pixels: two cubic polynomials in ((x - cx) / 100, (y - cy) / 100) of the
/// undistorted depth picture. The factors are those of x^3, y^3, x^2 y, x y^2, x^2, y^2, x y, x, y, 1.
struct ColorPolynomials {
    double f = 0, cx = 0, cy = 0;  ///< pixels of the 1920 x 1080 picture
    double shift_d = 0;            ///< nominal depth, mm
    double shift_m = 0;            ///< distance of the two cameras, mm
    std::array<double, 10> mx{}, my{};
};

/// What one Kinect v2 knows of itself, for pictures as it sends them: mirrored left to right.
struct CameraModel {
    /// 512 x 424, with its lens distortion. The device counts pixels from the corner of the top left pixel, Intrinsics
    /// from its centre: cx and cy are half a pixel less than the device's.
    Intrinsics depth;
    ColorPolynomials color;
    /// Phase offsets at 80, 16 and 120 MHz in units of 1 / 65536 turn: 512 x 424 each, rows from the top. They hold for
    /// one run of the stream.
    std::array<std::vector<uint16_t>, 3> p0;
};

/// What the shaders look up by pixel; computed in double precision, so that all devices start from the same numbers.
struct HostTables {
    Image<glm::vec4> offsets_ab;     ///< cos, sin of the phase offset at 80 MHz; the same at 16 MHz
    Image<glm::vec4> offsets_c_ray;  ///< cos, sin at 120 MHz; x of the pixel's undistorted ray at z = 1; mm along z at
                                     ///< a mean of one cycle, 0 where the lens model has no ray
    Image<uint32_t> sources;         ///< of each undistorted pixel: the nearest one of the sensor, x | y << 16
    Image<float> place_x, place_y;   ///< of each undistorted pixel at infinity: its place in the colour picture
    float shift_px_m = 0;            ///< times 1 / z: what the distance adds to the column
    Intrinsics depth;                ///< the pinhole camera of undistorted pixels
};

/// The tables of one camera; `sources` and all that follows belong to pictures that are mirrored back, as the world
/// is. Throws Error where a table of phase offsets does not have 512 x 424 entries or the camera has no focal length.
HostTables make_tables(const CameraModel& model);

/// Versions of the tables' images within one frame; formats as in HostTables.
struct TableIds {
    graph::ImageId offsets_ab, offsets_c_ray, sources, place_x, place_y;
};

/// A camera's tables on the device. They live as long as the stream whose phase offsets they hold.
class Tables {
  public:
    /// Throws Error as make_tables(), and when memory runs out. `device` outlives it.
    Tables(vulkan::Device& device, const CameraModel& model);

    /// Uploads the tables the first time.
    TableIds import(graph::FrameGraph& frame);

    const HostTables& host() const { return host_; }

  private:
    HostTables host_;
    vulkan::ImageRef offsets_ab_, offsets_c_ray_, sources_, place_x_, place_y_;
    bool uploaded_ = false;
};

}  // namespace patina::kinect2
