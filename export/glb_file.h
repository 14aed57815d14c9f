#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include <tiny_gltf.h>

#include "sensor/output/new_file.h"

namespace patina {

/// A GLB, whose JSON comes first, but is known last. The binary buffer goes to a file beside it meanwhile, so that
/// memory holds none of it. While the one is copied to the other, the disk holds both.
class GlbFile {
  public:
    static constexpr uint64_t kMostBytes = UINT32_MAX;  ///< lengths in a GLB have 32 bits

    /// Throws Error where the buffer's file, PATH.buffer, cannot be created. `most_bytes`: of the whole file.
    explicit GlbFile(std::filesystem::path path, uint64_t most_bytes = kMostBytes);
    /// Removes the buffer's file; without finish() there is no other.
    ~GlbFile();
    GlbFile(const GlbFile&) = delete;
    GlbFile& operator=(const GlbFile&) = delete;

    /// Appends bytes to the buffer; returns where they begin, at a multiple of four. Throws Error where a GLB cannot
    /// hold that many, or the disk refuses.
    uint64_t append(std::span<const std::byte> bytes);

    /// Writes the file, with the model's buffers replaced by this one. Throws Error as append(); then it may be there
    /// in part.
    void finish(tinygltf::Model& model);

  private:
    uint64_t length_with(uint64_t json_bytes, uint64_t buffer_bytes) const;
    void copy_buffer(sensor::NewFile& file) const;

    std::filesystem::path path_, buffer_path_;
    uint64_t most_bytes_;
    std::optional<sensor::NewFile> buffer_;
};

}  // namespace patina
