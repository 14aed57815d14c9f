#pragma once

#include <filesystem>
#include <memory>

#include "tools/export/drawing.h"

namespace patina {

/// Writes a video, which appears whole or not at all: Motion JPEG in .avi, MPEG-4 in .mp4.
class VideoWriter {
  public:
    /// Throws Error when the file's extension is another, there is no folder for it, or there is no encoder.
    VideoWriter(std::filesystem::path file, Extent2D extent, double fps);
    /// Removes what was written, unless finish() was called.
    ~VideoWriter();

    /// Appends a frame of the video's extent.
    void write(const Drawing& frame);

    /// Puts the file in its place. Throws Error when that fails.
    void finish();

  private:
    struct Encoder;
    std::filesystem::path file_, partial_;
    Extent2D extent_;
    std::unique_ptr<Encoder> encoder_;
};

}  // namespace patina
