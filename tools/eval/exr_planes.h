#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "patina/image.h"

namespace patina::eval {

/// All channels of an OpenEXR picture as planes, rows from the top, under their names in the file: "kd.R", "depth".
class ExrPlanes {
  public:
    /// Reads half, float and integer channels as float: all, or those of `only` that the file has. Throws Error, naming
    /// the file, when it is missing or damaged.
    static ExrPlanes read(const std::filesystem::path& file, const std::set<std::string>& only = {});

    const std::string& file() const { return file_; }
    Extent2D extent() const { return extent_; }
    /// The id of the run that wrote the file (tools/report/run_id.h); empty where it has none.
    const std::string& run_id() const { return run_id_; }
    const std::map<std::string, std::vector<float>>& planes() const { return planes_; }
    bool has(const std::string& channel) const { return planes_.contains(channel); }

    /// One channel, row by row. Throws Error when the file lacks it.
    const std::vector<float>& plane(const std::string& channel) const;

    /// The channels name.R name.G name.B as a picture. Throws Error when one is missing.
    Image<glm::vec3> rgb(const std::string& name) const;

  private:
    std::string file_, run_id_;
    Extent2D extent_;
    std::map<std::string, std::vector<float>> planes_;
};

/// The pictures NNNNNN.exr of a folder by frame index. Throws Error when the folder cannot be read; other files are
/// left aside. Empty when the folder does not exist.
std::map<uint32_t, std::filesystem::path> exr_frames(const std::filesystem::path& folder);

}  // namespace patina::eval
