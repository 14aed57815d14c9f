#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "patina/image.h"

namespace patina::sensor {

enum class PictureFormat { kPng, kJpeg, kExr };

/// The format of a picture file by its first bytes; empty when it is none that Patina reads.
std::optional<PictureFormat> picture_format(std::span<const uint8_t> bytes);

/// Walks a PNG file from its signature to IEND and checks every chunk's checksum, because decoders return what they got
/// of a truncated file without an error. Returns the picture's size. Throws Error naming the file when it is truncated,
/// damaged, or larger than is decoded (see check_picture_size).
Extent2D check_png(std::span<const uint8_t> bytes, const std::string& file);

/// Walks a JPEG file from its start marker through every segment and scan to its end marker; otherwise as check_png.
/// JPEG has no checksums: damage inside a scan stays unseen. A second frame header is refused, since decoders do not
/// agree which one holds.
Extent2D check_jpeg(std::span<const uint8_t> bytes, const std::string& file);

/// Walks an OpenEXR file's headers, before OpenEXR allots what they ask for. Returns the size of the first part's data
/// window. Throws Error naming the file when they are damaged or decoding takes more than limits::kPlanesBytes; damage
/// behind the headers stays unseen.
Extent2D check_exr(std::span<const uint8_t> bytes, const std::string& file);

/// Reads the header of a Radiance picture (.hdr), rows from the top. Returns the picture's size. Throws Error naming
/// the file when it is none, turned or larger than is decoded; damage behind the header stays unseen.
Extent2D check_radiance(std::span<const uint8_t> bytes, const std::string& file);

}  // namespace patina::sensor
