#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <optional>
#include <utility>

#include <libfreenect.h>
#include <sys/time.h>

#include "engine/core/error.h"
#include "sensor/live/depth_watch.h"
#include "sensor/live/other_cameras.h"
#include "sensor/live/wrapping_clock.h"

namespace patina::sensor {

namespace {

constexpr Extent2D kExtent{640, 480};
constexpr double kTicksPerSecond = 60e6;
constexpr int kPatience_us = 100'000;

struct CloseContext {
    void operator()(freenect_context* context) const { freenect_shutdown(context); }
};
using Context = std::unique_ptr<freenect_context, CloseContext>;

Context open_library() {
    freenect_context* context = nullptr;
    if (freenect_init(&context, nullptr) < 0) throw Error("libfreenect cannot reach USB");
    freenect_set_log_level(context, FREENECT_LOG_FATAL);
    freenect_select_subdevices(context, FREENECT_DEVICE_CAMERA);
    return Context(context);
}

/// The library's mode of 640 x 480 with this depth; empty where it has none. Debian's fakenect has 11 bits alone, and
/// aborts where it is asked for others by name.
std::optional<freenect_frame_mode> depth_mode(freenect_depth_format format) {
    for (int i = 0; i < freenect_get_depth_mode_count(); ++i) {
        const freenect_frame_mode mode = freenect_get_depth_mode(i);
        if (mode.is_valid && mode.resolution == FREENECT_RESOLUTION_MEDIUM && mode.depth_format == format) return mode;
    }
    return std::nullopt;
}

Intrinsics camera_of(double focal_px) {
    return {kExtent, focal_px, focal_px, (kExtent.width - 1) / 2.0, (kExtent.height - 1) / 2.0, {}};
}

/// Millimetres of 11 bits of disparity, of a nominal device: S. Magnenat's fit, in OpenKinect's wiki.
uint16_t millimetres_of(uint16_t raw) {
    constexpr uint16_t kNone = 1084;  // from here on the fit goes to infinity; 2047 is no reading
    if (raw >= kNone) return 0;
    return static_cast<uint16_t>(std::lround(123.6 * std::tan(raw / 2842.5 + 1.1863)));
}

class Kinect1Camera : public PictureCamera {
  public:
    Kinect1Camera() : context_(open_library()) {
        if (freenect_num_devices(context_.get()) < 1) throw Error("no Kinect v1 is connected");
        freenect_device* device = nullptr;
        if (freenect_open_device(context_.get(), &device, 0) < 0)
            throw Error(
                "the Kinect v1 cannot be opened: another program has it, or this user may not use it (libfreenect0.5 "
                "has the udev rule)");
        device_.reset(device);
        const auto video = freenect_find_video_mode(FREENECT_RESOLUTION_MEDIUM, FREENECT_VIDEO_RGB);
        const auto registered = depth_mode(FREENECT_DEPTH_REGISTERED);
        const auto depth = registered ? registered : depth_mode(FREENECT_DEPTH_11BIT);
        if (!depth || freenect_set_video_mode(device, video) < 0 || freenect_set_depth_mode(device, *depth) < 0)
            throw Error("the Kinect v1 does not send colour and depth of 640 x 480 pixels");
        is_raw_ = !registered;
        freenect_set_user(device, this);
        freenect_set_depth_callback(device, [](freenect_device* from, void* pixels, uint32_t ticks) {
            static_cast<Kinect1Camera*>(freenect_get_user(from))->take_depth(pixels, ticks);
        });
        freenect_set_video_callback(device, [](freenect_device* from, void* pixels, uint32_t ticks) {
            static_cast<Kinect1Camera*>(freenect_get_user(from))->take_color(pixels, ticks);
        });
        info_.name = "kinect1";
        info_.format = "kinect1";
        info_.color = info_.depth = camera_of(kKinect1Focal_px);
        info_.metres_per_unit = 0.001;
        if (!is_raw_) return;
        info_.depth = camera_of(kKinect1DepthFocal_px);
        info_.color_from_depth[3].x = -kKinect1Baseline_m;
    }

    const SequenceInfo& info() const override { return info_; }

    void run(const PictureSink& sink, const std::stop_token& stop) override {
        const Streaming streaming(*this, sink);
        if (freenect_start_depth(device_.get()) < 0 || freenect_start_video(device_.get()) < 0)
            throw Error("the Kinect v1 does not start: it needs its own power supply, and a USB 2 bus of its own");
        watch_.heard();
        while (!stop.stop_requested()) {
            timeval patience{0, kPatience_us};
            const int result = freenect_process_events_timeout(context_.get(), &patience);
            if (failure_) std::rethrow_exception(failure_);
            if (result < 0) throw Error("the Kinect v1 was unplugged, or USB failed");
            watch_.expect("the Kinect v1");
        }
    }

  private:
    struct CloseDevice {
        void operator()(freenect_device* device) const { freenect_close_device(device); }
    };

    /// While this lives, the sink is given what comes. However run() ends, both streams have stopped afterwards.
    class Streaming {
      public:
        Streaming(Kinect1Camera& camera, const PictureSink& sink) : camera_(camera) { camera_.sink_ = &sink; }
        ~Streaming() {
            camera_.sink_ = nullptr;  // to stop a stream takes what is still under way
            freenect_stop_depth(camera_.device_.get());
            freenect_stop_video(camera_.device_.get());
        }
        Streaming(const Streaming&) = delete;
        Streaming& operator=(const Streaming&) = delete;

      private:
        Kinect1Camera& camera_;
    };

    void take_depth(const void* pixels, uint32_t ticks) {
        watch_.heard();
        take([&] {
            Image<uint16_t> picture(kExtent);
            std::memcpy(picture.pixels().data(), pixels, 2 * picture.pixels().size());
            if (is_raw_) std::ranges::transform(picture.pixels(), picture.pixels().begin(), millimetres_of);
            sink_->depth(clock_.seconds(0, ticks), std::move(picture));
        });
    }

    void take_color(const void* pixels, uint32_t ticks) {
        take([&] {
            Image<SrgbPixel> picture(kExtent);
            const auto* bytes = static_cast<const uint8_t*>(pixels);
            for (SrgbPixel& pixel : picture.pixels()) {
                pixel = {bytes[0], bytes[1], bytes[2]};
                bytes += 3;
            }
            sink_->color(clock_.seconds(1, ticks), std::move(picture));
        });
    }

    /// No exception may pass through the library, which is C.
    template <class Take>
    void take(const Take& picture) {
        if (!sink_) return;
        try {
            picture();
        } catch (...) {
            failure_ = std::current_exception();
        }
    }

    Context context_;
    std::unique_ptr<freenect_device, CloseDevice> device_;
    SequenceInfo info_;
    bool is_raw_ = false;
    WrappingClock clock_{kTicksPerSecond};
    // Of the thread of run().
    const PictureSink* sink_ = nullptr;  ///< null while nothing is asked for
    DepthWatch watch_;
    std::exception_ptr failure_;
};

}  // namespace

std::unique_ptr<PictureCamera> open_kinect1() { return std::make_unique<Kinect1Camera>(); }

std::string kinect1_report() {
    std::string report = "Kinect v1\n";
    try {
        const Context context = open_library();
        const int count = freenect_num_devices(context.get());
        report += text("  connected         ", count < 1 ? "none" : std::to_string(count), "\n");
    } catch (const Error& error) {
        report += text("  connected         unknown: ", error.what(), "\n");
    }
    return report;
}

}  // namespace patina::sensor
