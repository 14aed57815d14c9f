#include "sensor/files/picture_file.h"

#include <cstring>
#include <limits>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>

#include "tests/sensor/sequences.h"

namespace patina::sensor::picture_file_test {
namespace {

using namespace testing;
using ::testing::HasSubstr;

constexpr Extent2D kExtent{37, 23};

Image<SrgbPixel> color() { return std::get<Image<SrgbPixel>>(test_frame(3, kExtent, kExtent).color); }
Image<uint16_t> depth() { return std::get<Image<uint16_t>>(test_frame(3, kExtent, kExtent).depth); }

void write_exr(const std::filesystem::path& file, Extent2D extent, const std::vector<const char*>& channels,
               std::vector<float> values) {
    const auto width = static_cast<int>(extent.width), height = static_cast<int>(extent.height);
    Imf::Header header(width, height);
    Imf::FrameBuffer source;
    const size_t stride = channels.size() * sizeof(float);
    for (size_t i = 0; i < channels.size(); ++i) {
        header.channels().insert(channels[i], Imf::Channel(Imf::FLOAT));
        source.insert(channels[i], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data() + i), stride,
                                              stride * extent.width));
    }
    Imf::OutputFile output(file.c_str(), header);
    output.setFrameBuffer(source);
    output.writePixels(height);
}

TEST(PictureFile, PngRoundTripsExactly) {
    const TemporaryFolder folder;
    write_png(folder / "c.png", color());
    write_png(folder / "d.png", depth());
    EXPECT_EQ(picture_extent(folder / "c.png"), kExtent);
    EXPECT_EQ(std::get<Image<SrgbPixel>>(read_color(folder / "c.png", kExtent)).pixels(), color().pixels());
    EXPECT_EQ(std::get<Image<uint16_t>>(read_depth(folder / "d.png", kExtent)).pixels(), depth().pixels());
}

TEST(PictureFile, JpegIsReadInRgbOrder) {
    const TemporaryFolder folder;
    write_jpeg(folder / "c.jpg", Image<SrgbPixel>(kExtent, SrgbPixel(200, 100, 20)));
    const auto image = std::get<Image<SrgbPixel>>(read_color(folder / "c.jpg", kExtent));
    EXPECT_NEAR(image.at(5, 5).r, 200, 3);
    EXPECT_NEAR(image.at(5, 5).g, 100, 3);
    EXPECT_NEAR(image.at(5, 5).b, 20, 3);
}

TEST(PictureFile, ProgressiveJpegWithRestartsIsWhole) {
    const TemporaryFolder folder;
    const std::string file = (folder / "c.jpg").string();
    ASSERT_TRUE(cv::imwrite(file, cv::Mat(100, 200, CV_8UC3, cv::Scalar(1, 2, 3)),
                            {cv::IMWRITE_JPEG_PROGRESSIVE, 1, cv::IMWRITE_JPEG_RST_INTERVAL, 1}));
    EXPECT_EQ(picture_extent(file), (Extent2D{200, 100}));
}

TEST(PictureFile, GreyAndTransparentColourBecomesRgb) {
    const TemporaryFolder folder;
    cv::imwrite((folder / "grey.png").string(), cv::Mat(4, 4, CV_8UC1, cv::Scalar(7)));
    cv::imwrite((folder / "alpha.png").string(), cv::Mat(4, 4, CV_8UC4, cv::Scalar(3, 2, 1, 0)));
    EXPECT_EQ(std::get<Image<SrgbPixel>>(read_color(folder / "grey.png", {4, 4})).at(1, 1), SrgbPixel(7, 7, 7));
    EXPECT_EQ(std::get<Image<SrgbPixel>>(read_color(folder / "alpha.png", {4, 4})).at(1, 1), SrgbPixel(1, 2, 3));
}

// Every cut, from the last byte to the whole file but one: each must be noticed, wherever in the file's structure it
// falls.
TEST(PictureFile, EveryTruncationIsAnErrorThatNamesTheFile) {
    const TemporaryFolder folder;
    write_png(folder / "c.png", color());
    write_png(folder / "d.png", depth());
    write_jpeg(folder / "j.jpg", color());
    for (const char* name : {"c.png", "d.png", "j.jpg"}) {
        const std::filesystem::path file = folder / name;
        for (auto size = std::filesystem::file_size(file); size-- > 0;) {
            std::filesystem::resize_file(file, size);
            const std::string message = error_of([&] { picture_extent(file); });
            ASSERT_THAT(message, HasSubstr(file.string())) << size;
            if (size >= 16) {
                ASSERT_THAT(message, HasSubstr(text("truncated: it has ", size, " bytes"))) << size;
            }
        }
    }
}

