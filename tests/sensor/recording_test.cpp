#include <chrono>
#include <cstring>
#include <optional>
#include <random>
#include <thread>

#include <gmock/gmock.h>

#include "engine/core/error.h"
#include "sensor/files/picture_file.h"
#include "sensor/inspect.h"
#include "sensor/open.h"
#include "sensor/recording/exposure_check.h"
#include "sensor/recording/log_keeper.h"
#include "sensor/recording/payload_codec.h"
#include "sensor/recording/schema.h"
#include "sensor/write_sequence.h"
#include "tests/sensor/recording_rig.h"
#include "tests/sensor/sequences.h"
#include "tests/support/file_size_limit.h"

// One file that holds what a camera saw, whatever ended the recording.

namespace patina::sensor::recording_test {
namespace {

using namespace testing;
namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

template <class Pixel>
Image<Pixel> random_image(Extent2D extent, uint32_t seed) {
    std::mt19937 random(seed);
    Image<Pixel> image(extent);
    auto* bytes = reinterpret_cast<uint8_t*>(image.pixels().data());
    for (size_t i = 0; i < extent.area() * sizeof(Pixel); ++i) bytes[i] = static_cast<uint8_t>(random());
    return image;
}

template <class Pixel>
void expect_same_bytes(const Image<Pixel>& a, const Image<Pixel>& b) {
    ASSERT_EQ(a.extent(), b.extent());
    EXPECT_EQ(std::memcmp(a.pixels().data(), b.pixels().data(), a.extent().area() * sizeof(Pixel)), 0);
}

TEST(PayloadCodec, LosesNothingOfAnyPicture) {
    // Every bit pattern of floats, NaN too; sizes of one pixel, one row, and no multiple of anything.
    for (const Extent2D extent : {Extent2D{1, 1}, {17, 1}, {1, 9}, {33, 21}}) {
        const ColorImage codes = random_image<SrgbPixel>(extent, 1), linear = random_image<glm::vec3>(extent, 2);
        const DepthImage units = random_image<uint16_t>(extent, 3), metres = random_image<float>(extent, 4);
        expect_same_bytes(std::get<0>(codes), std::get<0>(decode_color(kRgb8, encode(codes), extent, "x")));
        expect_same_bytes(std::get<1>(linear), std::get<1>(decode_color(kRgbFloat, encode(linear), extent, "x")));
        expect_same_bytes(std::get<0>(units), std::get<0>(decode_depth(kDepth16, encode(units), extent, "x")));
        expect_same_bytes(std::get<1>(metres), std::get<1>(decode_depth(kDepthFloat, encode(metres), extent, "x")));
    }
}

TEST(PayloadCodec, OtherSizesAndEncodingsAreErrors) {
    const std::vector<uint8_t> packed = encode(DepthImage(random_image<uint16_t>({8, 8}, 1)));
    EXPECT_THAT(error_of([&] {
                    decode_depth(kDepth16, packed, {8, 9}, "f.patina");
                }),
                AllOf(HasSubstr("f.patina"), HasSubstr("128"), HasSubstr("144")));
    EXPECT_THAT(error_of([&] { decode_depth(kDepth16, packed, {4, 4}, "f.patina"); }), HasSubstr("decompressed"));
    EXPECT_THAT(error_of([&] { decode_depth("kinect2", packed, {8, 8}, "f.patina"); }), HasSubstr("'kinect2'"));
}

std::vector<RecordedFrame> raw_frames(uint32_t count, size_t bytes) {
    std::vector<RecordedFrame> frames;
    for (uint32_t i = 0; i < count; ++i) frames.push_back(raw_frame(i, bytes));
    return frames;
}

class RecordingTest : public ::testing::Test {
  protected:
    fs::path file() const { return folder_ / "room.patina"; }
    const TemporaryFolder folder_;
};

TEST_F(RecordingTest, ReadsAsTheFolderThatItWasRecordedFrom) {
    write_native(folder_ / "s", 4);
    write_native(folder_ / "s/lighting", 2);
    {
        Recorder recorder(file());
        for (const auto& [role, path] :
             {std::pair(SequenceRole::kMain, folder_ / "s"), {SequenceRole::kLighting, folder_ / "s/lighting"}}) {
            const auto source = open_sequence(path);
            RecordedSequence sequence;
            sequence.info = source->info();
            recorder.begin(role, std::move(sequence));
            for (const Reading& reading : read_all(*source)) recorder.record(std::get<Frame>(reading));
        }
        recorder.finish();
    }
    EXPECT_EQ(lighting_of(file()), file() / "lighting");
    EXPECT_EQ(main_of(file() / "lighting"), file());
    for (const auto& [path, original] :
         {std::pair(file(), folder_ / "s"), {file() / "lighting", folder_ / "s/lighting"}}) {
        const auto source = open_sequence(path), folder = open_sequence(original);
        const SequenceInfo &info = source->info(), &expected = folder->info();
        EXPECT_EQ(info.format, "patina-recording");
        EXPECT_EQ(info.name, expected.name);
        EXPECT_EQ(info.frames, expected.frames);
        EXPECT_EQ(info.color, expected.color);
        EXPECT_EQ(info.depth, expected.depth);
        EXPECT_EQ(info.color_from_depth, expected.color_from_depth);
        EXPECT_EQ(info.has_poses, expected.has_poses);
        EXPECT_EQ(info.exposure_known, expected.exposure_known);
        const std::vector<Reading> got = read_all(*source), wanted = read_all(*folder);
        ASSERT_EQ(got.size(), wanted.size());
        for (size_t i = 0; i < got.size(); ++i)
            EXPECT_TRUE(same_frame(std::get<Frame>(got[i]), std::get<Frame>(wanted[i]))) << i;
    }
    EXPECT_FALSE(fs::exists(file().string() + "-wal"));  // a recording that has ended is one file
}

TEST_F(RecordingTest, KeepsWhatADeviceSaidToTheLastBit) {
    {
        Recorder recorder(file());
        recorder.begin(SequenceRole::kMain, raw_sequence());
        for (uint32_t i = 0; i < 5; ++i) {
            if (i == 2)
                recorder.skip({2, "a packet was lost"});
            else
                recorder.record(raw_frame(i, 100000));
        }
        recorder.finish();
    }
    RecordingFile recording(file());
    const RecordedSequence& sequence = recording.sequence(SequenceRole::kMain);
    EXPECT_TRUE(recording.ended(SequenceRole::kMain));
    EXPECT_EQ(sequence.info.frames, 5u);
    EXPECT_EQ(sequence.streams[0].encoding, "noise");
    EXPECT_EQ(sequence.streams[0].seconds_per_tick, 125e-6);
    EXPECT_EQ(sequence.attachments[1].content, raw_sequence().attachments[1].content);
    const auto frame = std::get<RecordedFrame>(recording.read(SequenceRole::kMain, 3));
    const RecordedFrame expected = raw_frame(3, 100000);
    EXPECT_EQ(frame.timestamp_s, expected.timestamp_s);
    EXPECT_EQ(frame.arrival_s, expected.arrival_s);
    EXPECT_EQ(frame.payloads[0].number, 10);
    EXPECT_EQ(frame.payloads[0].ticks, 801);
    EXPECT_EQ(frame.payloads[0].attributes, R"({"gain":1.5})");
    EXPECT_EQ(frame.payloads[0].content, expected.payloads[0].content);
    EXPECT_EQ(std::get<Skipped>(recording.read(SequenceRole::kMain, 2)).reason, "a packet was lost");
    EXPECT_THAT(error_of([&] { open_sequence(file()); }),
                AllOf(HasSubstr("room.patina"), HasSubstr("'infrared'"), HasSubstr("no decoder")));
}

/// Makes both pictures of the first bytes of a payload.
class FirstBytes : public PayloadDecoder {
  public:
    void decode(const RecordedFrame& recorded, Frame& frame) override {
        const std::vector<uint8_t>& bytes = recorded.payloads.at(0).content;
        frame.color = Image<SrgbPixel>({32, 24}, SrgbPixel(bytes[0], bytes[1], bytes[2]));
        frame.depth = Image<uint16_t>({16, 12}, static_cast<uint16_t>(bytes[3] + 1));
    }
};

TEST_F(RecordingTest, ADevicesOwnPayloadsAreReadByItsDecoder) {
    {
        Recorder recorder(file());
        recorder.begin(SequenceRole::kMain, raw_sequence());
        recorder.record(raw_frame(0, 100));
        recorder.finish();
    }
    const auto source = open_sequence(file(), "", [](const RecordedSequence& sequence, const std::string& where) {
        EXPECT_EQ(sequence.attachments.size(), 2u);
        EXPECT_THAT(where, HasSubstr("room.patina"));
        return std::make_unique<FirstBytes>();
    });
    const std::vector<Reading> readings = read_all(*source);
    EXPECT_EQ(std::get<Image<SrgbPixel>>(std::get<Frame>(readings.at(0)).color).at(5, 5).g, noise_bytes(2, 0)[1]);
}

/// Fails as a device does: at frame 0 for a damaged frame, at frame 1 for good.
class FailingDecoder : public PayloadDecoder {
  public:
    void decode(const RecordedFrame& recorded, Frame& /*frame*/) override {
        if (recorded.index == 0) throw DamagedFrame("frame 0 is damaged");
        throw Error("the device is lost");
    }
};

TEST_F(RecordingTest, ADamagedFrameIsSkippedAndALostDeviceIsAnError) {
    {
        Recorder recorder(file());
        recorder.begin(SequenceRole::kMain, raw_sequence());
        for (uint32_t i = 0; i < 2; ++i) recorder.record(raw_frame(i, 100));
        recorder.finish();
    }
    const auto source = open_sequence(
        file(), "", [](const RecordedSequence&, const std::string&) { return std::make_unique<FailingDecoder>(); });
    EXPECT_EQ(std::get<Skipped>(*source->next()).reason, "frame 0 is damaged");
    EXPECT_EQ(error_of([&] { source->next(); }), "the device is lost");
}

TEST_F(RecordingTest, OpensAsItIsWhileItIsWrittenAndWhenItWasCutOff) {
    RecordingWriter writer(file());
    writer.begin(SequenceRole::kMain, raw_sequence());
    for (uint32_t i = 0; i < 3; ++i) writer.add(SequenceRole::kMain, raw_frame(i, 1000));
    writer.commit();
    writer.add(SequenceRole::kMain, raw_frame(3, 1000));  // never committed
    // What lies on the disk now is what a kill would leave.
    fs::copy(file(), folder_ / "cut.patina");
    fs::copy(file().string() + "-wal", (folder_ / "cut.patina").string() + "-wal");
    for (const fs::path& path : {file(), folder_ / "cut.patina"}) {
        ASSERT_TRUE(is_recording(path));
        RecordingFile recording(path);
        EXPECT_FALSE(recording.ended(SequenceRole::kMain));
        EXPECT_EQ(recording.sequence(SequenceRole::kMain).info.frames, 3u);
        for (uint32_t i = 0; i < 3; ++i)
            EXPECT_EQ(std::get<RecordedFrame>(recording.read(SequenceRole::kMain, i)).payloads[0].content,
                      raw_frame(i, 1000).payloads[0].content);
    }
}

TEST_F(RecordingTest, AFullDiskKeepsWhatWasWritten) {
    std::vector<RecordedFrame> frames = raw_frames(60, 1 << 20);
    std::string problem;
    RecorderCounts counts;
    {
        // Room for the empty tables and some ten frames of a megabyte, in the file or in its log.
        const test::FileSizeLimit limit(12 << 20);
        Recorder recorder(file(), {.when_full = Recorder::WhenFull::kWait, .most_queued_bytes = 3 << 20});
        recorder.begin(SequenceRole::kMain, raw_sequence());
        for (RecordedFrame& frame : frames) recorder.record(std::move(frame));
        problem = error_of([&] { recorder.finish(); });
        counts = recorder.counts();
    }
    EXPECT_THAT(problem, AllOf(HasSubstr("what was written before is kept"), HasSubstr("room.patina")));
    EXPECT_EQ(counts.given, 60u);
    EXPECT_EQ(counts.written + counts.lost, 60u);
    RecordingFile recording(file());
    const uint32_t kept = *recording.sequence(SequenceRole::kMain).info.frames;
    EXPECT_EQ(kept, counts.written);
    for (uint32_t i = 0; i < kept; ++i)
        EXPECT_EQ(std::get<RecordedFrame>(recording.read(SequenceRole::kMain, i)).payloads[0].content,
                  raw_frame(i, 1 << 20).payloads[0].content);
    Database database(file(), DatabaseUse::kRead);
    check_integrity(database);
}

TEST_F(RecordingTest, ACameraThatIsTooFastLosesFramesNotOrder) {
    std::vector<RecordedFrame> frames = raw_frames(40, 400000);  // before, so that nothing slows the camera down
    Recorder recorder(file(), {.most_queued_bytes = 1 << 20});
    recorder.begin(SequenceRole::kMain, raw_sequence());
    for (RecordedFrame& frame : frames) recorder.record(std::move(frame));
    recorder.finish();
    const RecorderCounts counts = recorder.counts();
    EXPECT_EQ(counts.given, 40u);
    EXPECT_EQ(counts.written, 40u);  // those that are dropped are noted
    EXPECT_LE(counts.most_queued_bytes, 1u << 20);
    RecordingFile recording(file());
    uint32_t dropped = 0;
    for (uint32_t i = 0; i < 40; ++i) {
        auto read = recording.read(SequenceRole::kMain, i);
        if (const auto* skipped = std::get_if<Skipped>(&read)) {
            ++dropped;
            EXPECT_THAT(skipped->reason, HasSubstr("did not keep pace"));
        } else {
            EXPECT_EQ(std::get<RecordedFrame>(read).payloads[0].content, raw_frame(i, 400000).payloads[0].content);
        }
    }
    EXPECT_EQ(dropped, counts.dropped);
    EXPECT_GT(dropped, 0u);
}

/// A program that warns of frames without pictures counts those that it dropped itself apart.
TEST_F(RecordingTest, WhatWasDroppedIsNoReasonWhyFramesLackPictures) {
    Recorder recorder(file());
    recorder.begin(SequenceRole::kMain, raw_sequence());
    recorder.skip({0, "a packet was lost"});
    recorder.skip({1, "dropped: too many frames before it waited", true});
    EXPECT_EQ(recorder.skipped_for(), "a packet was lost");
    recorder.finish();
    EXPECT_EQ(recorder.counts().skipped, 2u);
    RecordingFile recording(file());
    EXPECT_THAT(std::get<Skipped>(recording.read(SequenceRole::kMain, 1)).reason, HasSubstr("dropped: too many"));
}

TEST_F(RecordingTest, NeverWritesOverAFile) {
    write_text(file(), "mine");
    EXPECT_THAT(error_of([&] { Recorder recorder(file()); }), HasSubstr("exists already"));
    EXPECT_EQ(read_text(file()), "mine");
    EXPECT_THAT(error_of([&] { Recorder recorder(folder_ / "none/room.patina"); }), HasSubstr("No such file"));
}

TEST_F(RecordingTest, OtherDatabasesAreNoRecordings) {
    { Database(folder_ / "other.sqlite").run("CREATE TABLE t (x)"); }
    EXPECT_FALSE(is_recording(folder_ / "other.sqlite"));
    EXPECT_THAT(error_of([&] { RecordingFile recording(folder_ / "other.sqlite"); }), HasSubstr("no recording"));
    write_recording(file(), 1);
    { Database(file()).run("PRAGMA user_version = 9"); }
    EXPECT_THAT(error_of([&] { open_sequence(file()); }), AllOf(HasSubstr("version 9"), HasSubstr("version 1")));
    { Database(file()).run("PRAGMA user_version = 1; CREATE TRIGGER t AFTER INSERT ON frames BEGIN SELECT 1; END"); }
    EXPECT_THAT(error_of([&] { open_sequence(file()); }), HasSubstr("more than a recording's tables"));
}

/// A file may say that it has four thousand million frames.
TEST_F(RecordingTest, MoreFramesThanTheFileHoldsAreAnError) {
    write_recording(file(), 1);
    constexpr int64_t kClaimed = 4'000'000'000;
    {
        Database database(file());
        database.run("UPDATE sequences SET frames = 4000000000");
        EXPECT_THAT(error_of([&] { open_sequence(file()); }), HasSubstr("digest"));
        Query description(database, "SELECT description FROM sequences");
        ASSERT_TRUE(description.next());
        const ContentDigest digest = sequence_digest(SequenceRole::kMain, description.text(0), kClaimed, 1);
        description.again();
        Query(database, "UPDATE sequences SET digest = ?").with(std::span<const std::byte>(digest)).run();
    }
    EXPECT_THAT(error_of([&] { open_sequence(file()); }), HasSubstr("is said to have 4000000000 frames"));
}

TEST_F(RecordingTest, MoreStreamsThanACameraHasAreAnError) {
    write_recording(file(), 1);
    {
        Database database(file());
        for (int64_t number = 4; number <= 64; ++number) {
            const RecordedStream stream{"color", std::string(kRgb8), 1e-9};
            const ContentDigest digest = stream_digest(SequenceRole::kMain, number, stream);
            Query(database, "INSERT INTO streams VALUES (?, 0, 'color', 'zstd-rgb8', 1e-9, ?)")
                .with(number)
                .with(std::span<const std::byte>(digest))
                .run();
        }
    }
    EXPECT_THAT(error_of([&] { open_sequence(file()); }), HasSubstr("has more than 64 streams"));
}

TEST_F(RecordingTest, AReaderDoesNotKeepItFromItsEnd) {
    RecordedFrame first = raw_frame(0, 1000);
    std::optional<RecordingFile> reader;
    {
        Recorder recorder(file());
        recorder.begin(SequenceRole::kMain, raw_sequence());
        recorder.record(std::move(first));
        while (recorder.counts().written == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
        reader.emplace(file());
        EXPECT_NO_THROW(recorder.finish());
    }
    EXPECT_FALSE(reader->ended(SequenceRole::kMain));  // as it was when it was opened
    EXPECT_TRUE(std::holds_alternative<RecordedFrame>(reader->read(SequenceRole::kMain, 0)));
    EXPECT_TRUE(RecordingFile(file()).ended(SequenceRole::kMain));
    fs::copy(file(), folder_ / "alone.patina");  // the log beside it holds nothing that the file lacks
    EXPECT_TRUE(RecordingFile(folder_ / "alone.patina").ended(SequenceRole::kMain));
}

TEST_F(RecordingTest, WhatComesAfterItsEndIsCountedAsLost) {
    Recorder recorder(file(), {.when_full = Recorder::WhenFull::kWait, .most_queued_bytes = 1});
    recorder.begin(SequenceRole::kMain, raw_sequence());
    recorder.record(raw_frame(0, 1000));
    recorder.finish();
    recorder.record(raw_frame(1, 1000));
    recorder.skip({2, "late"});
    EXPECT_EQ(recorder.counts().given, 3u);
    EXPECT_EQ(recorder.counts().written, 1u);
    EXPECT_EQ(recorder.counts().lost, 2u);
    EXPECT_EQ(recorder.counts().skipped, 1u);
    EXPECT_EQ(recorder.skipped_for(), "late");
    EXPECT_EQ(RecordingFile(file()).sequence(SequenceRole::kMain).info.frames, 1u);
    recorder.discard();
    EXPECT_FALSE(fs::exists(file()));
}

TEST_F(RecordingTest, ASequenceOfLowExposureWithoutAFrameIsNone) {
    {
        Recorder recorder(file());
        recorder.begin(SequenceRole::kMain, raw_sequence());
        recorder.record(raw_frame(0, 1000));
        recorder.begin(SequenceRole::kLighting, raw_sequence());
        recorder.finish();
    }
    EXPECT_TRUE(RecordingFile(file()).has(SequenceRole::kLighting));
    EXPECT_EQ(lighting_of(file()), fs::path());
}

TEST_F(RecordingTest, ALogThatCannotBeKeptIsReported) {
    write_text(file(), "no database, but longer than the header of one is");
    LogKeeper keeper(file());
    keeper.committed(0);
    while (keeper.problem().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_THAT(keeper.problem(), HasSubstr("room.patina"));
    write_text(file().string() + "-wal", "a long log");
    keeper.committed(0);  // does not wait for what does not come
}

TEST_F(RecordingTest, ADamagedRowCostsItsFrame) {
    write_recording(file(), 4);
    const auto reason_after = [&](const std::string& change) {
        fs::copy(file(), folder_ / "damaged.patina", fs::copy_options::overwrite_existing);
        { Database(folder_ / "damaged.patina").run(change); }
        const std::vector<Reading> readings = read_all(*open_sequence(folder_ / "damaged.patina"));
        EXPECT_EQ(readings.size(), 4u);
        for (const size_t other : {0, 2, 3}) EXPECT_TRUE(std::holds_alternative<Frame>(readings.at(other))) << change;
        const auto* skipped = std::get_if<Skipped>(&readings.at(1));
        return skipped ? skipped->reason : "nothing";
    };
    EXPECT_THAT(reason_after("UPDATE frames SET time_s = time_s + 1e-9 WHERE frame = 1"), HasSubstr("digest"));
    EXPECT_THAT(reason_after("UPDATE frames SET pose = '' WHERE frame = 1"), HasSubstr("digest"));
    EXPECT_THAT(reason_after("DELETE FROM frames WHERE frame = 1"), HasSubstr("missing"));
    EXPECT_THAT(reason_after("DELETE FROM payloads WHERE frame = 1 AND stream = 0"), HasSubstr("1 of 2 payloads"));
    EXPECT_THAT(
        reason_after("UPDATE payloads SET content = (SELECT content FROM payloads WHERE frame = 2 AND stream = 0) "
                     "WHERE frame = 1 AND stream = 0"),
        HasSubstr("digest"));
}

TEST(ExposureCheck, SaysWhatToChange) {
    const auto advice_on = [](SequenceRole role, std::vector<Image<SrgbPixel>> pictures) {
        ExposureCheck check(role);
        for (const auto& picture : pictures) check.add(picture);
        return check.advice();
    };
    const Extent2D extent{64, 48};
    Image<SrgbPixel> lamp(extent, SrgbPixel(10)), clipped = lamp;
    for (uint32_t y = 0; y < 8; ++y)
        for (uint32_t x = 0; x < 8; ++x) lamp.at(x, y) = SrgbPixel(200), clipped.at(x, y) = SrgbPixel(255, 200, 10);
    const Image<SrgbPixel> bright(extent, SrgbPixel(120)), dark(extent, SrgbPixel(10)), white(extent, SrgbPixel(255));
    EXPECT_EQ(advice_on(SequenceRole::kLighting, {lamp, dark}), "");
    EXPECT_THAT(advice_on(SequenceRole::kLighting, {lamp, clipped}), HasSubstr("a lamp is clipped"));
    EXPECT_THAT(advice_on(SequenceRole::kLighting, {bright}), HasSubstr("lamps alone"));
    EXPECT_THAT(advice_on(SequenceRole::kLighting, {dark}), HasSubstr("no frame shows a lamp"));
    EXPECT_EQ(advice_on(SequenceRole::kMain, {bright, clipped}), "");
    EXPECT_THAT(advice_on(SequenceRole::kMain, {white}), HasSubstr("shorten the exposure"));
    EXPECT_DOUBLE_EQ(exposure_shares(clipped).clipped, 64.0 / (64 * 48));
    // Lamps are told by luminance: a full blue has 0.07 of white's.
    EXPECT_EQ(exposure_shares(Image<SrgbPixel>(extent, SrgbPixel(0, 0, 255))).bright, 0);
    EXPECT_EQ(exposure_shares(Image<SrgbPixel>(extent, SrgbPixel(0, 255, 0))).bright, 1);
    EXPECT_EQ(exposure_shares(Image<glm::vec3>(extent, glm::vec3(0, 0.2f, 0))).bright, 1);
}

}  // namespace
}  // namespace patina::sensor::recording_test
