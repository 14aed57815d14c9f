#include <cmath>
#include <random>

#include <gmock/gmock.h>

#include "sensor/open.h"
#include "sensor/readers/oni_depth.h"
#include "tests/sensor/oni_recording.h"
#include "tests/sensor/sequences.h"

// Recordings of OpenNI, read without it.

namespace patina::sensor::oni_test {
namespace {

using namespace testing;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr Extent2D kExtent{16, 12};
constexpr uint64_t kFrame_us = 33'333;

std::vector<uint16_t> depth_of(uint32_t frame, Extent2D extent = kExtent) {
    std::vector<uint16_t> values(extent.area());
    for (uint32_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<uint16_t>(i % 7 == 0 ? 0 : 800 + 100 * frame + i % extent.width);
    return values;
}

std::vector<uint8_t> color_of(uint32_t frame) {
    std::vector<uint8_t> bytes(3 * kExtent.area());
    for (uint32_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<uint8_t>(i + 50 * frame);
    return bytes;
}

std::vector<OniStreamText> both_streams() {
    return {{2, "16zT", kExtent, 100, glm::dvec2(1.0, 0.8), false},
            {3, "NONE", kExtent, 200, glm::dvec2(1.1, 0.9), false}};
}

/// Three frames; each colour picture comes 5 ms after its depth.
std::vector<OniPictureText> three_frames() {
    std::vector<OniPictureText> pictures;
    for (uint32_t i = 0; i < 3; ++i) {
        pictures.push_back({0, 1'000'000 + i * kFrame_us, encode_oni_depth(depth_of(i), true)});
        pictures.push_back({1, 1'005'000 + i * kFrame_us, color_of(i)});
    }
    return pictures;
}

class OniTest : public ::testing::Test {
  protected:
    std::unique_ptr<Source> open(const std::string& bytes) {
        write_text(file_, bytes);
        return open_sequence(file_);
    }
    static std::vector<Frame> frames_of(Source& source) {
        std::vector<Frame> frames;
        while (auto reading = source.next()) frames.push_back(std::get<Frame>(*std::move(reading)));
        return frames;
    }

    const TemporaryFolder folder_;
    const std::filesystem::path file_ = folder_ / "room.oni";
};

TEST(OniDepth, WhatIsEncodedIsDecodedAgain) {
    std::mt19937 random(3);
    for (const bool table : {false, true}) {
        for (int step : {0, 3, 40, 4000}) {
            for (const size_t count : {1u, 2u, 3u, 64u, 997u}) {
                std::vector<uint16_t> values(count);
                int value = 5000;
                for (uint16_t& v : values) {
                    value = std::clamp(value + std::uniform_int_distribution(-step, step)(random), 0, 9999);
                    v = static_cast<uint16_t>(value);
                }
                EXPECT_EQ(decode_oni_depth(encode_oni_depth(values, table), count, table), values)
                    << table << ' ' << step << ' ' << count;
            }
        }
    }
}

TEST(OniDepth, AByteHoldsSixtyValuesAtMost) {
    const std::vector<uint8_t> bytes{7, 0, 0xfe, 0xfe};
    EXPECT_EQ(decode_oni_depth(bytes, 121, false), std::vector<uint16_t>(121, 7));
}

TEST(OniDepth, CountsInSixteenBits) {
    EXPECT_EQ(decode_oni_depth(std::vector<uint8_t>{1, 0, 0x9d}, 2, false), (std::vector<uint16_t>{1, 0xfffe}));
    EXPECT_EQ(decode_oni_depth(std::vector<uint8_t>{0xff, 0xff, 0xff, 0x80}, 2, false),
              (std::vector<uint16_t>{0xffff, 63}));
}

TEST(OniDepth, BytesThatDoNotFitAreErrors) {
    const std::vector<uint16_t> values = depth_of(0);
    std::vector<uint8_t> bytes = encode_oni_depth(values, true);
    EXPECT_THROW(decode_oni_depth(bytes, values.size() - 1, true), Error);
    EXPECT_THROW(decode_oni_depth(bytes, values.size() + 1, true), Error);
    for (size_t length = 0; length < bytes.size(); ++length)
        EXPECT_THROW(decode_oni_depth(std::span(bytes).first(length), values.size(), true), Error) << length;
    // Nothing is allocated for values that the bytes cannot hold.
    EXPECT_THROW(decode_oni_depth(bytes, size_t{1} << 60, true), Error);
    // Whatever a byte becomes, the result is an error or as many values.
    std::mt19937 random(5);
    for (int i = 0; i < 2000; ++i) {
        std::vector<uint8_t> changed = bytes;
        changed[random() % changed.size()] = static_cast<uint8_t>(random());
        try {
            EXPECT_EQ(decode_oni_depth(changed, values.size(), true).size(), values.size());
        } catch (const Error&) {
        }
    }
}

TEST_F(OniTest, FramesArePairsNearestInTime) {
    const auto source = open(oni_recording(both_streams(), three_frames()));
    EXPECT_EQ(source->info().format, "oni");
    EXPECT_EQ(source->info().frames, 3u);
    EXPECT_FALSE(source->info().has_poses);
    const std::vector<Frame> frames = frames_of(*source);
    ASSERT_EQ(frames.size(), 3u);
    for (uint32_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(frames[i].timestamp_s, 1 + i * 0.033333, 1e-9);
        EXPECT_EQ(std::get<Image<uint16_t>>(frames[i].depth).pixels(), depth_of(i));
        const auto& color = std::get<Image<SrgbPixel>>(frames[i].color);
        EXPECT_EQ(color.at(1, 0), SrgbPixel(color_of(i)[3], color_of(i)[4], color_of(i)[5]));
    }
}

TEST_F(OniTest, PicturesOfOneSizeHaveTheColorCameraElseEachItsOwn) {
    const auto source = open(oni_recording(both_streams(), three_frames()));
    EXPECT_NEAR(source->info().depth.fx, 8 / std::tan(0.55), 1e-9);
    EXPECT_NEAR(source->info().color.fy, 6 / std::tan(0.45), 1e-9);
    EXPECT_EQ(source->info().depth.cx, 7.5);
    auto streams = both_streams();
    streams[0].extent = {8, 6};
    auto pictures = three_frames();
    for (auto& picture : pictures)
        if (picture.stream == 0) picture.bytes = encode_oni_depth(depth_of(0, {8, 6}), true);
    EXPECT_NEAR(open(oni_recording(streams, pictures))->info().depth.fx, 4 / std::tan(0.5), 1e-9);
    streams[0].view_rad = streams[1].view_rad = std::nullopt;
    EXPECT_NEAR(open(oni_recording(streams, pictures))->info().color.fx, 525.0 * 16 / 640, 1e-9);
}

TEST_F(OniTest, TenthsOfMillimetresAndOtherCodecs) {
    auto streams = both_streams();
    streams[0].pixel_format = 101;
    streams[0].codec = "NONE";
    auto pictures = three_frames();
    for (auto& picture : pictures) {
        if (picture.stream == 1) continue;
        const std::vector<uint16_t> values = depth_of(2);
        const auto* bytes = reinterpret_cast<const uint8_t*>(values.data());
        picture.bytes.assign(bytes, bytes + 2 * values.size());
    }
    const auto source = open(oni_recording(streams, pictures));
    EXPECT_EQ(source->info().metres_per_unit, 0.0001);
    EXPECT_EQ(std::get<Image<uint16_t>>(frames_of(*source)[0].depth).pixels(), depth_of(2));
}

TEST_F(OniTest, MirroredPicturesAreMirroredBack) {
    auto streams = both_streams();
    streams[0].mirrored = streams[1].mirrored = true;
    const auto source = open(oni_recording(streams, three_frames()));
    const Frame frame = frames_of(*source).front();
    EXPECT_EQ(std::get<Image<uint16_t>>(frame.depth).at(15, 0), depth_of(0)[0]);
    EXPECT_EQ(std::get<Image<SrgbPixel>>(frame.color).at(15, 0), SrgbPixel(0, 1, 2));
}

TEST_F(OniTest, ADepthPictureWithoutColorIsSkipped) {
    auto pictures = three_frames();
    pictures.erase(pictures.begin() + 3);
    const auto source = open(oni_recording(both_streams(), pictures));
    source->next();
    EXPECT_THAT(std::get<Skipped>(*source->next()).reason, HasSubstr("no colour picture within"));
    EXPECT_TRUE(std::holds_alternative<Frame>(*source->next()));
}

TEST_F(OniTest, AFileThatWasCutOffHasTheFramesBefore) {
    const std::string whole = oni_recording(both_streams(), three_frames());
    std::optional<uint32_t> before;
    for (size_t length = 0; length <= whole.size(); length += 7) {
        try {
            const auto source = open(whole.substr(0, length));
            const uint32_t frames = *source->info().frames;
            EXPECT_GE(frames, before.value_or(0)) << length;
            before = frames;
            while (source->next()) continue;
        } catch (const Error&) {
            EXPECT_FALSE(before) << length;
        }
    }
    EXPECT_EQ(before, 3u);
}

TEST_F(OniTest, WhateverABitBecomesItIsAnErrorOrFrames) {
    const std::string whole = oni_recording(both_streams(), three_frames());
    std::mt19937 random(11);
    for (int i = 0; i < 400; ++i) {
        std::string changed = whole;
        changed[random() % changed.size()] ^= static_cast<char>(1u << random() % 8);
        try {
            const auto source = open(changed);
            while (source->next()) continue;
        } catch (const Error& error) {
            EXPECT_THAT(error.what(), HasSubstr("room.oni"));
        }
    }
}

TEST_F(OniTest, WhatIsMissingIsOneSentence) {
    const auto failure = [&](const std::vector<OniStreamText>& streams) {
        return error_of([&] { open(oni_recording(streams, three_frames())); });
    };
    EXPECT_THAT(error_of([&] { open(oni_recording({both_streams()[0]}, {three_frames()[0]})); }),
                AllOf(HasSubstr("room.oni"), HasSubstr("no colour pictures")));
    auto streams = both_streams();
    streams[1].codec = "24zX";
    EXPECT_THAT(failure(streams), HasSubstr("compressed by '24zX'"));
    streams = both_streams();
    streams[1].pixel_format = 201;
    EXPECT_THAT(failure(streams), HasSubstr("pixel format 201"));
}

}  // namespace
}  // namespace patina::sensor::oni_test
