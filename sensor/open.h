#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "patina/source.h"
#include "sensor/recording/recording_source.h"

namespace patina::sensor {

/// The names of all formats that can be opened, for a sentence: "a, b or c".
std::string format_names();

/// Throws Error where the path of a sequence is empty, or nothing is there.
void expect_sequence_path(const std::filesystem::path& path);

/// Opens a recorded sequence: a folder, a recording's file, or the lighting sequence in one (lighting_of). `format` is
/// one of format_names(), of a folder; empty: recognised by the folder's content. The path of a sequence.json stands
/// for its folder. `make_decoder` is for recordings whose streams are a device's own. Throws Error when the path does
/// not exist, is of no known format, or the sequence as a whole is unusable.
std::unique_ptr<Source> open_sequence(const std::filesystem::path& path, const std::string& format = "",
                                      const MakePayloadDecoder& make_decoder = {});

/// The lighting sequence that belongs to a sequence: the folder lighting/ in its folder, or "FILE/lighting" of a
/// recording; empty where it has none, or none with a frame.
std::filesystem::path lighting_of(const std::filesystem::path& sequence);

/// The sequence that a lighting sequence belongs to: the other way round.
std::filesystem::path main_of(const std::filesystem::path& lighting);

}  // namespace patina::sensor
