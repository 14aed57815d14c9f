#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace patina::sensor {

/// Depth pictures as OpenNI's recorders compress them: the codecs "16zT" (values stand for places in a table that comes
/// first) and "16zP" (without a table).
///
/// The first value is whole. Then each half byte below 13 is the last value's difference plus 6; 15 says that a larger
/// step follows; 13 fills up a byte. A byte from 0xE1 to 0xFE repeats the last value twice that many times less 0xE0
/// (recorders stop at 0xEF); 0xFF says that a larger step follows. That is one byte from 0x80 on, the difference plus
/// 192, or else two with the value itself, the high one first.
///
/// Returns exactly `count` values. Throws Error, without the file's name, where the bytes are too few or too many for
/// them, or name a place beyond the table.
std::vector<uint16_t> decode_oni_depth(std::span<const uint8_t> bytes, size_t count, bool has_table);

}  // namespace patina::sensor