TEST(PictureFile, ReadersRefuseTruncatedFiles) {
    const TemporaryFolder folder;
    write_png(folder / "c.png", color());
    write_png(folder / "d.png", depth());
    write_jpeg(folder / "j.jpg", color());
    for (const char* name : {"c.png", "d.png", "j.jpg"}) shorten(folder / name, 20);
    EXPECT_THAT(error_of([&] { read_color(folder / "c.png", kExtent); }), HasSubstr("c.png is truncated"));
    EXPECT_THAT(error_of([&] { read_depth(folder / "d.png", kExtent); }), HasSubstr("d.png is truncated"));
    EXPECT_THAT(error_of([&] { read_color(folder / "j.jpg", kExtent); }), HasSubstr("j.jpg is truncated"));
}

TEST(PictureFile, AFlippedBitInAPngIsNoticed) {
    const TemporaryFolder folder;
    write_png(folder / "d.png", depth());
    std::string bytes = read_text(folder / "d.png");
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 4);
    write_text(folder / "d.png", bytes);
    EXPECT_THAT(error_of([&] { read_depth(folder / "d.png", kExtent); }), HasSubstr("d.png is damaged: chunk IDAT"));
}

TEST(PictureFile, WrongSizeAndKindNameBothValues) {
    const TemporaryFolder folder;
    write_png(folder / "c.png", color());
    write_png(folder / "d.png", depth());
    write_text(folder / "t.png", "hello");
    EXPECT_THAT(error_of([&] {
                    read_color(folder / "c.png", {640, 480});
                }),
                HasSubstr("c.png is 37 x 23 pixels, but the sequence says 640 x 480"));
    EXPECT_THAT(error_of([&] { read_depth(folder / "c.png", kExtent); }),
                HasSubstr("c.png has 3 channel(s) of 8 bits, but depth must have 1 of 16"));
    EXPECT_THAT(error_of([&] { read_color(folder / "d.png", kExtent); }),
                HasSubstr("d.png has 16 bits per channel, but colour must have 8"));
    EXPECT_THAT(error_of([&] { read_color(folder / "t.png", kExtent); }),
                HasSubstr("t.png is neither PNG, JPEG nor OpenEXR"));
    EXPECT_THAT(error_of([&] { read_color(folder / "no.png", kExtent); }), HasSubstr("no.png does not exist"));
}

TEST(PictureFile, TheInvalidValueBecomesZero) {
    const TemporaryFolder folder;
    Image<uint16_t> image(kExtent, 1234);
    image.at(3, 4) = 65535;
    write_png(folder / "d.png", image);
    const auto read = std::get<Image<uint16_t>>(read_depth(folder / "d.png", kExtent, 65535));
    EXPECT_EQ(read.at(3, 4), 0);
    EXPECT_EQ(read.at(4, 4), 1234);
}

TEST(PictureFile, ExrGivesLinearColourAndDepthInMetres) {
    const TemporaryFolder folder;
    write_exr(folder / "c.exr", {2, 1}, {"R", "G", "B"}, {0.5f, 1.5f, 2.5f, 3.5f, 4.5f, 5.5f});
    const auto image = std::get<Image<glm::vec3>>(read_color(folder / "c.exr", {2, 1}));
    EXPECT_EQ(image.at(0, 0), glm::vec3(0.5f, 1.5f, 2.5f));
    EXPECT_EQ(image.at(1, 0), glm::vec3(3.5f, 4.5f, 5.5f));

    const float infinity = std::numeric_limits<float>::infinity();
    write_exr(folder / "d.exr", {2, 2}, {"Z"}, {1.25f, -1.0f, infinity, std::nanf("")});
    const auto depth_m = std::get<Image<float>>(read_depth(folder / "d.exr", {2, 2}));
    EXPECT_EQ(depth_m.pixels(), (std::vector<float>{1.25f, 0, 0, 0}));
}

TEST(PictureFile, BadExrIsAnError) {
    const TemporaryFolder folder;
    write_exr(folder / "c.exr", {64, 64}, {"A"}, std::vector<float>(64 * 64, 1.0f));
    EXPECT_THAT(error_of([&] { read_color(folder / "c.exr", {64, 64}); }), HasSubstr("c.exr has no channel R"));
    EXPECT_THAT(error_of([&] { read_depth(folder / "c.exr", {64, 64}); }), HasSubstr("c.exr has no depth channel"));
    write_exr(folder / "d.exr", {64, 64}, {"Z"}, std::vector<float>(64 * 64, 1.0f));
    shorten(folder / "d.exr", 10);
    EXPECT_THAT(error_of([&] {
                    read_depth(folder / "d.exr", {64, 64});
                }),
                HasSubstr("d.exr is truncated: it has 451 bytes"));
}

// ---- pictures that lie about their size
// ------------------------------------------------------------------------------

std::string number_of_bytes(uint64_t value, int count) {
    std::string bytes;
    while (count-- > 0) bytes += static_cast<char>(value >> 8 * count);
    return bytes;
}

