#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "patina/image.h"

namespace patina::sensor {

/// One stream of an OpenNI recording.
struct OniStream {
    std::array<char, 4> codec{};         ///< "16zT", "16zP", "NONE", "JPEG"
    Extent2D extent;                     ///< "xnMapOutputMode"; 0 x 0 where the file does not have it
    uint32_t fps = 30;                   ///< likewise
    uint64_t pixel_format = 0;           ///< "oniPixelFormat": OpenNI2's number; 0 where OpenNI 1 wrote the file
    std::optional<glm::dvec2> view_rad;  ///< "xnFOV": horizontal and vertical field of view
    bool mirrored = false;               ///< "xnMirror": the pictures are as in a mirror
    std::vector<double> timestamps_s;    ///< by picture, in the order of the file
    struct Place {
        uint64_t begin = 0;
        uint32_t bytes = 0;
    };
    std::vector<Place> places;  ///< of their payloads

    bool has_codec(const char* name) const { return std::equal(codec.begin(), codec.end(), name); }
};

/// The container of OpenNI's recorders (.oni), of versions 1 and 2. A file that was cut off has the pictures up to
/// there. Nothing that it says of itself is believed: sizes are held against the file's.
class OniFile {
  public:
    /// Reads all but the pictures. Throws Error, naming the file, where it is missing, no such file, or damaged.
    explicit OniFile(const std::filesystem::path& file);

    const std::optional<OniStream>& depth() const { return depth_; }
    const std::optional<OniStream>& color() const { return color_; }

    /// A picture's payload. Throws Error where it cannot be read.
    std::vector<uint8_t> read(const OniStream::Place& place) const;

  private:
    std::filesystem::path file_;
    mutable std::ifstream input_;
    std::optional<OniStream> depth_, color_;
};

/// Whether a file is an OpenNI recording by its first bytes; false where there is no such file.
bool is_oni_file(const std::filesystem::path& file);

}  // namespace patina::sensor
