#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sensor/output/new_file.h"

namespace patina {

/// A ZIP file whose entries are stored, not compressed, and begin at multiples of 64 bytes, as a USDZ package asks for.
/// The same entries give the same bytes. All functions throw Error, naming the file, where the disk refuses or the file
/// becomes larger than 4 GiB.
class StoredZip {
  public:
    static constexpr uint64_t kAlignment = 64;

    explicit StoredZip(const std::filesystem::path& path) : path_(path), file_(path) {}

    /// Appends an entry; names are of ASCII, with / between folders.
    void add(const std::string& name, std::string_view bytes);

    /// Writes the list of entries; nothing may follow.
    void finish();

  private:
    struct Entry {
        std::string name;
        uint32_t crc = 0, size = 0, first = 0;
    };
    void expect_room(uint64_t bytes) const;

    std::filesystem::path path_;
    sensor::NewFile file_;
    std::vector<Entry> entries_;
};

}  // namespace patina
