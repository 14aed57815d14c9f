#include "sensor/write_sequence.h"

#include <algorithm>
#include <cmath>
#include <system_error>

#include "engine/core/error.h"
#include "engine/core/srgb.h"
#include "sensor/files/exr_file.h"
#include "sensor/files/picture_file.h"
#include "sensor/files/text_file.h"
#include "sensor/sequence_json.h"

namespace patina::sensor {
namespace {

namespace fs = std::filesystem;

/// Linear 0..1 to an 8-bit code.
uint8_t srgb_code(float linear) {
    const double v = std::isnan(linear) ? 0.0 : std::clamp(static_cast<double>(linear), 0.0, 1.0);
    return static_cast<uint8_t>(std::lround(255 * srgb_encoded(v)));
}

Image<SrgbPixel> encoded(const Image<glm::vec3>& linear) {
    Image<SrgbPixel> codes(linear.extent());
    std::transform(linear.pixels().begin(), linear.pixels().end(), codes.pixels().begin(),
                   [](glm::vec3 v) { return SrgbPixel(srgb_code(v.r), srgb_code(v.g), srgb_code(v.b)); });
    return codes;
}

/// Writes a colour picture to `stem` with the extension that fits.
void write_color(fs::path stem, const ColorImage& color, LinearColor linear_color) {
    const auto* linear = std::get_if<Image<glm::vec3>>(&color);
    if (linear && linear_color == LinearColor::kExr) return write_exr_color(stem += ".exr", *linear);
    write_png(stem += ".png", linear ? encoded(*linear) : std::get<Image<SrgbPixel>>(color));
}

Image<uint16_t> in_units(const Image<float>& depth_m, double metres_per_unit) {
    Image<uint16_t> units(depth_m.extent());
    std::transform(depth_m.pixels().begin(), depth_m.pixels().end(), units.pixels().begin(), [&](float z) {
        const double unit = std::round(z / metres_per_unit);
        return unit > 0 && unit <= 65535 ? static_cast<uint16_t>(unit) : uint16_t{0};  // false for NaN, too
    });
    return units;
}

void write_depth(fs::path stem, const DepthImage& depth, double metres_per_unit) {
    const auto* depth_m = std::get_if<Image<float>>(&depth);
    write_png(stem += ".png", depth_m ? in_units(*depth_m, metres_per_unit) : std::get<Image<uint16_t>>(depth));
}

template <class Picture>
void expect_extent(const fs::path& stem, const Picture& picture, Extent2D expected) {
    const Extent2D extent = std::visit([](const auto& image) { return image.extent(); }, picture);
    if (extent != expected)
        throw Error(stem.string(), ": the frame is ", extent, " pixels, but the sequence ", expected);
}

}  // namespace

SequenceWriter::SequenceWriter(const fs::path& folder, SequenceInfo info, LinearColor linear_color)
    : folder_(folder), info_(std::move(info)), linear_color_(linear_color) {
    std::error_code failure;
    for (const char* part : {"color", "depth"}) {
        fs::create_directories(partial_folder() / part, failure);
        if (failure) throw Error((partial_folder() / part).string(), " cannot be created: ", failure.message());
    }
}

SequenceWriter::~SequenceWriter() { background_.abandon(); }

void SequenceWriter::write(Frame frame) {
    PATINA_ASSERT(!finished_, "frame ", frame.index, " of ", folder_.path().string());
    if (frame.index != timestamps_s_.size()) {
        throw Error(folder_.path().string(), ": frame ", frame.index, " was to be written, but ", timestamps_s_.size(),
                    " is next");
    }
    const fs::path color = partial_folder() / "color" / picture_stem(frame.index);
    const fs::path depth = partial_folder() / "depth" / picture_stem(frame.index);
    expect_extent(color, frame.color, info_.color.extent);
    expect_extent(depth, frame.depth, info_.depth.extent);
    timestamps_s_.push_back(frame.timestamp_s);
    exposures_.push_back(frame.exposure);
    if (frame.world_from_camera) poses_.push_back({frame.timestamp_s, *frame.world_from_camera});
    background_.start([color, depth, this, frame = std::move(frame)] {
        write_color(color, frame.color, linear_color_);
        write_depth(depth, frame.depth, info_.metres_per_unit);
    });
}

void SequenceWriter::finish() {
    PATINA_ASSERT(!finished_, folder_.path().string());
    if (timestamps_s_.empty()) throw Error(folder_.path().string(), " would have 0 frames; at least 1 must be written");
    background_.finish();
    write_lists();
    write_sequence_file();
    folder_.finish();
    finished_ = true;
}

void SequenceWriter::write_lists() const {
    bool regular = true;
    std::string timestamps = "# index timestamp\n";
    std::string exposures = "# index exposure_s gain\n";
    for (size_t i = 0; i < timestamps_s_.size(); ++i) {
        regular = regular && timestamps_s_[i] == static_cast<double>(i) / info_.fps;
        timestamps += text(i, " ", shortest(timestamps_s_[i]), "\n");
        exposures += text(i, " ", shortest(exposures_[i].exposure_s), " ", shortest(exposures_[i].gain), "\n");
    }
    if (!regular) write_bytes(partial_folder() / "timestamps.txt", timestamps);
    const bool varies = info_.exposure_known && std::adjacent_find(exposures_.begin(), exposures_.end(),
                                                                   std::not_equal_to{}) != exposures_.end();
    if (varies) write_bytes(partial_folder() / "exposures.txt", exposures);
    if (!poses_.empty()) write_trajectory(partial_folder() / "trajectory.txt", poses_);
}

void SequenceWriter::write_sequence_file() const {
    SequenceInfo info = info_;
    info.frames = static_cast<uint32_t>(timestamps_s_.size());
    const auto root = sequence_json(info, exposures_.front());
    write_bytes(partial_folder() / "sequence.json",
                root.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace patina::sensor
