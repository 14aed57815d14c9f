#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "patina/source.h"
#include "sensor/pose.h"

namespace patina::sensor {

/// A source whose frames are files of a folder, decoded one after the other. What decode() throws, an Error or another
/// exception, becomes the reason why that frame is skipped.
class FolderSource : public Source {
  public:
    const SequenceInfo& info() const final { return info_; }
    std::optional<Reading> next() final;

  protected:
    virtual Frame decode(uint32_t index) const = 0;

    SequenceInfo info_;

  private:
    uint32_t next_ = 0;
};

/// Gives the frame a checked pose, or none.
void set_pose(Frame& frame, const std::optional<CheckedPose>& pose);

/// The last part of a folder's absolute path, which names the sequence.
std::string folder_name(const std::filesystem::path& folder);

/// The size of the first picture that can be read. Throws Error, with the first one's reason, when none can.
Extent2D first_readable_extent(const std::vector<std::filesystem::path>& pictures);

}  // namespace patina::sensor
