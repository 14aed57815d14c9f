#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "patina/source.h"
#include "sensor/files/json_file.h"

namespace patina::sensor {

/// What sequence.json says of all frames. has_poses is another file's to say.
struct SequenceDescription {
    SequenceInfo info;
    Exposure exposure;  ///< of frames that have none of their own
};

/// Reads the sequence format's sequence.json; `frames` may be missing. `default_name` is the name of one without.
/// Throws Error when it is another format, a member is missing, or a value is outside what it may be.
SequenceDescription parse_sequence(const JsonValue& root, const std::string& default_name);

/// The same as JSON. The exposure is left out where info says that none is known, the number of frames where info has
/// none.
nlohmann::ordered_json sequence_json(const SequenceInfo& info, const Exposure& exposure);

}  // namespace patina::sensor
