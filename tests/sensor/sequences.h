#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "patina/source.h"

namespace patina::sensor::testing {

/// A folder of its own for one test, removed with it.
class TemporaryFolder {
  public:
    TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder();

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  private:
    std::filesystem::path path_;
};

/// A frame whose pixels tell its index, at i / 30 s, 10 cm further along x than the last.
Frame test_frame(uint32_t index, Extent2D color, Extent2D depth);

/// Intrinsics as of a camera with 60 degrees of view.
Intrinsics test_camera(Extent2D extent);

/// What test_frame()'s sequence says of itself; 32 x 24 pixels of colour, 16 x 12 of depth.
SequenceInfo test_info();

/// Frames of test_info() and test_frame() from memory.
class MemorySource : public Source {
  public:
    MemorySource(SequenceInfo info, std::vector<Reading> readings);
    const SequenceInfo& info() const override { return info_; }
    std::optional<Reading> next() override;

  private:
    SequenceInfo info_;
    std::vector<Reading> readings_;
    size_t next_ = 0;
};

std::vector<Reading> test_readings(uint32_t frames);

/// Write sequences of test_frame()s in each format.
void write_native(const std::filesystem::path& folder, uint32_t frames);
void write_seven_scenes(const std::filesystem::path& folder, const std::vector<uint32_t>& numbers);
void write_tum(const std::filesystem::path& folder, uint32_t frames);

void write_text(const std::filesystem::path& file, const std::string& content);
std::string read_text(const std::filesystem::path& file);
/// Replaces the one occurrence of `from`.
void replace_text(const std::filesystem::path& file, const std::string& from, const std::string& to);
void write_jpeg(const std::filesystem::path& file, const Image<SrgbPixel>& image);
/// Cuts off a file's last bytes.
void shorten(const std::filesystem::path& file, size_t bytes);

std::vector<Reading> read_all(Source& source);

/// The message of the Error that `action` throws; a failure of the test, and empty, when it throws none.
std::string error_of(const std::function<void()>& action);

/// The reason why frame `index` of a sequence is skipped; a failure of the test, and empty, when it is not, or another
/// one is.
std::string only_skip_reason(const std::filesystem::path& folder, uint32_t index);

}  // namespace patina::sensor::testing
