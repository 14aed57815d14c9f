#include <algorithm>
#include <chrono>
#include <cstring>
#include <initializer_list>  // which OpenNI.h lacks
#include <optional>
#include <thread>
#include <utility>
// The library's own headers.
#include <OpenNI.h>

#include "engine/core/error.h"
#include "sensor/camera_view.h"
#include "sensor/live/depth_watch.h"
#include "sensor/live/other_cameras.h"

namespace patina::sensor {

namespace {

constexpr int kPatience_ms = 100;
constexpr std::chrono::milliseconds kLastPicture(150);  // several at 30 a second
constexpr int kWidth = 640, kHeight = 480, kFps = 30;

/// Initialised once. It is never shut down: threads of its drivers outlive that, and then run code that is gone.
void expect_library() {
    static const openni::Status status = [] {
        oniSetLogConsoleOutput(false);
        oniSetLogFileOutput(false);
        return openni::OpenNI::initialize();
    }();
    if (status != openni::STATUS_OK) throw Error("OpenNI2 cannot be initialised: ", openni::OpenNI::getExtendedError());
}

[[noreturn]] void fail(const std::string& what) {
    std::string reason = openni::OpenNI::getExtendedError();
    constexpr const char* kBlank = " \t\n";
    reason.erase(reason.find_last_not_of(kBlank) + 1);
    reason.erase(0, std::min(reason.find_first_not_of(kBlank), reason.size()));
    throw Error(what, reason.empty() ? "" : ": ", reason);
}

/// The mode of 640 x 480 at 30 a second where the sensor has it, else its present one.
void choose_mode(openni::VideoStream& stream, std::initializer_list<openni::PixelFormat> formats) {
    const auto& modes = stream.getSensorInfo().getSupportedVideoModes();
    for (const openni::PixelFormat format : formats) {
        for (int i = 0; i < modes.getSize(); ++i) {
            const openni::VideoMode& mode = modes[i];
            if (mode.getPixelFormat() != format || mode.getResolutionX() != kWidth ||
                mode.getResolutionY() != kHeight || mode.getFps() != kFps)
                continue;
            if (stream.setVideoMode(mode) == openni::STATUS_OK) return;
        }
    }
}

Intrinsics camera_of(const openni::VideoStream& stream) {
    const openni::VideoMode mode = stream.getVideoMode();
    const Extent2D extent{static_cast<uint32_t>(mode.getResolutionX()), static_cast<uint32_t>(mode.getResolutionY())};
    return intrinsics_of(extent, glm::dvec2(stream.getHorizontalFieldOfView(), stream.getVerticalFieldOfView()));
}

/// Pictures as in a mirror are mirrored back where the driver does not do that.
template <class Pixel, class Read>
Image<Pixel> copied(const openni::VideoFrameRef& frame, bool mirrored, const Read& read) {
    const Extent2D extent{static_cast<uint32_t>(frame.getWidth()), static_cast<uint32_t>(frame.getHeight())};
    Image<Pixel> picture(extent);
    for (uint32_t y = 0; y < extent.height; ++y) {
        const auto* row = static_cast<const uint8_t*>(frame.getData()) + size_t{y} * frame.getStrideInBytes();
        for (uint32_t x = 0; x < extent.width; ++x) picture.at(mirrored ? extent.width - 1 - x : x, y) = read(row, x);
    }
    return picture;
}

class OpenNi2Camera : public PictureCamera {
  public:
    explicit OpenNi2Camera(const std::string& uri) {
        expect_library();
        if (device_.open(uri.empty() ? openni::ANY_DEVICE : uri.c_str()) != openni::STATUS_OK)
            fail(uri.empty() ? "no camera of OpenNI2 can be opened" : "the camera '" + uri + "' cannot be opened");
        if (depth_.create(device_, openni::SENSOR_DEPTH) != openni::STATUS_OK ||
            color_.create(device_, openni::SENSOR_COLOR) != openni::STATUS_OK)
            fail("the camera of OpenNI2 has no depth, or no colour");
        choose_mode(depth_, {openni::PIXEL_FORMAT_DEPTH_1_MM, openni::PIXEL_FORMAT_DEPTH_100_UM});
        choose_mode(color_, {openni::PIXEL_FORMAT_RGB888});
        depth_.setMirroringEnabled(false);
        color_.setMirroringEnabled(false);
        const bool registered = register_depth();
        const openni::PixelFormat format = depth_.getVideoMode().getPixelFormat();
        if (format != openni::PIXEL_FORMAT_DEPTH_1_MM && format != openni::PIXEL_FORMAT_DEPTH_100_UM)
            throw Error("the camera's depth has the pixel format ", format, " of OpenNI2, must be 100 or 101");
        if (color_.getVideoMode().getPixelFormat() != openni::PIXEL_FORMAT_RGB888)
            throw Error("the camera's colour has the pixel format ", color_.getVideoMode().getPixelFormat(),
                        " of OpenNI2, must be 200 (RGB)");
        info_.name = device_.getDeviceInfo().getName();
        if (info_.name.empty()) info_.name = "openni2";
        info_.format = "openni2";
        info_.fps = std::max(1, depth_.getVideoMode().getFps());
        info_.color = camera_of(color_);
        info_.depth = registered ? scaled_to(info_.color, camera_of(depth_).extent) : camera_of(depth_);
        info_.metres_per_unit = format == openni::PIXEL_FORMAT_DEPTH_100_UM ? 0.0001 : 0.001;
    }

