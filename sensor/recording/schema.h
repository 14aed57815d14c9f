#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/store/content_digest.h"
#include "sensor/recording/recorded_frame.h"

namespace patina::sensor {

inline constexpr int64_t kRecordingApplication = 0x5054'4e52;  // "PTNR", in the file's header
inline constexpr int64_t kRecordingSchema = 1;
inline constexpr size_t kMostStreams = 64;  ///< of a sequence; a camera has two

/// The tables of a recording as SQLite keeps them: a file with others is no recording of this schema.
/// docs/develop/recording_file.md describes them.
inline constexpr std::array<std::string_view, 5> kRecordingTables{
    "CREATE TABLE sequences (sequence INTEGER PRIMARY KEY, role TEXT NOT NULL, description TEXT NOT NULL, "
    "frames INTEGER NOT NULL, ended INTEGER NOT NULL, digest BLOB NOT NULL)",
    "CREATE TABLE streams (stream INTEGER PRIMARY KEY, sequence INTEGER NOT NULL, name TEXT NOT NULL, "
    "encoding TEXT NOT NULL, seconds_per_tick REAL NOT NULL, digest BLOB NOT NULL)",
    "CREATE TABLE attachments (sequence INTEGER NOT NULL, name TEXT NOT NULL, content BLOB NOT NULL, "
    "digest BLOB NOT NULL, PRIMARY KEY (sequence, name))",
    "CREATE TABLE frames (sequence INTEGER NOT NULL, frame INTEGER NOT NULL, time_s REAL NOT NULL, arrival_s REAL, "
    "exposure_s REAL NOT NULL, gain REAL NOT NULL, pose TEXT NOT NULL, pose_defect REAL NOT NULL, "
    "skipped TEXT NOT NULL, payloads INTEGER NOT NULL, digest BLOB NOT NULL, PRIMARY KEY (sequence, frame)) "
    "WITHOUT ROWID",
    "CREATE TABLE payloads (stream INTEGER NOT NULL, frame INTEGER NOT NULL, number INTEGER NOT NULL, "
    "ticks INTEGER NOT NULL, attributes TEXT NOT NULL, content BLOB NOT NULL, digest BLOB NOT NULL, "
    "PRIMARY KEY (stream, frame))",
};

/// A sequence's number in the tables.
constexpr int64_t number_of(SequenceRole role) { return static_cast<int64_t>(role); }

/// A blob as a statement takes it.
inline std::span<const std::byte> bytes_in(const std::vector<uint8_t>& content) {
    return std::as_bytes(std::span(content));
}

// The digest of each kind of row: of all its values.
ContentDigest sequence_digest(SequenceRole role, std::string_view description, int64_t frames, int64_t ended);
ContentDigest stream_digest(SequenceRole role, int64_t number, const RecordedStream& stream);
ContentDigest attachment_digest(SequenceRole role, const Attachment& attachment);
/// `pose` as pose_text() has it.
ContentDigest frame_digest(SequenceRole role, const RecordedFrame& frame, std::string_view pose, int64_t payloads);
/// `stream`: its number in the file.
ContentDigest payload_digest(int64_t stream, uint32_t frame, const Payload& payload);

/// A pose as 16 numbers, row by row, that read back as the same; empty where there is none.
std::string pose_text(const std::optional<RigidTransform>& pose);
/// Throws Error, naming `where`, unless the text is empty or the 16 numbers of a rigid transform.
std::optional<RigidTransform> pose_of(const std::string& text, const std::string& where);
/// A transform that was rigid when it was written stays as it is to the last bit; others are checked as checked_pose()
/// does, with its errors.
RigidTransform recorded_transform(const RigidTransform& recorded, const std::string& where);

}  // namespace patina::sensor
