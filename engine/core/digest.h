#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace patina {

/// A number that tells contents apart (FNV-1a, 64 bits: no protection against those who look for a match).
class Digest {
  public:
    void add(std::string_view bytes) {
        for (const char byte : bytes) value_ = (value_ ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
    }

    uint64_t value() const { return value_; }

    /// 16 lower-case hexadecimal digits.
    std::string digits() const {
        std::string text(16, '0');
        for (size_t i = 0; i < text.size(); ++i) text[i] = "0123456789abcdef"[value_ >> (60 - 4 * i) & 15];
        return text;
    }

  private:
    uint64_t value_ = 0xcbf29ce484222325u;
};

}  // namespace patina
