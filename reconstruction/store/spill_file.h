#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/store/database.h"

namespace patina {

/// Bytes by key in a temporary file, for what memory is too small for. It goes with the process
/// (temporary_database()).
class SpillFile {
  public:
    /// Throws Error where the file cannot be created.
    SpillFile();

    /// Keeps all of them, each in place of what its key had; or, where it throws Error, none.
    void put(std::span<const std::pair<uint32_t, std::span<const std::byte>>> entries);

    /// Throws Error where the file cannot be read, or never had that key.
    std::vector<std::byte> read(uint32_t key);

  private:
    Database database_;
};

}  // namespace patina
