// Which pictures of a run are kept for its texture.

#include "reconstruction/session/kept_pictures.h"

#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace patina::kept_pictures_test {
namespace {

constexpr Extent2D kExtent{16, 12};

SequenceInfo info_of_camera() {
    SequenceInfo info;
    info.color = info.depth = {kExtent, 20, 20, 7.5, 5.5, {}};
    info.metres_per_unit = 0.001;
    return info;
}

/// A picture of noise: the larger `contrast`, the sharper.
Frame frame_at(double x_m, int contrast, uint32_t seed = 1, uint16_t depth_mm = 1000) {
    std::mt19937 random(seed);
    Image<SrgbPixel> color(kExtent);
    for (SrgbPixel& pixel : color.pixels())
        for (glm::length_t c = 0; c < 3; ++c)
            pixel[c] = static_cast<uint8_t>(128 + std::uniform_int_distribution(-contrast, contrast)(random));
    Frame frame;
    frame.color = color;
    frame.depth = Image<uint16_t>(kExtent, depth_mm);
    frame.world_from_camera = glm::translate(RigidTransform(1.0), glm::dvec3(x_m, 0, 0));
    return frame;
}

struct Given {
    std::vector<Image<SrgbPixel>> colors;
    std::vector<double> x_m;
    std::vector<glm::vec3> gains;
};

Given given_by(KeptPictures& pictures, std::span<const gpu::ColorGains> gains = {}) {
    Given given;
    pictures.give(info_of_camera(), gains, [&](const TexturePicture& picture) {
        const auto pixels = std::get<std::span<const glm::u8vec3>>(picture.color.pixels);
        given.colors.emplace_back(kExtent, std::vector<SrgbPixel>(pixels.begin(), pixels.end()));
        given.x_m.push_back(picture.world_from_camera[3].x);
        given.gains.push_back(picture.gain);
    });
    return given;
}

const Image<SrgbPixel>& color_of(const Frame& frame) { return std::get<Image<SrgbPixel>>(frame.color); }

TEST(KeptPictures, ThoseOfFramesThatWereUndoneGo) {
    KeptPictures pictures;
    for (uint32_t i = 0; i < 4; ++i) pictures.add(info_of_camera(), frame_at(i, 20, i), i);
    pictures.keep_first(4);
    EXPECT_EQ(pictures.size(), 4u);
    pictures.keep_first(2);
    EXPECT_EQ(given_by(pictures).x_m, (std::vector<double>{0, 1}));
    pictures.add(info_of_camera(), frame_at(5, 20), 2);
    EXPECT_EQ(given_by(pictures).x_m, (std::vector<double>{0, 1, 5}));
}

TEST(KeptPictures, OfAStretchTheSharpestStays) {
    KeptPictures pictures;
    const Frame sharp = frame_at(0.015, 90, 7);
    const Frame frames[] = {frame_at(0, 20), sharp, frame_at(0.03, 40), frame_at(1, 10)};
    for (uint32_t i = 0; i < 4; ++i) pictures.add(info_of_camera(), frames[i], i);
    const std::vector<gpu::ColorGains> gains{{glm::vec4(1), {}}, {glm::vec4(1.5f, 2, 3, 0), {}}};
    const Given given = given_by(pictures, gains);
    ASSERT_EQ(given.colors.size(), 2u);
    EXPECT_EQ(pictures.size(), 2u);
    EXPECT_EQ(given.colors[0].pixels(), color_of(sharp).pixels()) << "without loss";
    EXPECT_EQ(given.x_m[0], 0.015);
    EXPECT_EQ(given.gains[0], glm::vec3(1.5f, 2, 3)) << "those of its frame";
    EXPECT_EQ(given.gains[1], glm::vec3(1)) << "none are known";
}

TEST(KeptPictures, OfALongWayNoMoreThanTheLimitAreKeptAllAlongIt) {
    KeptPictures pictures;
    for (uint32_t i = 0; i < 400; ++i)
        pictures.add(info_of_camera(), frame_at(0.2 * i, 20 + static_cast<int>(i % 5), i), i);
    const Given given = given_by(pictures);
    EXPECT_LE(given.x_m.size(), KeptPictures::kMostPictures + 1);
    EXPECT_GT(given.x_m.size(), KeptPictures::kMostPictures / 2);
    EXPECT_LT(given.x_m.front(), 2);
    EXPECT_GT(given.x_m.back(), 76);
    for (size_t i = 1; i < given.x_m.size(); ++i) {
        EXPECT_GT(given.x_m[i], given.x_m[i - 1]) << "in the order of frames";
        EXPECT_LT(given.x_m[i] - given.x_m[i - 1], 5) << "without a gap";
    }
}

TEST(KeptPictures, TheFinestPixelIsThatOfTheNearestSurface) {
    KeptPictures pictures;
    EXPECT_EQ(pictures.finest_pixel_m(), 0);
    pictures.add(info_of_camera(), frame_at(0, 20, 1, 2000), 0);
    pictures.add(info_of_camera(), frame_at(1, 20, 2, 500), 1);
    pictures.add(info_of_camera(), frame_at(2, 20, 3, 0), 2);  // no reading
    EXPECT_NEAR(pictures.finest_pixel_m(), 0.5 / 20, 1e-6);
}

/// Keeps bytes by name, and brings them back.
class Memory : public graph::StateVisitor {
  public:
    bool brings_back() const override { return back; }
    void buffer(vulkan::BufferRef&) override {}
    void array(vulkan::ChunkedBuffer&) override {}
    void image(vulkan::ImageRef&) override {}
    void bytes(const std::string& name, std::vector<std::byte>& bytes) override {
        if (back) bytes = kept.at(name);
        kept[name] = bytes;
    }

    bool back = false;
    std::map<std::string, std::vector<std::byte>> kept;
};

TEST(KeptPictures, ASessionThatGoesOnKeepsTheSame) {
    KeptPictures whole, first, second;
    Memory memory;
    for (uint32_t i = 0; i < 12; ++i) {
        const Frame frame = frame_at(0.02 * i, 20 + static_cast<int>(i * 7 % 11), i);
        whole.add(info_of_camera(), frame, i);
        (i < 7 ? first : second).add(info_of_camera(), frame, i);
        if (i != 6) continue;
        first.visit(memory);
        memory.back = true;
        second.visit(memory);
    }
    const Given expected = given_by(whole), found = given_by(second);
    ASSERT_EQ(found.x_m, expected.x_m);
    for (size_t i = 0; i < expected.colors.size(); ++i)
        EXPECT_EQ(found.colors[i].pixels(), expected.colors[i].pixels()) << i;
    EXPECT_EQ(given_by(first).x_m.size(), first.size()) << "keeping changes nothing";
}

}  // namespace
}  // namespace patina::kept_pictures_test
