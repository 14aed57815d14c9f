#include "sensor/recording/container.h"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "sensor/pose.h"
#include "sensor/recording/schema.h"
#include "sensor/sequence_json.h"

namespace patina::sensor {

namespace fs = std::filesystem;

namespace {

constexpr SequenceRole kRoles[] = {SequenceRole::kMain, SequenceRole::kLighting};

size_t place_of(SequenceRole role) { return static_cast<size_t>(role); }

/// How long finish() waits for each reader of the log.
constexpr int kPatienceWithReadersMs = 1000;

/// Creates an empty file under a name that was free.
fs::path created(const fs::path& file) {
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0 && errno == EEXIST)
        throw Error("'", file.string(), "' exists already; a recording is a new file");
    if (descriptor < 0)
        throw Error("'", file.string(), "' cannot be created: ", std::generic_category().message(errno));
    ::close(descriptor);
    return file;
}

int64_t pragma(Database& database, const char* name) {
    Query query(database, std::string("PRAGMA ") + name);
    return query.next() ? query.number(0) : 0;
}

std::vector<uint8_t> copied(std::span<const std::byte> blob) {
    const auto* first = reinterpret_cast<const uint8_t*>(blob.data());
    return {first, first + blob.size()};
}

bool is_digest(const Query& row, int column, const ContentDigest& digest) {
    const std::span<const std::byte> kept = row.blob(column);
    return kept.size() == digest.size() && std::memcmp(kept.data(), digest.data(), digest.size()) == 0;
}

/// The sequence as JSON: sequence.json with what other files say in a folder.
std::string description_of(const SequenceInfo& info) {
    SequenceInfo described = info;
    described.frames.reset();
    nlohmann::ordered_json json = sequence_json(described, {});
    json["has_poses"] = info.has_poses;
    return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

SequenceInfo info_of(const std::string& description, const std::string& where) {
    const auto* first = reinterpret_cast<const uint8_t*>(description.data());
    const JsonValue root = JsonValue::parse(where, {first, description.size()});
    SequenceInfo info = parse_sequence(root, "").info;
    info.color_from_depth = recorded_transform(matrix_from_rows(root.at("depth_to_color").numbers(16)), where);
    info.has_poses = root.at("has_poses").boolean();
    info.format = "patina-recording";
    return info;
}

[[noreturn]] void fail_digest(const std::string& where) {
    throw Error(where, " is damaged: its digest is not that of its content");
}

}  // namespace

bool is_recording(const fs::path& file) {
    std::error_code failure;
    if (!fs::is_regular_file(file, failure)) return false;
    constexpr size_t kApplicationAt = 68;  // SQLite's file format, section 1.2
    constexpr std::string_view kMark{"SQLite format 3\0", 16};
    std::array<char, kApplicationAt + 4> header{};
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return false;
    const ssize_t got = ::read(descriptor, header.data(), header.size());
    ::close(descriptor);
    if (got != static_cast<ssize_t>(header.size()) || std::memcmp(header.data(), kMark.data(), kMark.size()) != 0)
        return false;
    uint32_t application = 0;
    for (size_t i = 0; i < 4; ++i)
        application = application << 8 | static_cast<unsigned char>(header[kApplicationAt + i]);
    return application == kRecordingApplication;
}

struct RecordingWriter::Statements {
    explicit Statements(Database& database)
        : frame(database, "INSERT INTO frames VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"),
          payload(database, "INSERT INTO payloads VALUES (?, ?, ?, ?, ?, ?, ?)") {}
    Query frame, payload;
};

RecordingWriter::RecordingWriter(const fs::path& file) : database_(created(file), DatabaseUse::kLog) {
    Transaction schema(database_);
    database_.run(
        text("PRAGMA application_id = ", kRecordingApplication, "; PRAGMA user_version = ", kRecordingSchema));
    for (const std::string_view table : kRecordingTables) database_.run(std::string(table));
    schema.commit();
    database_.run("PRAGMA wal_checkpoint(TRUNCATE)");  // whoever looks at the file alone recognises it
    statements_ = std::make_unique<Statements>(database_);
}

RecordingWriter::~RecordingWriter() = default;

RecordingWriter::Sequence& RecordingWriter::expect(SequenceRole role) {
    auto& sequence = sequences_[place_of(role)];
    PATINA_ASSERT(sequence, "no sequence '", name_of(role), "' has begun in ", file().string());
    return *sequence;
}

void RecordingWriter::change() {
    if (!transaction_) transaction_.emplace(database_);
}

void RecordingWriter::begin(SequenceRole role, const RecordedSequence& sequence) {
    auto& kept = sequences_[place_of(role)];
    PATINA_ASSERT(!kept, "sequence '", name_of(role), "' begins twice in ", file().string());
    change();
    kept.emplace().description = description_of(sequence.info);
    write_sequence(role, false);
    write_streams(role, sequence);
    for (const Attachment& attachment : sequence.attachments) {
        const ContentDigest digest = attachment_digest(role, attachment);
        Query(database_, "INSERT INTO attachments VALUES (?, ?, ?, ?)")
            .with(number_of(role))
            .with(std::string_view(attachment.name))
            .with(bytes_in(attachment.content))
            .with(std::span<const std::byte>(digest))
            .run();
    }
    commit();
}

void RecordingWriter::write_sequence(SequenceRole role, bool ended) {
    Sequence& sequence = expect(role);
    const ContentDigest digest = sequence_digest(role, sequence.description, sequence.frames, ended);
    Query(database_, "INSERT OR REPLACE INTO sequences VALUES (?, ?, ?, ?, ?, ?)")
        .with(number_of(role))
        .with(std::string_view(name_of(role)))
        .with(std::string_view(sequence.description))
        .with(int64_t{sequence.frames})
        .with(int64_t{ended})
        .with(std::span<const std::byte>(digest))
        .run();
    sequence.changed = false;
}

void RecordingWriter::write_streams(SequenceRole role, const RecordedSequence& sequence) {
    PATINA_ASSERT(sequence.streams.size() <= kMostStreams, sequence.streams.size(), " streams");
    for (const RecordedStream& stream : sequence.streams) {
        expect(role).streams.push_back(streams_);
        const ContentDigest digest = stream_digest(role, streams_, stream);
        Query(database_, "INSERT INTO streams VALUES (?, ?, ?, ?, ?, ?)")
            .with(int64_t{streams_++})
            .with(number_of(role))
            .with(std::string_view(stream.name))
            .with(std::string_view(stream.encoding))
            .with(stream.seconds_per_tick)
            .with(std::span<const std::byte>(digest))
            .run();
    }
}

void RecordingWriter::add(SequenceRole role, const RecordedFrame& frame) {
    Sequence& sequence = expect(role);
    PATINA_ASSERT(frame.index == sequence.frames, "frame ", frame.index, " after ", sequence.frames, " frames");
    change();
    for (const Payload& payload : frame.payloads) write_payload(role, frame.index, payload);
    const std::string pose = pose_text(frame.world_from_camera);
    const auto payloads = static_cast<int64_t>(frame.payloads.size());
    const ContentDigest digest = frame_digest(role, frame, pose, payloads);
    statements_->frame.again()
        .with(number_of(role))
        .with(int64_t{frame.index})
        .with(frame.timestamp_s)
        .with(frame.arrival_s.value_or(std::nan("")))
        .with(frame.exposure.exposure_s)
        .with(frame.exposure.gain)
        .with(std::string_view(pose))
        .with(frame.pose_defect)
        .with(std::string_view(frame.skipped))
        .with(payloads)
        .with(std::span<const std::byte>(digest))
        .run();
    ++sequence.frames;
    sequence.changed = true;
}

void RecordingWriter::write_payload(SequenceRole role, uint32_t frame, const Payload& payload) {
    const std::vector<uint32_t>& streams = expect(role).streams;
    PATINA_ASSERT(payload.stream < streams.size(), "stream ", payload.stream, " of ", streams.size());
    const int64_t stream = streams[payload.stream];
    const ContentDigest digest = payload_digest(stream, frame, payload);
    statements_->payload.again()
        .with(stream)
        .with(int64_t{frame})
        .with(payload.number)
        .with(payload.ticks)
        .with(std::string_view(payload.attributes))
        .with(bytes_in(payload.content))
        .with(std::span<const std::byte>(digest))
        .run();
}

void RecordingWriter::commit() {
    if (!transaction_) return;
    for (const SequenceRole role : kRoles) {
        const auto& sequence = sequences_[place_of(role)];
        if (sequence && sequence->changed) write_sequence(role, false);
    }
    transaction_->commit();
    transaction_.reset();
}

void RecordingWriter::finish() {
    change();
    for (const SequenceRole role : kRoles) {
        if (sequences_[place_of(role)]) write_sequence(role, true);
    }
    commit();
    statements_.reset();  // a statement that is open keeps the log
    database_.run(text("PRAGMA busy_timeout = ", kPatienceWithReadersMs));
    try {
        database_.run("PRAGMA wal_checkpoint(TRUNCATE)");
        database_.run("PRAGMA journal_mode = DELETE");
    } catch (const DatabaseBusy&) {  // a reader keeps the log; all is committed
    }
}

struct RecordingFile::Statements {
    explicit Statements(Database& database)
        : frame(database, "SELECT * FROM frames WHERE sequence = ? AND frame = ?"),
          payload(database,
                  "SELECT number, ticks, attributes, content, digest FROM payloads WHERE stream = ? AND "
                  "frame = ?") {}
    Query frame, payload;
};

RecordingFile::RecordingFile(const fs::path& file) : database_((expect_file(file), file), DatabaseUse::kRead) {
    const std::string name = "'" + file.string() + "'";
    if (pragma(database_, "application_id") != kRecordingApplication) throw Error(name, " is no recording of Patina");
    if (const int64_t version = pragma(database_, "user_version"); version != kRecordingSchema)
        throw Error(name, " is a recording of version ", version, ", but this program reads version ",
                    kRecordingSchema);
    // A table of the right name that is something else, such as a view, could run whatever it likes.
    Query tables(database_, "SELECT sql FROM sqlite_master WHERE sql IS NOT NULL ORDER BY rowid");
    for (const std::string_view expected : kRecordingTables) {
        if (!tables.next() || tables.text(0) != expected)
            throw Error(name, " is damaged: its tables are not a recording's");
    }
    if (tables.next()) throw Error(name, " is damaged: it holds more than a recording's tables");
    read_sequences();
    statements_ = std::make_unique<Statements>(database_);
}

RecordingFile::~RecordingFile() = default;

const RecordedSequence& RecordingFile::sequence(SequenceRole role) const {
    const auto& sequence = sequences_[place_of(role)];
    if (!sequence) throw Error("'", file().string(), "' holds no ", name_of(role), " sequence");
    return *sequence;
}

void RecordingFile::read_sequences() {
    const std::string where = text("'", file().string(), "': table sequences");
    Query rows(database_, "SELECT sequence, description, frames, ended, digest FROM sequences");
    while (rows.next()) {
        const int64_t number = rows.number(0);
        if (number != number_of(SequenceRole::kMain) && number != number_of(SequenceRole::kLighting))
            throw Error(where, " has a row of number ", number, ", must be 0 or 1");
        const auto role = static_cast<SequenceRole>(number);
        const std::string description = rows.text(1);
        const int64_t frames = rows.number(2), ended = rows.number(3);
        if (!is_digest(rows, 4, sequence_digest(role, description, frames, ended))) fail_digest(where);
        sequences_[place_of(role)] = read_sequence(role, description, frames);
        ended_[place_of(role)] = ended != 0;
    }
    if (!has(SequenceRole::kMain)) throw Error("'", file().string(), "' holds no sequence yet");
}

RecordedSequence RecordingFile::read_sequence(SequenceRole role, const std::string& description, int64_t frames) {
    const std::string where = text("'", file().string(), "': the ", name_of(role), " sequence");
    RecordedSequence sequence;
    sequence.info = info_of(description, where);
    // No frame takes less than a row of its table; pages that are free count as well.
    constexpr int64_t kLeastRow = 32;
    const int64_t bytes = pragma(database_, "page_count") * pragma(database_, "page_size");
    if (frames < 0 || frames > UINT32_MAX || frames > bytes / kLeastRow)
        throw Error(where, " is said to have ", frames, " frames in ", bytes, " bytes");
    sequence.info.frames = static_cast<uint32_t>(frames);
    read_streams(role, sequence);
    read_attachments(role, sequence);
    return sequence;
}

void RecordingFile::read_streams(SequenceRole role, RecordedSequence& sequence) {
    Query rows(database_,
               "SELECT stream, name, encoding, seconds_per_tick, digest FROM streams WHERE sequence = ? "
               "ORDER BY stream");
    rows.with(number_of(role));
    while (rows.next()) {
        const int64_t number = rows.number(0);
        if (sequence.streams.size() == kMostStreams)
            throw Error("'", file().string(), "': the ", name_of(role), " sequence has more than ", kMostStreams,
                        " streams");
        const RecordedStream stream{rows.text(1), rows.text(2), rows.real(3)};
        if (!is_digest(rows, 4, stream_digest(role, number, stream)))
            fail_digest(text("'", file().string(), "': stream ", number));
        sequence.streams.push_back(stream);
        stream_numbers_[place_of(role)].push_back(static_cast<uint32_t>(number));
    }
}

void RecordingFile::read_attachments(SequenceRole role, RecordedSequence& sequence) {
    Query rows(database_, "SELECT name, content, digest FROM attachments WHERE sequence = ? ORDER BY name");
    rows.with(number_of(role));
    while (rows.next()) {
        Attachment attachment{rows.text(0), copied(rows.blob(1))};
        if (!is_digest(rows, 2, attachment_digest(role, attachment)))
            fail_digest(text("'", file().string(), "': '", attachment.name, "'"));
        sequence.attachments.push_back(std::move(attachment));
    }
}

std::variant<RecordedFrame, Skipped> RecordingFile::read(SequenceRole role, uint32_t index) {
    try {
        RecordedFrame frame = read_frame(role, index);
        if (!frame.skipped.empty()) return Skipped{index, frame.skipped};
        return frame;
    } catch (const Error& error) {
        return Skipped{index, error.what()};
    }
}

RecordedFrame RecordingFile::read_frame(SequenceRole role, uint32_t index) {
    const std::string where = text("'", file().string(), "': frame ", index, " of the ", name_of(role), " sequence");
    Query& row = statements_->frame.again().with(number_of(role)).with(int64_t{index});
    if (!row.next()) throw Error(where, " is missing");
    RecordedFrame frame;
    frame.index = index;
    frame.timestamp_s = row.real(2);
    if (!row.is_null(3)) frame.arrival_s = row.real(3);
    frame.exposure = {row.real(4), row.real(5)};
    const std::string pose = row.text(6);
    frame.pose_defect = row.real(7);
    frame.skipped = row.text(8);
    const int64_t payloads = row.number(9);
    if (!is_digest(row, 10, frame_digest(role, frame, pose, payloads))) fail_digest(where);
    frame.world_from_camera = pose_of(pose, where);
    if (!std::isfinite(frame.timestamp_s)) throw Error(where, " has no finite time");
    if (!(frame.exposure.exposure_s > 0) || !(frame.exposure.gain > 0) || !std::isfinite(frame.exposure.exposure_s) ||
        !std::isfinite(frame.exposure.gain))
        throw Error(where, " has an exposure of ", frame.exposure.exposure_s, " s and a gain of ", frame.exposure.gain,
                    ", must be positive");
    row.again();  // a statement that is open keeps the log from being emptied
    read_payloads(role, frame, static_cast<size_t>(payloads));
    return frame;
}

void RecordingFile::read_payloads(SequenceRole role, RecordedFrame& frame, size_t count) {
    const std::vector<uint32_t>& streams = stream_numbers_[place_of(role)];
    for (uint32_t i = 0; i < streams.size(); ++i) {
        Query& row = statements_->payload.again().with(int64_t{streams[i]}).with(int64_t{frame.index});
        if (!row.next()) continue;
        Payload payload{i, row.number(0), row.number(1), row.text(2), copied(row.blob(3))};
        const bool whole = is_digest(row, 4, payload_digest(streams[i], frame.index, payload));
        row.again();
        if (!whole)
            fail_digest(text("'", file().string(), "': '", sequence(role).streams[i].name, "' of frame ", frame.index));
        frame.payloads.push_back(std::move(payload));
    }
    if (frame.payloads.size() != count)
        throw Error("'", file().string(), "': frame ", frame.index, " has ", frame.payloads.size(), " of ", count,
                    " payloads");
}

}  // namespace patina::sensor
