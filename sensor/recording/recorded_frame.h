#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "patina/source.h"

namespace patina::sensor {

/// The sequences that a recording may hold, as a folder and its lighting/.
enum class SequenceRole : uint8_t {
    kMain,     ///< reflectance: what is reconstructed
    kLighting  ///< low exposure: where lamps are found
};

constexpr const char* name_of(SequenceRole role) { return role == SequenceRole::kMain ? "main" : "lighting"; }

/// One kind of payload of a sequence.
struct RecordedStream {
    std::string name;                ///< "color", "depth", "infrared"
    std::string encoding;            ///< what the bytes are: payload_codec.h, or a device's own
    double seconds_per_tick = 1e-9;  ///< of the clock that its payloads are stamped by
};

/// Bytes that belong to a whole sequence, such as a page of a device's calibration.
struct Attachment {
    std::string name;
    std::vector<uint8_t> content;
};

/// What holds for all frames of a recorded sequence.
struct RecordedSequence {
    SequenceInfo info;
    std::vector<RecordedStream> streams;
    std::vector<Attachment> attachments;
};

/// Bytes of one stream in one frame, as they came.
struct Payload {
    uint32_t stream = 0;     ///< index into RecordedSequence::streams
    int64_t number = 0;      ///< the device's own count, where it has one
    int64_t ticks = 0;       ///< on the stream's clock
    std::string attributes;  ///< what the device said beside it, as JSON; may be empty
    std::vector<uint8_t> content;
};

/// One frame of a sequence as it is kept: not decoded.
struct RecordedFrame {
    uint32_t index = 0;
    double timestamp_s = 0;           ///< of the exposure, on the source's clock
    std::optional<double> arrival_s;  ///< when it reached the host, on the same clock; empty: unknown
    Exposure exposure;
    std::optional<RigidTransform> world_from_camera;
    double pose_defect = 0;  ///< Frame::pose_defect
    std::string skipped;     ///< why there is no picture; empty where there is
    std::vector<Payload> payloads;
};

}  // namespace patina::sensor
