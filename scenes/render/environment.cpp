#include "scenes/render/environment.h"

#include <cmath>
#include <cstring>
#include <numbers>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "engine/core/latitude_longitude.h"
#include "sensor/files/exr_file.h"
#include "sensor/files/picture_container.h"

namespace patina::scenes {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

glm::vec3 direction_at(float azimuth_rad, float elevation_rad) {
    return {std::cos(elevation_rad) * std::sin(azimuth_rad), -std::sin(elevation_rad),
            std::cos(elevation_rad) * std::cos(azimuth_rad)};
}

glm::vec2 center_of(uint32_t x, uint32_t y) { return glm::vec2(x, y) + 0.5f; }

/// A picture of what `radiance` returns for each pixel's direction.
template <class Radiance>
Image<glm::vec3> picture_of(Extent2D extent, Radiance radiance) {
    PATINA_ASSERT(extent.area() > 0, "extent ", extent);
    Image<glm::vec3> picture(extent);
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) picture.at(x, y) = radiance(direction_of(center_of(x, y), extent));
    }
    return picture;
}

/// The pixels of the sun's disc: those whose centre lies within its radius, or else the nearest.
std::vector<glm::uvec2> disc_pixels(const SkyEnvironment& sky, Extent2D extent) {
    const glm::vec3 sun = direction_at(sky.sun_azimuth_rad, sky.sun_elevation_rad);
    std::vector<glm::uvec2> covered;
    glm::uvec2 nearest(0);
    float nearest_cosine = -2;
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            const float cosine = glm::dot(direction_of(center_of(x, y), extent), sun);
            if (cosine >= std::cos(sky.sun_radius_rad)) covered.emplace_back(x, y);
            if (cosine > nearest_cosine) {
                nearest_cosine = cosine;
                nearest = {x, y};
            }
        }
    }
    return covered.empty() ? std::vector{nearest} : covered;
}

void add_sun(Image<glm::vec3>& picture, const SkyEnvironment& sky) {
    const glm::vec3 sun = direction_at(sky.sun_azimuth_rad, sky.sun_elevation_rad);
    const std::vector<glm::uvec2> disc = disc_pixels(sky, picture.extent());
    float facing_sr = 0;  // solid angle weighted with the cosine to a surface that faces the sun
    for (const glm::uvec2 p : disc) {
        facing_sr += static_cast<float>(solid_angle_of_row(p.y, picture.extent())) *
                     glm::dot(direction_of(center_of(p.x, p.y), picture.extent()), sun);
    }
    for (const glm::uvec2 p : disc) picture.at(p.x, p.y) += sky.sun_irradiance / facing_sr;
}

glm::vec3 sky_radiance(const SkyEnvironment& sky, glm::vec3 direction) {
    const float up = -direction.y;
    constexpr float kHaze = 0.02f;  // sine of the elevation across which the ground fades into the horizon
    const glm::vec3 above = glm::mix(sky.horizon, sky.zenith, std::sqrt(glm::clamp(up, 0.0f, 1.0f)));
    return glm::mix(sky.ground, above, glm::smoothstep(-kHaze, kHaze, up));
}

/// How much of a soft box is seen in a direction: 1 inside, falling to 0 over a tenth of its size.
float seen(const SoftBox& box, glm::vec3 direction) {
    constexpr float kEdge = 0.1f;
    const float elevation = std::asin(glm::clamp(-direction.y, -1.0f, 1.0f));
    const float turned = std::remainder(std::atan2(direction.x, direction.z) - box.azimuth_rad, 2 * kPi);
    const glm::vec2 away = glm::abs(glm::vec2(turned, elevation - box.elevation_rad)) / box.half_size_rad;
    const glm::vec2 inside = 1.0f - glm::smoothstep(glm::vec2(1 - kEdge), glm::vec2(1 + kEdge), away);
    return inside.x * inside.y;
}

/// Radiance files hold RGBE; OpenCV returns it as float BGR.
Image<glm::vec3> read_radiance_file(const std::filesystem::path& file) {
    const std::vector<uint8_t> bytes = read_file(file, limits::kPictureBytes);
    const Extent2D extent = sensor::check_radiance(bytes, file.string());
    cv::Mat picture;
    try {
        picture = cv::imdecode(bytes, cv::IMREAD_ANYDEPTH | cv::IMREAD_COLOR);
    } catch (const cv::Exception& error) {
        throw Error(file.string(), " cannot be decoded: ", error.err);
    }
    if (picture.empty()) throw Error(file.string(), " cannot be decoded: its ", bytes.size(), " bytes are damaged");
    if (picture.type() != CV_32FC3) throw Error(file.string(), " is no Radiance picture: it holds no floating point");
    const Extent2D decoded{static_cast<uint32_t>(picture.cols), static_cast<uint32_t>(picture.rows)};
    if (decoded != extent)
        throw Error(file.string(), " is damaged: its header says ", extent, " pixels, but it holds ", decoded);
    cv::cvtColor(picture, picture, cv::COLOR_BGR2RGB);
    Image<glm::vec3> image(extent);
    PATINA_ASSERT(picture.isContinuous(), "rows ", picture.rows, ", bytes per row ", picture.step[0]);
    std::memcpy(image.pixels().data(), picture.data, image.pixels().size() * sizeof(glm::vec3));
    return image;
}

}  // namespace

glm::vec3 direction_of(glm::vec2 place_px, Extent2D extent) {
    const float azimuth = (place_px.x / static_cast<float>(extent.width) - 0.5f) * 2 * kPi;
    const float elevation = (0.5f - place_px.y / static_cast<float>(extent.height)) * kPi;
    return direction_at(azimuth, elevation);
}

glm::vec3 mean_radiance(const Image<glm::vec3>& environment) {
    const Extent2D extent = environment.extent();
    glm::dvec3 sum(0);
    for (uint32_t y = 0; y < extent.height; ++y) {
        glm::dvec3 row(0);
        for (uint32_t x = 0; x < extent.width; ++x) row += environment.at(x, y);
        sum += row * solid_angle_of_row(y, extent);
    }
    return glm::vec3(sum / (4 * std::numbers::pi));
}

Image<glm::vec3> draw_environment(const UniformEnvironment& uniform, Extent2D extent) {
    return Image<glm::vec3>(extent, uniform.radiance);
}

Image<glm::vec3> draw_environment(const SkyEnvironment& sky, Extent2D extent) {
    Image<glm::vec3> picture = picture_of(extent, [&](glm::vec3 direction) { return sky_radiance(sky, direction); });
    add_sun(picture, sky);
    return picture;
}

Image<glm::vec3> draw_environment(const StudioEnvironment& studio, Extent2D extent) {
    return picture_of(extent, [&](glm::vec3 direction) {
        glm::vec3 radiance = studio.walls;
        for (const SoftBox& box : studio.boxes) radiance += box.radiance * seen(box, direction);
        return radiance;
    });
}

Image<glm::vec3> read_environment(const std::filesystem::path& file) {
    expect_file(file);
    const bool exr = file.extension() == ".exr";
    if (!exr && file.extension() != ".hdr") throw Error(file.string(), " is neither .hdr nor .exr");
    Image<glm::vec3> environment = exr ? sensor::read_exr_color(file) : read_radiance_file(file);
    for (const glm::vec3& radiance : environment.pixels()) {
        for (const float value : {radiance.r, radiance.g, radiance.b}) {
            if (!(value >= 0 && std::isfinite(value))) throw Error(file.string(), " has a radiance of ", value);
        }
    }
    return environment;
}

}  // namespace patina::scenes
