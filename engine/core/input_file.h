#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace patina {

/// The most that is believed of files which others wrote. Each limit is several times what real data needs, and small
/// enough that a wrong or hostile file costs an error instead of the machine's memory or a day.
namespace limits {

/// An hour of poses at 120 a second is 432 000 lines, 45 MB. Also of every JSON file.
inline constexpr uint64_t kTextBytes = uint64_t{64} << 20;
/// An hour at 1000 lines a second is 3.6 million.
inline constexpr size_t kTextLines = size_t{1} << 22;
/// 8192 x 8192 pixels of three uncompressed floats are 0.8 GB.
inline constexpr uint64_t kPictureBytes = uint64_t{1} << 30;
/// 16384 x 8192, the largest environment maps there are; four times an 8K picture.
inline constexpr uint64_t kPicturePixels = uint64_t{1} << 27;
/// All channels of a frame's measurements decoded: 24 floats of each pixel of an 8K picture are 3.2 GB.
inline constexpr uint64_t kPlanesBytes = uint64_t{4} << 30;
/// 28 million triangles, the largest of Stanford's scans, are 0.5 GB as binary PLY.
inline constexpr uint64_t kMeshBytes = uint64_t{2} << 30;
inline constexpr uint64_t kTriangles = uint64_t{1} << 25;
/// The network that ships with the program has 0.3 MB.
inline constexpr uint64_t kNetworkBytes = uint64_t{256} << 20;
/// Room for two thousand pipelines of 100 kB each.
inline constexpr uint64_t kPipelineCacheBytes = uint64_t{256} << 20;
/// A hundred settings with a line of comment each are 20 kB.
inline constexpr uint64_t kSettingsBytes = uint64_t{1} << 20;
/// The header of a binary file, such as a mesh, a network or an OpenEXR picture.
inline constexpr uint64_t kHeaderBytes = uint64_t{1} << 20;
/// The built-in scenes nest 8 levels, glTF samples with extensions 10; recursion over 100 000 overflows the stack.
inline constexpr size_t kJsonDepth = 64;

}  // namespace limits

/// Whether there is something at a path. Throws Error, with the path and the system's reason, when that cannot be told:
/// a name is too long, links form a loop, a folder may not be entered.
bool path_exists(const std::filesystem::path& path);

/// Whether there is a folder at a path. Errors as path_exists.
bool is_folder(const std::filesystem::path& path);

/// What a folder holds, in alphabetical order. Throws Error when it cannot be read.
std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder);

/// Throws Error unless there is a regular file at the path: "x.json does not exist", "x is a folder, not a file".
void expect_file(const std::filesystem::path& file);

/// All bytes of a regular file. The one way in which files that others wrote are opened: a pipe, a device or a folder
/// is refused and never waited for. Throws Error, naming the file, when it is missing, no regular file, longer than
/// `most_bytes`, or cannot be read.
std::vector<uint8_t> read_file(const std::filesystem::path& file, uint64_t most_bytes);

/// Throws Error unless a picture's size is one to be decoded: no side is 0, and the pixels are at most
/// limits::kPicturePixels.
void check_picture_size(const std::string& file, uint64_t width, uint64_t height);

/// Throws Error when a JSON text nests arrays and objects deeper than limits::kJsonDepth; whether it is valid is for
/// its parser to say.
void check_json_depth(const std::string& file, std::span<const uint8_t> json);

}  // namespace patina
