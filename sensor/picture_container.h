#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "engine/core/image.h"

namespace patina::sensor {

enum class PictureFormat { kPng, kJpeg, kExr };

/// The format of a picture file by its first bytes; empty when it is none that Patina reads.
std::optional<PictureFormat> picture_format(std::span<const uint8_t> bytes);

/// Walks a PNG file from its signature to IEND and checks every chunk's checksum, because decoders return what they got
/// of a truncated file without an error. Returns the picture's size. Throws Error naming the file when it is truncated
/// or damaged.
Extent2D check_png(std::span<const uint8_t> bytes, const std::string& file);

/// Walks a JPEG file from its start marker through every segment and scan to its end marker; otherwise as check_png.
/// JPEG has no checksums: damage inside a scan stays unseen.
Extent2D check_jpeg(std::span<const uint8_t> bytes, const std::string& file);

}  // namespace patina::sensor
