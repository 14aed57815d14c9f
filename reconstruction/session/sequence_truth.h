#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "patina/image.h"
#include "patina/source.h"
#include "scenes/render/synthetic_source.h"
#include "sensor/truth.h"

namespace patina {

/// What a synthetic sequence knows of itself: from the folder truth/ beside its frames, or from the scene that is
/// rendered.
class SequenceTruth {
  public:
    /// `rendered` is null for a recording, whose folder is `sequence`; else it must outlive this.
    SequenceTruth(std::filesystem::path sequence, const scenes::SyntheticSource* rendered);

    /// The object at each pixel of the depth camera in the frame that the source gave last. Throws Error when the file
    /// is missing, damaged or not of this extent.
    Image<uint16_t> labels(uint32_t frame, Extent2D extent) const;

    /// All materials. Throws Error when the file is missing or wrong.
    std::vector<sensor::Material> materials() const;

    /// The objects' names by label, empty where there is none; none at all without a file of materials. Throws Error
    /// when that is wrong.
    std::vector<std::string> names() const;

  private:
    std::filesystem::path folder_;
    const scenes::SyntheticSource* rendered_;
};

}  // namespace patina
