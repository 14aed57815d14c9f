#include "passes/kinect2/tables.h"

#include <cmath>
#include <numbers>

#include "engine/core/error.h"
#include "engine/core/undistort.h"
#include "shared/kinect2/register_color.h"

namespace patina::kinect2 {

namespace {

using vulkan::Format;

/// The polynomials' unit of depth pixels and of colour pixels; the device's own (libfreenect2, registration.cpp).
constexpr double kDepthUnit = 0.01, kColorUnit = 0.002199;

void check(const CameraModel& model) {
    const Intrinsics& depth = model.depth;
    if (depth.extent != kInfraredExtent)
        throw Error("a Kinect v2's depth camera has ", kInfraredExtent, " pixels, not ", depth.extent);
    if (!(depth.fx > 0 && depth.fy > 0))
        throw Error("a Kinect v2's depth camera has focal lengths without use: ", depth.fx, " and ", depth.fy);
    if (!(model.color.f > 0 && model.color.shift_d > 0))
        throw Error("a Kinect v2's colour camera has a focal length of ", model.color.f, " and a nominal depth of ",
                    model.color.shift_d, " mm, but both must be positive");
    for (const auto& offsets : model.p0) {
        if (offsets.size() != kInfraredExtent.area())
            throw Error("a table of phase offsets has ", offsets.size(), " entries, not ", kInfraredExtent.area());
    }
}

glm::dvec2 cos_sin(uint16_t offset) {
    const double angle = -2 * std::numbers::pi * offset / 65536;
    return {std::cos(angle), std::sin(angle)};
}

double cubic(const std::array<double, 10>& c, double u, double v) {
    return c[0] * u * u * u + c[1] * v * v * v + c[2] * u * u * v + c[3] * u * v * v + c[4] * u * u + c[5] * v * v +
           c[6] * u * v + c[7] * u + c[8] * v + c[9];
}

void fill_phases(const CameraModel& model, HostTables& tables) {
    const Intrinsics& camera = model.depth;
    for (uint32_t y = 0; y < camera.extent.height; ++y) {
        for (uint32_t x = 0; x < camera.extent.width; ++x) {
            const size_t i = size_t{y} * camera.extent.width + x;
            const glm::dvec2 a = cos_sin(model.p0[0][i]), b = cos_sin(model.p0[1][i]), c = cos_sin(model.p0[2][i]);
            const auto ray = undistort(camera, {(x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy});
            const double per_cycle = ray ? gpu::kUnambiguous / std::sqrt(glm::dot(*ray, *ray) + 1) : 0;
            tables.offsets_ab.pixels()[i] = glm::vec4(a.x, a.y, b.x, b.y);
            tables.offsets_c_ray.pixels()[i] = glm::vec4(c.x, c.y, ray ? ray->x : 0, per_cycle);
        }
    }
}

/// Where the sensor saw what an undistorted pixel shows, both as transmitted.
uint32_t source_of(const Intrinsics& camera, uint32_t x, uint32_t y) {
    const glm::dvec2 at = project(camera, {(x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1});
    const auto column = static_cast<int>(std::floor(at.x + 0.5)), row = static_cast<int>(std::floor(at.y + 0.5));
    if (!camera.extent.contains(column, row)) return gpu::kNoSource;
    return static_cast<uint32_t>(column) | static_cast<uint32_t>(row) << 16;
}

/// The place in the colour picture, as transmitted, of an infinitely far depth pixel. The polynomials take the device's
/// pixel coordinates, half a pixel from those of Intrinsics, as whole numbers.
glm::dvec2 place_of(const CameraModel& model, uint32_t x, uint32_t y) {
    const ColorPolynomials& color = model.color;
    const double u = (x - (model.depth.cx + 0.5)) * kDepthUnit, v = (y - (model.depth.cy + 0.5)) * kDepthUnit;
    const double rx = cubic(color.mx, u, v) / (color.f * kColorUnit) - color.shift_m / color.shift_d;
    return {rx * color.f + color.cx, cubic(color.my, u, v) / kColorUnit + color.cy};
}

void fill_places(const CameraModel& model, HostTables& tables) {
    const Extent2D extent = kInfraredExtent;
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            const uint32_t mirrored = extent.width - 1 - x;
            const glm::dvec2 place = place_of(model, x, y);
            tables.sources.at(mirrored, y) = source_of(model.depth, x, y);
            tables.place_x.at(mirrored, y) = static_cast<float>(gpu::kColorWidth - 1 - place.x);
            tables.place_y.at(mirrored, y) = static_cast<float>(place.y);
        }
    }
    tables.shift_px_m = static_cast<float>(-0.001 * model.color.shift_m * model.color.f);
}

}  // namespace

HostTables make_tables(const CameraModel& model) {
    check(model);
    HostTables tables;
    tables.offsets_ab = tables.offsets_c_ray = Image<glm::vec4>(kInfraredExtent);
    tables.sources = Image<uint32_t>(kInfraredExtent);
    tables.place_x = tables.place_y = Image<float>(kInfraredExtent);
    fill_phases(model, tables);
    fill_places(model, tables);
    tables.depth = model.depth;
    tables.depth.cx = kInfraredExtent.width - 1 - model.depth.cx;
    tables.depth.distortion = {};
    return tables;
}

Tables::Tables(vulkan::Device& device, const CameraModel& model)
    : host_(make_tables(model)),
      offsets_ab_(device.create_image({"kinect2.offsets_ab", kInfraredExtent, Format::kRgba32f})),
      offsets_c_ray_(device.create_image({"kinect2.offsets_c_ray", kInfraredExtent, Format::kRgba32f})),
      sources_(device.create_image({"kinect2.sources", kInfraredExtent, Format::kR32u})),
      place_x_(device.create_image({"kinect2.place_x", kInfraredExtent, Format::kR32f})),
      place_y_(device.create_image({"kinect2.place_y", kInfraredExtent, Format::kR32f})) {}

TableIds Tables::import(graph::FrameGraph& frame) {
    TableIds ids{frame.import(offsets_ab_), frame.import(offsets_c_ray_), frame.import(sources_),
                 frame.import(place_x_), frame.import(place_y_)};
    if (uploaded_) return ids;
    const auto upload = [&](graph::ImageId& id, const auto& table) {
        id = frame.upload(id, std::as_bytes(std::span(table.pixels())));
        frame.keep(id);
    };
    upload(ids.offsets_ab, host_.offsets_ab);
    upload(ids.offsets_c_ray, host_.offsets_c_ray);
    upload(ids.sources, host_.sources);
    upload(ids.place_x, host_.place_x);
    upload(ids.place_y, host_.place_y);
    uploaded_ = true;
    return ids;
}

}  // namespace patina::kinect2
