#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>

#include "patina/image.h"

namespace patina::sensor {

/// A whole OpenEXR file in memory, for Imf::InputFile. The bytes outlive it.
class ExrBytes : public Imf::IStream {
  public:
    ExrBytes(const std::string& file, std::span<const uint8_t> bytes);

    bool read(char* to, int count) override;
    uint64_t tellg() override { return position_; }
    void seekg(uint64_t position) override { position_ = position; }

  private:
    std::span<const uint8_t> bytes_;
    uint64_t position_ = 0;
};

/// An OpenEXR picture whose headers were checked.
class ExrInput {
  public:
    /// The bytes of a file, which outlive this. Throws Error as check_exr; what OpenEXR throws is none.
    ExrInput(const std::string& file, std::span<const uint8_t> bytes);

    Extent2D extent() const { return extent_; }
    Imf::InputFile& file() { return file_; }

  private:
    Extent2D extent_;  ///< of the data window
    ExrBytes bytes_;
    Imf::InputFile file_;
};

}  // namespace patina::sensor
