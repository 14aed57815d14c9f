#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "patina/frame.h"
#include "sensor/background_work.h"
#include "sensor/output/new_folder.h"
#include "sensor/pose.h"

namespace patina::sensor {

/// How linear colour pictures are written: as 8-bit sRGB PNG (clipped at 1 and encoded), or as they are in OpenEXR.
/// Pictures of 8-bit codes are PNG either way.
enum class LinearColor { kPng, kExr };

/// Writes a sequence folder in Patina's own format; it appears whole or not at all (NewFolder). Pictures are encoded
/// and written on other threads. The same frames give the same bytes.
class SequenceWriter {
  public:
    /// `info` gives name, fps, cameras, metres_per_unit, max_metres, color_from_depth, motion_blur and indirect_light;
    /// its frame count is not used, exposures are written where it says that they are known. Throws Error when the
    /// folder exists and is not empty, its place cannot be written, or another process writes it.
    SequenceWriter(const std::filesystem::path& folder, SequenceInfo info,
                   LinearColor linear_color = LinearColor::kPng);
    SequenceWriter(const SequenceWriter&) = delete;
    SequenceWriter& operator=(const SequenceWriter&) = delete;

    /// Removes what was written, unless finish() was called.
    ~SequenceWriter();

    /// Appends a frame: colour as PNG or OpenEXR, depth as 16-bit PNG in metres_per_unit (metres are rounded; what does
    /// not fit becomes 0, 'no reading'). Throws Error when its index is not the count of frames before it, a picture's
    /// size is not info's, or a file of an earlier frame could not be written.
    void write(Frame frame);

    /// Where further files, such as truth/, are written before finish(): the folder under its passing name.
    const std::filesystem::path& partial_folder() const { return folder_.partial_path(); }

    /// Where the writing of further files may be started; finish() waits for it.
    BackgroundWork& background() { return background_; }

    /// Writes sequence.json and the lists, and renames the folder. Throws Error when no frame was written, a file could
    /// not be written, or the folder cannot be put in place.
    void finish();

  private:
    void write_lists() const;
    void write_sequence_file() const;

    NewFolder folder_;
    SequenceInfo info_;
    LinearColor linear_color_;
    std::vector<double> timestamps_s_;
    std::vector<Exposure> exposures_;
    std::vector<StampedPose> poses_;
    bool finished_ = false;
    BackgroundWork background_;
};

}  // namespace patina::sensor
