#include "sensor/readers/oni.h"

#include <algorithm>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "sensor/associate.h"
#include "sensor/camera_view.h"
#include "sensor/files/picture_file.h"
#include "sensor/readers/folder_source.h"
#include "sensor/readers/oni_depth.h"
#include "sensor/readers/oni_file.h"

namespace patina::sensor {

namespace {

// OpenNI2's numbers of what a pixel is; OpenNI 1 wrote none.
constexpr uint64_t kMillimetres = 100, kTenthsOfThem = 101, kRgb = 200, kJpeg = 204;

template <class Pixel>
void mirror(Image<Pixel>& image) {
    const auto width = static_cast<std::ptrdiff_t>(image.extent().width);
    for (auto row = image.pixels().begin(); row != image.pixels().end(); row += width) std::reverse(row, row + width);
}

class OniSource : public FolderSource {
  public:
    explicit OniSource(const std::filesystem::path& file) : name_(file.string()), file_(file) {
        if (!file_.depth() || !file_.color())
            throw Error(name_, " has no ", file_.depth() ? "colour" : "depth", " pictures");
        const OniStream &depth = *file_.depth(), &color = *file_.color();
        check(depth, "depth");
        check(color, "colour");
        const bool registered = depth.extent == color.extent;
        info_.name = folder_name(file);
        info_.format = "oni";
        info_.frames = static_cast<uint32_t>(depth.places.size());
        info_.fps = std::max(1u, depth.fps);
        info_.color = intrinsics_of(color.extent, color.view_rad);
        info_.depth = registered ? info_.color : intrinsics_of(depth.extent, depth.view_rad);
        info_.metres_per_unit = depth.pixel_format == kTenthsOfThem ? 0.0001 : 0.001;
        color_of_frame_ = associate(depth.timestamps_s, color.timestamps_s, kOniMostApart_s);
    }

  private:
    void check(const OniStream& stream, const char* kind) const {
        if (stream.places.empty()) throw Error(name_, " has no ", kind, " pictures");
        check_picture_size(name_, stream.extent.width, stream.extent.height);
        const bool is_depth = &stream == &*file_.depth();
        const auto& codec = stream.codec;
        const bool known_codec = is_depth
                                     ? stream.has_codec("16zT") || stream.has_codec("16zP") || stream.has_codec("NONE")
                                     : stream.has_codec("NONE") || stream.has_codec("JPEG");
        if (!known_codec)
            throw Error(name_, ": ", kind, " pictures are compressed by '", std::string(codec.begin(), codec.end()),
                        "', which is not known");
        const uint64_t format = stream.pixel_format;
        const bool known_format = format == 0 || (is_depth ? format == kMillimetres || format == kTenthsOfThem
                                                           : format == kRgb || format == kJpeg);
        if (!known_format)
            throw Error(name_, ": ", kind, " pictures have the pixel format ", format, " of OpenNI2, must be ",
                        is_depth ? "100 or 101 (depth)" : "200 (RGB) or 204 (JPEG)");
    }

    Frame decode(uint32_t index) const override {
        const OniStream &depth = *file_.depth(), &color = *file_.color();
        Frame frame;
        frame.index = index;
        frame.timestamp_s = depth.timestamps_s[index];
        if (!color_of_frame_[index])
            throw Error(name_, ": depth picture ", index, " has no colour picture within ", kOniMostApart_s, " s");
        frame.depth = decode_depth_picture(depth, depth.places[index], text(name_, ": depth picture ", index));
        const size_t its_color = *color_of_frame_[index];
        frame.color = decode_color_picture(color, color.places[its_color], text(name_, ": colour picture ", its_color));
        return frame;
    }

    static void expect_bytes(const std::vector<uint8_t>& bytes, size_t expected, const std::string& where) {
        if (bytes.size() != expected) throw Error(where, " has ", bytes.size(), " bytes, not ", expected);
    }

    Image<uint16_t> decode_depth_picture(const OniStream& stream, const OniStream::Place& place,
                                         const std::string& where) const {
        const std::vector<uint8_t> bytes = file_.read(place);
        std::vector<uint16_t> pixels;
        if (stream.has_codec("NONE")) {
            expect_bytes(bytes, 2 * stream.extent.area(), where);
            pixels.resize(stream.extent.area());
            std::copy(bytes.begin(), bytes.end(), reinterpret_cast<uint8_t*>(pixels.data()));
        } else {
            try {
                pixels = decode_oni_depth(bytes, stream.extent.area(), stream.has_codec("16zT"));
            } catch (const Error& error) {
                throw Error(where, " ", error.what());
            }
        }
        Image<uint16_t> image(stream.extent, std::move(pixels));
        if (stream.mirrored) mirror(image);
        return image;
    }

    ColorImage decode_color_picture(const OniStream& stream, const OniStream::Place& place,
                                    const std::string& where) const {
        const std::vector<uint8_t> bytes = file_.read(place);
        if (stream.has_codec("JPEG") || stream.pixel_format == kJpeg) {
            ColorImage image = decode_color(where, bytes, stream.extent);
            if (stream.mirrored) std::visit([](auto& pixels) { mirror(pixels); }, image);
            return image;
        }
        expect_bytes(bytes, 3 * stream.extent.area(), where);
        Image<SrgbPixel> image(stream.extent);
        for (size_t i = 0; i < image.pixels().size(); ++i)
            image.pixels()[i] = {bytes[3 * i], bytes[3 * i + 1], bytes[3 * i + 2]};
        if (stream.mirrored) mirror(image);
        return image;
    }

    std::string name_;
    OniFile file_;
    std::vector<std::optional<size_t>> color_of_frame_;
};

}  // namespace

std::unique_ptr<Source> open_oni(const std::filesystem::path& file) { return std::make_unique<OniSource>(file); }

}  // namespace patina::sensor
