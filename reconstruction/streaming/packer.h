#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

struct ZSTD_CCtx_s;
struct ZSTD_DCtx_s;

namespace patina {

/// Compresses words (zstd, level 1: what leaves is compressed while frames go on), sorted by the significance of their
/// bytes, as words beside each other are alike byte by byte.
class Packer {
  public:
    /// Throws std::bad_alloc.
    Packer();
    ~Packer();

    /// Throws std::bad_alloc.
    std::vector<std::byte> pack(std::span<const uint32_t> words);
    /// Throws Error where the bytes are damaged, or are more than `most` words.
    std::vector<uint32_t> unpack(std::span<const std::byte> packed, size_t most);

  private:
    struct Free {
        void operator()(ZSTD_CCtx_s* context) const;
        void operator()(ZSTD_DCtx_s* context) const;
    };
    std::unique_ptr<ZSTD_CCtx_s, Free> compressor_;
    std::unique_ptr<ZSTD_DCtx_s, Free> decompressor_;
    std::vector<std::byte> bytes_, packed_;  ///< kept, so that they are not made each time
};

}  // namespace patina
