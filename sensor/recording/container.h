#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "engine/store/database.h"
#include "sensor/recording/recorded_frame.h"

namespace patina::sensor {

/// The extension of a recording's file.
inline constexpr const char* kRecordingExtension = ".patina";

/// Whether a file is a recording by its first bytes, whatever its name; false where there is no such file.
bool is_recording(const std::filesystem::path& file);

/// Writes a recording: one SQLite file, docs/develop/recording_file.md has the tables. What was committed survives
/// whatever ends the process, and once a LogKeeper has been at it a cut of the power, too; what was not is gone, and
/// the file opens as it is. All functions throw Error, naming the file, where the disk refuses: then nothing since the
/// last commit is kept, and nothing more can be added.
class RecordingWriter {
  public:
    /// Throws Error, too, where something has that name already.
    explicit RecordingWriter(const std::filesystem::path& file);
    ~RecordingWriter();
    RecordingWriter(const RecordingWriter&) = delete;
    RecordingWriter& operator=(const RecordingWriter&) = delete;

    /// Begins a sequence; each role once. info.frames is not used.
    void begin(SequenceRole role, const RecordedSequence& sequence);

    /// Adds the next frame of a sequence that has begun: its index is the count of those before it.
    void add(SequenceRole role, const RecordedFrame& frame);

    /// Commits all that was added.
    void commit();

    /// Commits, notes that both sequences are whole, and makes one file of the file and its log. Where a reader has the
    /// file open, a log stays beside it, without anything that the file lacks once the reader is done.
    void finish();

    const std::filesystem::path& file() const { return database_.file(); }

  private:
    struct Statements;
    struct Sequence {
        std::string description;
        std::vector<uint32_t> streams;  ///< their numbers in the file
        uint32_t frames = 0;
        bool changed = false;
    };
    Sequence& expect(SequenceRole role);
    void change();
    void write_sequence(SequenceRole role, bool ended);
    void write_streams(SequenceRole role, const RecordedSequence& sequence);
    void write_payload(SequenceRole role, uint32_t frame, const Payload& payload);

    Database database_;
    std::unique_ptr<Statements> statements_;
    std::optional<Transaction> transaction_;
    std::array<std::optional<Sequence>, 2> sequences_;
    uint32_t streams_ = 0;
};

/// Reads a recording, also one that was cut off, and one that is being written. Nothing that it says of itself is
/// believed: every row carries a digest of its content. Damage to what concerns a whole sequence throws Error; damage
/// to a frame costs that frame.
class RecordingFile {
  public:
    /// Throws Error where it is no recording, of another version, or damaged.
    explicit RecordingFile(const std::filesystem::path& file);
    ~RecordingFile();

    bool has(SequenceRole role) const { return sequences_[static_cast<size_t>(role)].has_value(); }

    /// With the number of frames. Throws Error where there is no such sequence.
    const RecordedSequence& sequence(SequenceRole role) const;

    /// Whether the recording came to its end, rather than being cut off.
    bool ended(SequenceRole role) const { return ended_[static_cast<size_t>(role)]; }

    /// A frame, or why it cannot be read. `index` is below the number of frames.
    std::variant<RecordedFrame, Skipped> read(SequenceRole role, uint32_t index);

    const std::filesystem::path& file() const { return database_.file(); }

  private:
    struct Statements;
    void read_sequences();
    RecordedSequence read_sequence(SequenceRole role, const std::string& description, int64_t frames);
    void read_streams(SequenceRole role, RecordedSequence& sequence);
    void read_attachments(SequenceRole role, RecordedSequence& sequence);
    RecordedFrame read_frame(SequenceRole role, uint32_t index);
    void read_payloads(SequenceRole role, RecordedFrame& frame, size_t count);

    Database database_;
    std::unique_ptr<Statements> statements_;
    std::array<std::optional<RecordedSequence>, 2> sequences_;
    std::array<std::vector<uint32_t>, 2> stream_numbers_;  ///< of each sequence's streams in the file
    std::array<bool, 2> ended_{};
};

}  // namespace patina::sensor
