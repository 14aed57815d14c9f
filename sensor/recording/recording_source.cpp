#include "sensor/recording/recording_source.h"

#include <algorithm>
#include <utility>

#include "sensor/recording/payload_codec.h"

namespace patina::sensor {

namespace fs = std::filesystem;

namespace {

constexpr const char* kLighting = "lighting";

bool is_picture(const RecordedStream& stream) {
    return (stream.name == "color" && is_color_encoding(stream.encoding)) ||
           (stream.name == "depth" && is_depth_encoding(stream.encoding));
}

/// Without frames a sequence may be named by its file alone.
std::string name_of(const fs::path& file, SequenceRole role) {
    return file.stem().string() + (role == SequenceRole::kMain ? "" : std::string(", ") + kLighting);
}

std::unique_ptr<PayloadDecoder> decoder_of(const RecordedSequence& sequence, const std::string& where,
                                           const MakePayloadDecoder& make_decoder) {
    const auto unknown = std::find_if_not(sequence.streams.begin(), sequence.streams.end(), is_picture);
    if (unknown == sequence.streams.end()) return nullptr;
    std::unique_ptr<PayloadDecoder> decoder = make_decoder ? make_decoder(sequence, where) : nullptr;
    if (!decoder)
        throw Error(where, " holds a stream '", unknown->name, "' encoded as '", unknown->encoding,
                    "', for which there is no decoder here");
    return decoder;
}

}  // namespace

RecordingSource::RecordingSource(const fs::path& file, SequenceRole role, const MakePayloadDecoder& make_decoder)
    : file_(file), role_(role), info_(file_.sequence(role).info) {
    const std::string where = "'" + file.string() + "'";
    if (info_.name.empty()) info_.name = name_of(file, role);
    if (*info_.frames == 0) throw Error(where, " holds no frame of the ", sensor::name_of(role), " sequence");
    decoder_ = decoder_of(file_.sequence(role), where, make_decoder);
}

std::optional<Reading> RecordingSource::next() {
    if (next_ == *info_.frames) return std::nullopt;
    const auto recorded = file_.read(role_, next_++);
    if (const auto* skipped = std::get_if<Skipped>(&recorded)) return *skipped;
    return decoded(std::get<RecordedFrame>(recorded));
}

Reading RecordingSource::decoded(const RecordedFrame& recorded) const {
    Frame frame;
    frame.index = recorded.index;
    frame.timestamp_s = recorded.timestamp_s;
    frame.exposure = recorded.exposure;
    frame.world_from_camera = recorded.world_from_camera;
    frame.pose_defect = recorded.pose_defect;
    try {
        if (decoder_) {
            decoder_->decode(recorded, frame);
        } else {
            decode_pictures(recorded, frame);
        }
    } catch (const DamagedFrame& error) {
        return Skipped{recorded.index, error.what()};
    }
    return frame;
}

void RecordingSource::decode_pictures(const RecordedFrame& recorded, Frame& frame) const {
    const std::string file = "'" + file_.file().string() + "'";
    bool has_color = false, has_depth = false;
    try {
        for (const Payload& payload : recorded.payloads) {
            const RecordedStream& stream = file_.sequence(role_).streams[payload.stream];
            const std::string where = text(file, ": ", stream.name, " of frame ", recorded.index);
            if (stream.name == "color") {
                frame.color = decode_color(stream.encoding, payload.content, info_.color.extent, where);
                has_color = true;
            } else {
                frame.depth = decode_depth(stream.encoding, payload.content, info_.depth.extent, where);
                has_depth = true;
            }
        }
    } catch (const Error& error) {
        throw DamagedFrame(error.what());
    } catch (const std::exception& error) {  // of the picture's library
        throw DamagedFrame(file, ": frame ", recorded.index, " cannot be decoded: ", reason_of(error));
    }
    if (!has_color || !has_depth)
        throw DamagedFrame(file, ": frame ", recorded.index, " has no ", has_color ? "depth" : "color");
}

bool holds_pictures(const RecordedSequence& sequence) { return std::ranges::all_of(sequence.streams, is_picture); }

fs::path lighting_in(const fs::path& recording) { return recording / kLighting; }

bool names_recording(const fs::path& path) {
    return is_recording(path) || (path.filename() == kLighting && is_recording(path.parent_path()));
}

NamedSequence named_sequence(const fs::path& path) {
    if (path.filename() == kLighting && is_recording(path.parent_path()))
        return {path.parent_path(), SequenceRole::kLighting};
    return {path, SequenceRole::kMain};
}

std::unique_ptr<Source> open_recording(const fs::path& path, const MakePayloadDecoder& make_decoder) {
    const auto [file, role] = named_sequence(path);
    return std::make_unique<RecordingSource>(file, role, make_decoder);
}

}  // namespace patina::sensor
