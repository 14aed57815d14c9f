#include "export/write_exr.h"

#include <map>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <gmock/gmock.h>

#include "tests/export/temporary_folder.h"
#include "tests/export/throws.h"

namespace patina::write_exr_test {
namespace {

using test::bytes_of;
using test::TemporaryFolder;
using test::throws_error_with;

constexpr Extent2D kExtent{37, 19};

/// Every value differs from every other, so that swapped channels, rows or pixels show.
FrameDump distinct_frame(Extent2D extent) {
    FrameDump frame{Image<glm::vec3>(extent), Image<float>(extent), Image<glm::vec3>(extent), Image<float>(extent)};
    for (size_t i = 0; i < extent.area(); ++i) {
        const float v = static_cast<float>(i) * 0.37f;
        frame.rgb.pixels()[i] = {v + 0.1f, v + 1000, v + 2000};
        frame.depth_m.pixels()[i] = v + 3000;
        frame.normal.pixels()[i] = {-v, -v - 1000, -v - 2000};
        frame.valid.pixels()[i] = static_cast<float>(i % 2);
    }
    return frame;
}

std::map<std::string, std::vector<float>> read_exr(const std::filesystem::path& path) {
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    const size_t width = static_cast<size_t>(window.max.x + 1), height = static_cast<size_t>(window.max.y + 1);
    EXPECT_EQ(file.header().compression(), Imf::ZIP_COMPRESSION);
    std::map<std::string, std::vector<float>> planes;
    Imf::FrameBuffer pixels;
    const Imf::ChannelList& channels = file.header().channels();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
        EXPECT_EQ(channel.channel().type, Imf::FLOAT) << channel.name();
        std::vector<float>& plane = planes[channel.name()];
        plane.resize(width * height);
        pixels.insert(channel.name(), Imf::Slice::Make(Imf::FLOAT, plane.data(), window));
    }
    file.setFrameBuffer(pixels);
    file.readPixels(window.min.y, window.max.y);
    return planes;
}

std::vector<float> component(const Image<glm::vec3>& image, int axis) {
    std::vector<float> plane;
    for (const glm::vec3& pixel : image.pixels()) plane.push_back(pixel[axis]);
    return plane;
}

TEST(WriteExr, AFrameReadsBackExactly) {
    const TemporaryFolder folder;
    const FrameDump frame = distinct_frame(kExtent);
    write_exr(folder / "a.exr", channels_of(frame));
    const std::map<std::string, std::vector<float>> expected = {
        {"rgb.R", component(frame.rgb, 0)},       {"rgb.G", component(frame.rgb, 1)},
        {"rgb.B", component(frame.rgb, 2)},       {"depth", frame.depth_m.pixels()},
        {"normal.X", component(frame.normal, 0)}, {"normal.Y", component(frame.normal, 1)},
        {"normal.Z", component(frame.normal, 2)}, {"valid", frame.valid.pixels()}};
    EXPECT_EQ(read_exr(folder / "a.exr"), expected);
}

TEST(WriteExr, FurtherGroupsJoinTheFrame) {
    const TemporaryFolder folder;
    const Extent2D extent{3, 2};
    FrameDump frame = distinct_frame(extent);
    const auto colors = [&](float first) {
        Image<glm::vec3> image(extent);
        for (glm::vec3& pixel : image.pixels()) pixel = glm::vec3(first, first + 1, first + 2), first += 10;
        return image;
    };
    frame.kd = colors(0.1f), frame.ks = colors(0.2f), frame.kd_segment = colors(0.3f);
    frame.alpha = Image<float>(extent, 0.4f), frame.label = Image<float>(extent, 7.0f);
    frame.visibility = Image<float>(extent, 0.25f);
    write_exr(folder / "a.exr", channels_of(frame));
    auto planes = read_exr(folder / "a.exr");
    EXPECT_EQ(planes.size(), 8u + 12u) << "rgb_segment is empty, and left out";
    for (const auto& [name, image] : {std::pair{"kd", &frame.kd}, {"ks", &frame.ks}, {"kd_segment", &frame.kd_segment}})
        for (int i = 0; i < 3; ++i) EXPECT_EQ(planes[std::string(name) + "." + "RGB"[i]], component(*image, i)) << name;
    EXPECT_EQ(planes["alpha"], frame.alpha.pixels());
    EXPECT_EQ(planes["label"], frame.label.pixels());
    EXPECT_EQ(planes["visibility"], frame.visibility.pixels());
    frame.rgb_segment = frame.kd;
    write_exr(folder / "b.exr", channels_of(frame));
    EXPECT_EQ(read_exr(folder / "b.exr")["rgb_segment.B"], component(frame.kd, 2));
}

TEST(WriteExr, TheSamePixelsGiveTheSameBytes) {
    const TemporaryFolder folder;
    write_exr(folder / "a.exr", channels_of(distinct_frame(kExtent)));
    write_exr(folder / "b.exr", channels_of(distinct_frame(kExtent)));
    EXPECT_FALSE(bytes_of(folder / "a.exr").empty());
    EXPECT_EQ(bytes_of(folder / "a.exr"), bytes_of(folder / "b.exr"));
}

TEST(WriteExr, SaysWhatIsWrong) {
    const TemporaryFolder folder;
    const auto path = folder / "a.exr";
    FrameDump frame = distinct_frame(kExtent);
    EXPECT_THAT([&] { write_exr(path, {}); }, throws_error_with("without channels"));
    EXPECT_THAT([&] { write_exr(path, channels_of({})); }, throws_error_with("channel rgb.R is empty: 0 x 0"));
    EXPECT_THAT([&] { write_exr(folder / "missing/a.exr", channels_of(frame)); }, throws_error_with("missing/a.exr"));
    std::vector<ExrChannel> twice = channels_of(frame);
    twice.push_back(scalar_channel("depth", frame.valid));
    EXPECT_THAT([&] { write_exr(path, twice); }, throws_error_with("channel depth is given twice"));
    frame.depth_m = Image<float>({5, 4});
    EXPECT_THAT([&] { write_exr(path, channels_of(frame)); }, throws_error_with("depth is 5 x 4 but rgb.R is 37 x 19"));
    EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace patina::write_exr_test