std::string png_chunk(const std::string& type, const std::string& data) {
    uint32_t crc = ~0u;
    for (const char c : type + data) {
        crc ^= static_cast<uint8_t>(c);
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
    }
    return number_of_bytes(data.size(), 4) + type + data + number_of_bytes(~crc, 4);
}

std::string png_header(Extent2D extent) {
    const std::string form("\x08\x02\0\0\0", 5);  // 8 bits, RGB
    return png_chunk("IHDR", number_of_bytes(extent.width, 4) + number_of_bytes(extent.height, 4) + form);
}

const std::string kPngBegin = "\x89PNG\r\n\x1a\n";

TEST(PictureFile, APngThatNoCameraTakesIsRefusedByItsHeader) {
    const TemporaryFolder folder;
    const std::string file = (folder / "c.png").string();
    write_text(file, kPngBegin + png_header({30000, 30000}) + png_chunk("IDAT", "x") + png_chunk("IEND", ""));
    const std::string refusal = file + " is 30000 x 30000 pixels, at most 134217728 are decoded";
    EXPECT_EQ(error_of([&] { picture_extent(file); }), refusal);
    EXPECT_EQ(error_of([&] { read_color(file, {30000, 30000}); }), refusal);
    write_text(file, kPngBegin + png_header({0, 4}) + png_chunk("IEND", ""));
    EXPECT_THAT(error_of([&] { picture_extent(file); }), HasSubstr("c.png is 0 x 4 pixels"));
}

TEST(PictureFile, APictureHasOneHeader) {
    const TemporaryFolder folder;
    write_text(folder / "c.png", kPngBegin + png_header({4, 4}) + png_header({8, 8}) + png_chunk("IEND", ""));
    EXPECT_THAT(error_of([&] { picture_extent(folder / "c.png"); }), HasSubstr("c.png is damaged: it has two IHDR"));
    write_text(folder / "c.png", kPngBegin + png_chunk("IEND", ""));
    EXPECT_THAT(error_of([&] { picture_extent(folder / "c.png"); }), HasSubstr("c.png is damaged: it has no IHDR"));

    write_jpeg(folder / "j.jpg", color());
    std::string jpeg = read_text(folder / "j.jpg");
    const size_t header = jpeg.find("\xff\xc0");
    ASSERT_NE(header, std::string::npos);
    const size_t length = 2 + size_t{static_cast<uint8_t>(jpeg[header + 3])};
    std::string second = jpeg.substr(header, length);
    second[6] = 9;  // rows
    write_text(folder / "j.jpg", jpeg.substr(0, header) + second + jpeg.substr(header));
    EXPECT_THAT(error_of([&] { picture_extent(folder / "j.jpg"); }), HasSubstr("j.jpg is damaged: it has two frame"));
    EXPECT_THAT(error_of([&] { read_color(folder / "j.jpg", kExtent); }), HasSubstr("it has two frame headers"));
    write_text(folder / "j.jpg", jpeg.substr(0, header) + jpeg.substr(header + length));
    EXPECT_THAT(error_of([&] { picture_extent(folder / "j.jpg"); }), HasSubstr("j.jpg is damaged: it has no frame"));
}

/// The file with 4 bytes behind the name of an attribute, its type and its length replaced.
void replace_attribute(const std::filesystem::path& file, const std::string& name, size_t type_letters, size_t offset,
                       uint32_t value) {
    std::string bytes = read_text(file);
    const size_t at = bytes.find(name);
    ASSERT_NE(at, std::string::npos);
    std::memcpy(bytes.data() + at + name.size() + 1 + type_letters + 1 + 4 + offset, &value, 4);
    write_text(file, bytes);
}

TEST(PictureFile, AnExrThatNoCameraTakesIsRefusedByItsHeader) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "d.exr";
    const auto error = [&] { return error_of([&] { read_depth(file, {8, 8}); }); };
    write_exr(file, {8, 8}, {"Z"}, std::vector<float>(64, 1.0f));
    replace_attribute(file, "dataWindow", 5, 8, 0x7ffffffe);
    EXPECT_THAT(error(), HasSubstr("d.exr is 2147483647 x 8 pixels, at most 134217728 are decoded"));
    replace_attribute(file, "dataWindow", 5, 8, 0x80000000);
    EXPECT_THAT(error(), HasSubstr("d.exr is 0 x 8 pixels, which is no picture"));
    write_exr(file, {8, 8}, {"Z"}, std::vector<float>(64, 1.0f));
    replace_attribute(file, "dataWindow", 5, 12, 9000);
    EXPECT_THAT(error(), HasSubstr("d.exr is 8 x 9001 pixels, but the sequence says 8 x 8"));
    EXPECT_THAT(error_of([&] { read_depth(file, {8, 9001}); }), HasSubstr("d.exr"));
}

}  // namespace
}  // namespace patina::sensor::picture_file_test
