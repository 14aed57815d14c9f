#include "sensor/recording/schema.h"

#include <cmath>
#include <limits>
#include <sstream>

#include "engine/core/error.h"
#include "sensor/files/text_file.h"
#include "sensor/pose.h"

namespace patina::sensor {

namespace {

/// Beyond rounding; below it a transform is as it was when it was written, and stays so.
constexpr double kExactlyRigid = 1e-9;

}  // namespace

ContentDigest sequence_digest(SequenceRole role, std::string_view description, int64_t frames, int64_t ended) {
    RowDigest digest("sequences");
    digest.add(number_of(role)).add(std::string_view(name_of(role))).add(description).add(frames).add(ended);
    return digest.value();
}

ContentDigest stream_digest(SequenceRole role, int64_t number, const RecordedStream& stream) {
    RowDigest digest("streams");
    digest.add(number_of(role)).add(number).add(std::string_view(stream.name)).add(std::string_view(stream.encoding));
    return digest.add(stream.seconds_per_tick).value();
}

ContentDigest attachment_digest(SequenceRole role, const Attachment& attachment) {
    RowDigest digest("attachments");
    digest.add(number_of(role)).add(std::string_view(attachment.name)).add(bytes_in(attachment.content));
    return digest.value();
}

ContentDigest frame_digest(SequenceRole role, const RecordedFrame& frame, std::string_view pose, int64_t payloads) {
    RowDigest digest("frames");
    digest.add(number_of(role)).add(int64_t{frame.index}).add(frame.timestamp_s);
    digest.add(int64_t{frame.arrival_s.has_value()}).add(frame.arrival_s.value_or(0));
    digest.add(frame.exposure.exposure_s).add(frame.exposure.gain).add(pose).add(frame.pose_defect);
    return digest.add(std::string_view(frame.skipped)).add(payloads).value();
}

ContentDigest payload_digest(int64_t stream, uint32_t frame, const Payload& payload) {
    RowDigest digest("payloads");
    digest.add(stream).add(int64_t{frame}).add(payload.number).add(payload.ticks);
    return digest.add(std::string_view(payload.attributes)).add(bytes_in(payload.content)).value();
}

std::string pose_text(const std::optional<RigidTransform>& pose) {
    if (!pose) return "";
    std::string numbers;
    for (int i = 0; i < 16; ++i) numbers += (i > 0 ? " " : "") + shortest((*pose)[i % 4][i / 4]);
    return numbers;
}

std::optional<RigidTransform> pose_of(const std::string& text, const std::string& where) {
    if (text.empty()) return std::nullopt;
    std::vector<std::string> words;
    std::istringstream stream(text);
    for (std::string word; stream >> word;) words.push_back(word);
    const TextLine line(where, std::move(words));
    if (line.size() != 16) throw Error(where, " has a pose of ", line.size(), " numbers, must be 16");
    std::vector<double> rows;
    for (size_t i = 0; i < line.size(); ++i) rows.push_back(line.number(i));
    return recorded_transform(matrix_from_rows(rows), where);
}

RigidTransform recorded_transform(const RigidTransform& recorded, const std::string& where) {
    const bool exact = rotation_defect(recorded) < kExactlyRigid && recorded[0][3] == 0 && recorded[1][3] == 0 &&
                       recorded[2][3] == 0 && recorded[3][3] == 1;
    return exact ? recorded : checked_pose(recorded, where).transform;
}

}  // namespace patina::sensor
