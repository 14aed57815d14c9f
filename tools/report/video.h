#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "sensor/output/output_file.h"
#include "tools/report/drawing.h"

namespace patina {

/// Writes a video, which appears whole or not at all: Motion JPEG in .avi; in .mp4 H.264, or MPEG-4 where FFmpeg does
/// not encode that.
class VideoWriter {
  public:
    /// Throws Error when the file's extension is another, it cannot be written (OutputFile), or there is no encoder.
    VideoWriter(const std::filesystem::path& file, Extent2D extent, double fps,
                const std::vector<std::filesystem::path>& inputs = {});
    /// Removes what was written, unless finish() was called.
    ~VideoWriter();

    /// Appends a frame of the video's extent.
    void write(const Drawing& frame);

    /// Puts the file in its place. Throws Error when that fails, or the file does not hold all frames: encoders do not
    /// report a full disk, so the file is read again.
    void finish();

  private:
    struct Encoder;
    void expect_whole() const;

    sensor::OutputFile file_;
    Extent2D extent_;
    uint64_t frames_ = 0;
    std::unique_ptr<Encoder> encoder_;
};

}  // namespace patina
