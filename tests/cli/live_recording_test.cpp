// A live source is recorded while it goes on: begun late, ended early, more than once.

#include "tools/live/live_recording.h"

#include <gmock/gmock.h>

#include "sensor/recording/container.h"
#include "tests/export/temporary_folder.h"
#include "tests/sensor/sequences.h"

namespace patina::tools::live_recording_test {
namespace {

using sensor::SequenceRole;

class LiveRecordingTest : public ::testing::Test {
  protected:
    LiveRecordingTest() : recording_(sequence()) {}

    static sensor::RecordedSequence sequence() {
        sensor::RecordedSequence sequence;
        sequence.info = sensor::testing::test_info();
        return sequence;
    }

    void yield(uint32_t first, uint32_t end) {
        const std::vector<Reading> readings = sensor::testing::test_readings(end);
        for (uint32_t i = first; i < end; ++i) recording_.take(readings[i]);
    }

    static std::vector<double> times_in(const std::filesystem::path& file) {
        sensor::RecordingFile recording(file);
        std::vector<double> times_s;
        for (uint32_t i = 0; i < *recording.sequence(SequenceRole::kMain).info.frames; ++i)
            times_s.push_back(std::get<sensor::RecordedFrame>(recording.read(SequenceRole::kMain, i)).timestamp_s);
        return times_s;
    }

    static double time_of(uint32_t index) {
        return std::get<Frame>(sensor::testing::test_readings(index + 1).back()).timestamp_s;
    }

    const test::TemporaryFolder folder_;
    LiveRecording recording_;
};

TEST_F(LiveRecordingTest, EachFileHasTheFramesBetweenItsStartAndItsStop) {
    yield(0, 2);
    recording_.start(folder_ / "a.patina");
    EXPECT_EQ(recording_.file(), folder_ / "a.patina");
    yield(2, 5);
    recording_.stop();
    EXPECT_EQ(recording_.file(), std::nullopt);
    yield(5, 6);
    recording_.start(folder_ / "b.patina");
    yield(6, 7);
    recording_.stop();
    recording_.stop();
    ASSERT_EQ(recording_.ended().size(), 2u);
    EXPECT_EQ(recording_.ended()[0].counts.written, 3u);
    EXPECT_EQ(times_in(folder_ / "a.patina"), (std::vector<double>{time_of(2), time_of(3), time_of(4)}));
    EXPECT_EQ(times_in(folder_ / "b.patina"), (std::vector<double>{time_of(6)}));
}

TEST_F(LiveRecordingTest, WithoutAFrameThereIsNoFile) {
    recording_.start(folder_ / "a.patina");
    recording_.stop();
    EXPECT_EQ(recording_.ended().front().counts.given, 0u);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.patina"));
}

TEST_F(LiveRecordingTest, AFileThatCannotBeMadeIsAnErrorAndNothingIsOpen) {
    EXPECT_THROW(recording_.start(folder_ / "nowhere" / "a.patina"), Error);
    EXPECT_EQ(recording_.file(), std::nullopt);
    yield(0, 1);
}

}  // namespace
}  // namespace patina::tools::live_recording_test
