#include "tests/sensor/sequences.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <stdlib.h>

#include "sensor/files/picture_file.h"
#include "sensor/open.h"
#include "sensor/write_sequence.h"

namespace patina::sensor::testing {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "patina-sensor-XXXXXX").string();
    if (!mkdtemp(name.data())) throw Error(name, " cannot be created");
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

Frame test_frame(uint32_t index, Extent2D color, Extent2D depth) {
    Frame frame;
    frame.index = index;
    frame.timestamp_s = index / 30.0;
    Image<SrgbPixel> colors(color);
    for (uint32_t y = 0; y < color.height; ++y) {
        for (uint32_t x = 0; x < color.width; ++x) {
            colors.at(x, y) =
                SrgbPixel(static_cast<uint8_t>(x), static_cast<uint8_t>(y), static_cast<uint8_t>(100 + index));
        }
    }
    Image<uint16_t> depths(depth);
    for (uint32_t y = 0; y < depth.height; ++y) {
        for (uint32_t x = 0; x < depth.width; ++x) depths.at(x, y) = static_cast<uint16_t>(1000 + 100 * index + x + y);
    }
    depths.at(0, 0) = 0;
    frame.color = std::move(colors);
    frame.depth = std::move(depths);
    frame.world_from_camera = RigidTransform(1.0);
    (*frame.world_from_camera)[3].x = 0.1 * index;
    return frame;
}

Intrinsics test_camera(Extent2D extent) {
    const double f = 0.866 * extent.width;
    return {extent, f, f, 0.5 * (extent.width - 1), 0.5 * (extent.height - 1), {}};
}

SequenceInfo test_info() {
    SequenceInfo info;
    info.name = "test";
    info.format = "patina-sequence";
    info.color = test_camera({32, 24});
    info.depth = test_camera({16, 12});
    info.has_poses = info.exposure_known = true;
    return info;
}

MemorySource::MemorySource(SequenceInfo info, std::vector<Reading> readings)
    : info_(std::move(info)), readings_(std::move(readings)) {
    info_.frames = static_cast<uint32_t>(readings_.size());
}

std::optional<Reading> MemorySource::next() {
    if (next_ == readings_.size()) return std::nullopt;
    return readings_[next_++];
}

std::vector<Reading> test_readings(uint32_t frames) {
    std::vector<Reading> readings;
    for (uint32_t i = 0; i < frames; ++i) readings.push_back(test_frame(i, {32, 24}, {16, 12}));
    return readings;
}

void write_native(const fs::path& folder, uint32_t frames) {
    SequenceWriter writer(folder, test_info());
    for (const Reading& reading : test_readings(frames)) writer.write(std::get<Frame>(reading));
    writer.finish();
}

void write_seven_scenes(const fs::path& folder, const std::vector<uint32_t>& numbers) {
    fs::create_directories(folder);
    for (uint32_t i = 0; i < numbers.size(); ++i) {
        const Frame frame = test_frame(i, {640, 480}, {640, 480});
        const std::string stem = (folder / ("frame-" + picture_stem(numbers[i]))).string();
        write_jpeg(stem + ".color.jpg", std::get<Image<SrgbPixel>>(frame.color));
        write_png(stem + ".depth.png", std::get<Image<uint16_t>>(frame.depth));
        write_text(stem + ".pose.txt", text("1 0 0 ", 0.1 * i, "\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"));
    }
}

void write_tum(const fs::path& folder, uint32_t frames) {
    fs::create_directories(folder / "rgb");
    fs::create_directories(folder / "depth");
    std::string rgb = "# timestamp filename\n", depth = rgb, poses = "# timestamp tx ty tz qx qy qz qw\n";
    for (uint32_t i = 0; i < frames; ++i) {
        const Frame frame = test_frame(i, {640, 480}, {640, 480});
        const std::string name = picture_stem(i) + ".png";
        write_png(folder / "rgb" / name, std::get<Image<SrgbPixel>>(frame.color));
        write_png(folder / "depth" / name, std::get<Image<uint16_t>>(frame.depth));
        depth += text(10 + 0.1 * i, " depth/", name, "\n");
        rgb += text(10.01 + 0.1 * i, " rgb/", name, "\n");
        poses += text(10.005 + 0.1 * i, " ", i, " 0 0 0 0 0 1\n");
    }
    write_text(folder / "rgb.txt", rgb);
    write_text(folder / "depth.txt", depth);
    write_text(folder / "groundtruth.txt", poses);
}

void write_text(const fs::path& file, const std::string& content) {
    std::ofstream(file, std::ios::binary) << content;
    if (read_text(file) != content) throw Error(file.string(), " cannot be written");
}

std::string read_text(const fs::path& file) {
    std::ostringstream content;
    content << std::ifstream(file, std::ios::binary).rdbuf();
    return content.str();
}

void replace_text(const fs::path& file, const std::string& from, const std::string& to) {
    std::string content = read_text(file);
    const size_t at = content.find(from);
    if (at == std::string::npos || content.find(from, at + 1) != std::string::npos) {
        throw Error(file.string(), " does not hold '", from, "' exactly once");
    }
    write_text(file, content.replace(at, from.size(), to));
}

void write_jpeg(const fs::path& file, const Image<SrgbPixel>& image) {
    cv::Mat bgr(static_cast<int>(image.extent().height), static_cast<int>(image.extent().width), CV_8UC3);
    for (size_t i = 0; i < image.pixels().size(); ++i) {
        const SrgbPixel pixel = image.pixels()[i];
        bgr.at<cv::Vec3b>(static_cast<int>(i) / bgr.cols, static_cast<int>(i) % bgr.cols) = {pixel.b, pixel.g, pixel.r};
    }
    if (!cv::imwrite(file.string(), bgr, {cv::IMWRITE_JPEG_QUALITY, 95}))
        throw Error(file.string(), " cannot be written");
}

void shorten(const fs::path& file, size_t bytes) { fs::resize_file(file, fs::file_size(file) - bytes); }

std::vector<Reading> read_all(Source& source) {
    std::vector<Reading> readings;
    while (auto reading = source.next()) readings.push_back(std::move(*reading));
    return readings;
}

std::string error_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    ADD_FAILURE() << "no Error was thrown";
    return {};
}

std::string only_skip_reason(const fs::path& folder, uint32_t index) {
    std::string reason;
    for (const Reading& reading : read_all(*open_sequence(folder))) {
        const auto* skipped = std::get_if<Skipped>(&reading);
        if (!skipped) continue;
        EXPECT_EQ(skipped->index, index) << skipped->reason;
        if (skipped->index == index) reason = skipped->reason;
    }
    EXPECT_NE(reason, "") << "frame " << index << " was not skipped";
    return reason;
}

}  // namespace patina::sensor::testing