    ~OpenNi2Camera() override {
        depth_.destroy();
        color_.destroy();
        device_.close();
    }

    const SequenceInfo& info() const override { return info_; }

    void run(const PictureSink& sink, const std::stop_token& stop) override {
        const Streaming streaming(depth_, color_);
        if (depth_.start() != openni::STATUS_OK || color_.start() != openni::STATUS_OK)
            fail("the camera of OpenNI2 does not start");
        openni::VideoStream* streams[] = {&depth_, &color_};
        DepthWatch watch;
        while (!stop.stop_requested()) {
            int which = 0;
            const openni::Status status = openni::OpenNI::waitForAnyStream(streams, 2, &which, kPatience_ms);
            const bool silent = status == openni::STATUS_TIME_OUT;
            if (silent || which != 0) watch.expect("the camera of OpenNI2");
            if (silent) continue;
            openni::VideoFrameRef frame;
            if (status != openni::STATUS_OK || streams[which]->readFrame(&frame) != openni::STATUS_OK)
                fail("the camera of OpenNI2 failed, or was unplugged");
            if (which == 0) watch.heard();
            give(frame, which == 0, sink);
        }
    }

  private:
    /// However run() ends, both streams have stopped afterwards. A driver's thread may be on its way with one more
    /// picture then (that of the dummy device is never waited for), and the library must still be there for it.
    class Streaming {
      public:
        Streaming(openni::VideoStream& depth, openni::VideoStream& color) : depth_(depth), color_(color) {}
        ~Streaming() {
            depth_.stop();
            color_.stop();
            std::this_thread::sleep_for(kLastPicture);
        }
        Streaming(const Streaming&) = delete;
        Streaming& operator=(const Streaming&) = delete;

      private:
        openni::VideoStream& depth_;
        openni::VideoStream& color_;
    };

    bool register_depth() {
        constexpr auto kMode = openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR;
        return device_.isImageRegistrationModeSupported(kMode) &&
               device_.setImageRegistrationMode(kMode) == openni::STATUS_OK;
    }

    void give(const openni::VideoFrameRef& frame, bool is_depth, const PictureSink& sink) const {
        const double timestamp_s = static_cast<double>(frame.getTimestamp()) / 1e6;
        if (is_depth) {
            sink.depth(timestamp_s,
                       copied<uint16_t>(frame, depth_.getMirroringEnabled(), [](const uint8_t* row, uint32_t x) {
                           uint16_t value;
                           std::memcpy(&value, row + 2 * x, 2);
                           return value;
                       }));
        } else {
            sink.color(timestamp_s,
                       copied<SrgbPixel>(frame, color_.getMirroringEnabled(), [](const uint8_t* row, uint32_t x) {
                           return SrgbPixel(row[3 * x], row[3 * x + 1], row[3 * x + 2]);
                       }));
        }
    }

    openni::Device device_;
    openni::VideoStream depth_, color_;
    SequenceInfo info_;
};

}  // namespace

std::unique_ptr<PictureCamera> open_openni2(const std::string& uri) { return std::make_unique<OpenNi2Camera>(uri); }

std::string openni2_report() {
    std::string report = "OpenNI2\n";
    try {
        expect_library();
        openni::Array<openni::DeviceInfo> devices;
        openni::OpenNI::enumerateDevices(&devices);
        if (devices.getSize() == 0) report += "  connected         none\n";
        for (int i = 0; i < devices.getSize(); ++i)
            report += text("  connected         ", devices[i].getVendor(), " ", devices[i].getName(),
                           ": openni2:", devices[i].getUri(), "\n");
    } catch (const Error& error) {
        report += text("  connected         unknown: ", error.what(), "\n");
    }
    return report;
}

}  // namespace patina::sensor
