#include "tools/report/video.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <opencv2/videoio/registry.hpp>

#include "engine/core/error.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

/// In the order in which they are tried: browsers play H.264, which not every FFmpeg encodes, and no MPEG-4 Visual.
std::vector<int> codecs_of(const fs::path& file) {
    using cv::VideoWriter;
    if (file.extension() == ".avi") return {VideoWriter::fourcc('M', 'J', 'P', 'G')};
    if (file.extension() == ".mp4")
        return {VideoWriter::fourcc('a', 'v', 'c', '1'), VideoWriter::fourcc('m', 'p', '4', 'v')};
    throw Error("the video '", file.string(), "' must be a .avi or a .mp4");
}

/// Without FFmpeg, OpenCV writes and reads Motion JPEG itself. Where it is left to choose, backends that cannot print
/// to standard error.
int backend_for(const fs::path& file) {
    if (cv::videoio_registry::hasBackend(cv::CAP_FFMPEG)) return cv::CAP_FFMPEG;
    return file.extension() == ".avi" ? cv::CAP_OPENCV_MJPEG : cv::CAP_ANY;
}

const fs::path& checked(const fs::path& file) {
    codecs_of(file);
    return file;
}

}  // namespace

struct VideoWriter::Encoder {
    cv::VideoWriter writer;
};

VideoWriter::VideoWriter(const fs::path& file, Extent2D extent, double fps, const std::vector<fs::path>& inputs)
    : file_(checked(file), inputs), extent_(extent), encoder_(std::make_unique<Encoder>()) {
    const cv::Size size(static_cast<int>(extent.width), static_cast<int>(extent.height));
    const auto opens = [&](int codec) {
        return encoder_->writer.open(file_.partial_path().string(), backend_for(file), codec, fps, size);
    };
    if (!std::ranges::any_of(codecs_of(file), opens)) {
        throw Error("the video '", file.string(), "' of ", extent, " pixels at ", fps,
                    " frames a second cannot be written: there is no encoder for it, or no space left on the disk");
    }
}

VideoWriter::~VideoWriter() { encoder_->writer.release(); }

void VideoWriter::write(const Drawing& frame) {
    PATINA_ASSERT(frame.extent() == extent_, "frame ", frame.extent(), ", video ", extent_);
    const cv::Mat rgb(static_cast<int>(extent_.height), static_cast<int>(extent_.width), CV_8UC3,
                      const_cast<SrgbPixel*>(frame.pixels().data()));
    cv::Mat bgr;
    cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
    encoder_->writer.write(bgr);
    ++frames_;
}

void VideoWriter::finish() {
    encoder_->writer.release();
    expect_whole();
    file_.finish();
}

void VideoWriter::expect_whole() const {
    cv::VideoCapture written(file_.partial_path().string(), backend_for(file_.path()));
    uint64_t found = 0;
    while (found < frames_ && written.isOpened() && written.grab()) ++found;
    if (found == frames_) return;
    throw Error("the video '", file_.path().string(), "' holds ", found, " frames, but ", frames_,
                " were written: is there no space left on the disk?");
}

}  // namespace patina
