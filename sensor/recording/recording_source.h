#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "engine/core/error.h"
#include "patina/source.h"
#include "sensor/recording/container.h"

namespace patina::sensor {

/// A frame whose payloads are not what its device sends. The next frame may be whole.
class DamagedFrame : public Error {
  public:
    using Error::Error;
};

/// Makes pictures of payloads that are a device's own, such as a Kinect's infrared.
class PayloadDecoder {
  public:
    virtual ~PayloadDecoder() = default;

    /// Sets the frame's pictures from its payloads. Throws DamagedFrame where these are damaged; Error where nothing
    /// more can be decoded, such as for a device that is lost.
    virtual void decode(const RecordedFrame& recorded, Frame& frame) = 0;
};

/// Makes the decoder of a sequence whose streams are a device's own; null where it does not know them. `where` names
/// the file in messages. Throws Error where the sequence's attachments are damaged.
using MakePayloadDecoder =
    std::function<std::unique_ptr<PayloadDecoder>(const RecordedSequence& sequence, const std::string& where)>;

/// The frames of one sequence of a recording. One that was cut off ends with what it holds.
class RecordingSource : public Source {
  public:
    /// Throws Error where there is no such sequence, it holds no frame, or its streams are not known.
    RecordingSource(const std::filesystem::path& file, SequenceRole role, const MakePayloadDecoder& make_decoder = {});

    const SequenceInfo& info() const override { return info_; }

    /// A frame that is damaged is skipped. Throws Error as the decoder does, where that cannot go on.
    std::optional<Reading> next() override;

  private:
    void decode_pictures(const RecordedFrame& recorded, Frame& frame) const;
    Reading decoded(const RecordedFrame& recorded) const;

    RecordingFile file_;
    SequenceRole role_;
    SequenceInfo info_;
    std::unique_ptr<PayloadDecoder> decoder_;
    uint32_t next_ = 0;
};

/// Whether all streams of a sequence are pictures, which need no decoder.
bool holds_pictures(const RecordedSequence& sequence);

/// The lighting sequence in a recording, as if that were a folder: "FILE.patina/lighting".
std::filesystem::path lighting_in(const std::filesystem::path& recording);

/// Whether a path is a recording, or the lighting sequence in one.
bool names_recording(const std::filesystem::path& path);

/// What such a path names.
struct NamedSequence {
    std::filesystem::path file;
    SequenceRole role = SequenceRole::kMain;
};
NamedSequence named_sequence(const std::filesystem::path& path);

/// Opens what such a path names. Errors as RecordingSource.
std::unique_ptr<Source> open_recording(const std::filesystem::path& path, const MakePayloadDecoder& make_decoder = {});

}  // namespace patina::sensor
