#include "tools/export/video.h"

#include <system_error>
#include <utility>

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "engine/core/error.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

int codec_of(const fs::path& file) {
    if (file.extension() == ".avi") return cv::VideoWriter::fourcc('M', 'J', 'P', 'G');
    if (file.extension() == ".mp4") return cv::VideoWriter::fourcc('m', 'p', '4', 'v');
    throw Error("the video '", file.string(), "' must be a .avi or a .mp4");
}

}  // namespace

struct VideoWriter::Encoder {
    cv::VideoWriter writer;
};

VideoWriter::VideoWriter(fs::path file, Extent2D extent, double fps)
    : file_(std::move(file)),
      partial_(file_.parent_path() / (".patina-partial-" + file_.filename().string())),
      extent_(extent),
      encoder_(std::make_unique<Encoder>()) {
    const int codec = codec_of(file_);
    const fs::path parent = fs::absolute(file_).parent_path();
    if (!fs::is_directory(parent))
        throw Error("the video '", file_.string(), "' cannot be written: there is no folder '", parent.string(), "'");
    if (fs::is_directory(file_)) throw Error("the video '", file_.string(), "' cannot be written: it is a folder");
    const cv::Size size(static_cast<int>(extent.width), static_cast<int>(extent.height));
    if (!encoder_->writer.open(partial_.string(), codec, fps, size)) {
        throw Error("the video '", file_.string(), "' of ", extent, " pixels at ", fps,
                    " frames a second cannot be written: there is no encoder for it, or its folder is read-only");
    }
}

VideoWriter::~VideoWriter() {
    encoder_->writer.release();
    std::error_code ignored;
    fs::remove(partial_, ignored);
}

void VideoWriter::write(const Drawing& frame) {
    PATINA_ASSERT(frame.extent() == extent_, "frame ", frame.extent(), ", video ", extent_);
    const cv::Mat rgb(static_cast<int>(extent_.height), static_cast<int>(extent_.width), CV_8UC3,
                      const_cast<sensor::SrgbPixel*>(frame.pixels().data()));
    cv::Mat bgr;
    cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
    encoder_->writer.write(bgr);
}

void VideoWriter::finish() {
    encoder_->writer.release();
    std::error_code failure;
    fs::rename(partial_, file_, failure);
    if (failure) throw Error("the video '", file_.string(), "' cannot be put in place: ", failure.message());
}

}  // namespace patina
