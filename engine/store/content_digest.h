#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

namespace patina {

/// Finds damage, not forgery: XXH3 of 128 bits, the most significant byte first.
using ContentDigest = std::array<std::byte, 16>;

ContentDigest digest_of(std::span<const std::byte> content);

/// The digest of a row of a table: of the table's name and all its values, each with its length, so that no two rows
/// that differ have the same input.
class RowDigest {
  public:
    explicit RowDigest(std::string_view table);
    ~RowDigest();
    RowDigest(const RowDigest&) = delete;
    RowDigest& operator=(const RowDigest&) = delete;

    RowDigest& add(int64_t number);
    RowDigest& add(double number);  ///< by its bits; -0 as 0, which is what SQLite keeps
    RowDigest& add(std::string_view text);
    RowDigest& add(std::span<const std::byte> blob);

    ContentDigest value() const;

  private:
    void add_bytes(const void* bytes, size_t count);

    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace patina
