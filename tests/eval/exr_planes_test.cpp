#include "tools/eval/exr_planes.h"

#include <fstream>

#include <OpenEXR/ImfRgbaFile.h>
#include <gmock/gmock.h>

#include "export/write_exr.h"
#include "tests/eval/pictures.h"
#include "tests/export/temporary_folder.h"
#include "tests/export/throws.h"

namespace patina::eval::exr_planes_test {
namespace {

using test::throws_error_with;

constexpr Extent2D kExtent{13, 7};

TEST(ExrPlanes, HoldWhatWasWritten) {
    const test::TemporaryFolder folder;
    const auto kd = test::picture_of<glm::vec3>(
        kExtent, [](float x, float y) { return glm::vec3(x + 0.1f, y + 100, x * y - 200); });
    const Image<float> depth = test::random_picture(kExtent, 1);
    std::vector<ExrChannel> channels = rgb_channels("kd", kd);
    channels.push_back(scalar_channel("depth", depth));
    write_exr(folder / "a.exr", channels);
    const ExrPlanes planes = ExrPlanes::read(folder / "a.exr");
    EXPECT_EQ(planes.extent(), kExtent);
    EXPECT_EQ(planes.planes().size(), 4u);
    EXPECT_TRUE(planes.has("kd.G"));
    EXPECT_FALSE(planes.has("ks.G"));
    EXPECT_EQ(planes.plane("depth"), depth.pixels());
    EXPECT_EQ(planes.rgb("kd").pixels(), kd.pixels());
    EXPECT_THAT([&] { planes.plane("alpha"); }, throws_error_with("a.exr has no channel alpha"));
    EXPECT_THAT([&] { planes.rgb("ks"); }, throws_error_with("a.exr has no channel ks.R"));
}

TEST(ExrPlanes, ReadHalfFloatsAndShiftedWindows) {
    const test::TemporaryFolder folder;
    const std::vector<Imf::Rgba> pixels(12, Imf::Rgba(0.5f, 0.25f, 2, 1));
    const Imath::Box2i window({-2, 5}, {1, 7});
    {
        Imf::RgbaOutputFile file((folder / "half.exr").c_str(), window, window, Imf::WRITE_RGB);
        file.setFrameBuffer(pixels.data() - (-2) - 5 * 4, 1, 4);
        file.writePixels(3);
    }
    const ExrPlanes planes = ExrPlanes::read(folder / "half.exr");
    EXPECT_EQ(planes.extent(), (Extent2D{4, 3}));
    EXPECT_EQ(planes.plane("B"), std::vector<float>(12, 2.0f));
}

TEST(ExrPlanes, NameTheFileThatIsMissingOrDamaged) {
    const test::TemporaryFolder folder;
    EXPECT_THAT([&] { ExrPlanes::read(folder / "none.exr"); }, throws_error_with("none.exr does not exist"));
    write_exr(folder / "a.exr", std::vector{scalar_channel("depth", test::random_picture({64, 64}, 1))});
    const std::string bytes = test::bytes_of(folder / "a.exr");
    std::ofstream(folder / "cut.exr", std::ios::binary) << bytes.substr(0, bytes.size() / 2);
    EXPECT_THAT([&] { ExrPlanes::read(folder / "cut.exr"); }, throws_error_with("cut.exr is truncated: "));
}

TEST(ExrFrames, AreFoundByIndex) {
    const test::TemporaryFolder folder;
    for (const char* name : {"000012.exr", "000003.exr", "1234567.exr", "7.png", "x9.exr", "000004.exr.tmp"}) {
        std::ofstream(folder / name) << "";
    }
    const auto frames = exr_frames(folder.path());
    ASSERT_EQ(frames.size(), 3u);
    EXPECT_EQ(frames.begin()->first, 3u);
    EXPECT_EQ(frames.at(12).filename(), "000012.exr");
    EXPECT_EQ(frames.count(1234567), 1u);
    EXPECT_TRUE(exr_frames(folder / "none").empty());
}

}  // namespace
}  // namespace patina::eval::exr_planes_test
