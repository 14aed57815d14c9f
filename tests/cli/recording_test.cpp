#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <set>
#include <thread>

#include "sensor/open.h"
#include "sensor/pose.h"
#include "sensor/recording/recorder.h"
#include "tests/cli/run_folder.h"
#include "tests/support/file_size_limit.h"

// patina record, export and live: what a camera saw, kept, unpacked, and reconstructed while it is seen.

namespace patina::testing::recording_test {
namespace {

namespace fs = std::filesystem;
using sensor::testing::read_text;
using sensor::testing::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;

class RecordingCommands : public RunFolderTest {
  protected:
    /// A recording of a synthetic room with known lamps.
    void synthesise(const char* frames) {
        expect_done(patina(
            {"synth", "cubes", "--frames", frames, "--extent", "64x53", "--no-lighting", "--quiet", "--out", folder_}));
    }

    static void expect_done(const Outcome& outcome) {
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_EQ(outcome.signal, 0);
    }

    void record_file() { expect_done(patina({"record", folder_, "--out", file_, "--quiet"})); }

    /// The files of a run that hold what was reconstructed.
    std::map<std::string, std::string> results_of(const std::string& sequence, const fs::path& results) {
        expect_done(patina({"run", sequence, "--lights", folder_ / "truth/lights.json", "--texture", "off", "--no-map",
                            "--out", results, "--quiet"}));
        return reconstructed(results);
    }

    static std::map<std::string, std::string> reconstructed(const fs::path& results) {
        std::map<std::string, std::string> files;
        for (const char* name : {"scene.glb", "materials.json", "trajectory.txt"})
            files[name] = read_text(results / name);
        EXPECT_GT(files["scene.glb"].size(), 1000u);
        return files;
    }

    static void expect_same(const std::map<std::string, std::string>& a, const std::map<std::string, std::string>& b) {
        for (const auto& [name, content] : a) EXPECT_TRUE(b.at(name) == content) << name;
    }

    const fs::path folder_ = beside("room"), file_ = beside("room.patina");
};

TEST_F(RecordingCommands, ARecordingReconstructsAsItsFolder) {
    synthesise("6");
    record_file();
    expect_same(results_of(folder_, beside("a")), results_of(file_, beside("b")));
    const Outcome info = patina({"info", file_});
    EXPECT_THAT(info.out, HasSubstr("patina-recording"));
}

TEST_F(RecordingCommands, FramesWithoutPicturesAreTold) {
    synthesise("3");
    fs::remove(folder_ / "color/000001.png");
    const Outcome outcome = patina({"record", folder_, "--out", file_});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("warning: 1 of 3 frames have no pictures, the last of them: "));
}

TEST_F(RecordingCommands, ExportGivesBackTheFolder) {
    synthesise("4");
    fs::create_directories(folder_ / "lighting");
    for (const auto& entry : fs::directory_iterator(sequence()))
        fs::copy(entry, folder_ / "lighting" / entry.path().filename(), fs::copy_options::recursive);
    record_file();
    expect_done(patina({"export", file_, "--native", beside("native"), "--quiet"}));
    const auto before = files_in(folder_), after = files_in(beside("native"));
    for (const auto& [name, content] : after) {
        // Poses go through a quaternion each time, which may move their last digit.
        const bool same = name.ends_with("trajectory.txt") || before.at(name) == content;
        EXPECT_TRUE(same) << name;
    }
    EXPECT_TRUE(after.contains("lighting/sequence.json") && after.contains("trajectory.txt"));
    EXPECT_EQ(std::count_if(after.begin(), after.end(), [](const auto& f) { return f.first.starts_with("color/"); }),
              4);
}

TEST_F(RecordingCommands, WhatIsWrongIsOneSentence) {
    write_text(file_, "mine");
    EXPECT_THAT(expect_failure(patina({"record", sequence(), "--out", file_})), HasSubstr("exists already"));
    EXPECT_EQ(read_text(file_), "mine");
    EXPECT_THAT(expect_failure(patina({"record", beside("none"), "--out", beside("a.patina")})),
                HasSubstr("none does not exist"));
    EXPECT_FALSE(fs::exists(beside("a.patina")));
    EXPECT_THAT(expect_failure(patina({"record", sequence(), "--out", sequence() / "a.patina"})),
                HasSubstr("sequence"));
    EXPECT_THAT(expect_failure(patina({"export", file_, "--native", beside("n")})), HasSubstr("room.patina is a file"));
    EXPECT_THAT(expect_failure(patina({"live", "kinect9", "--out", out()})), HasSubstr("'kinect9'"));
    EXPECT_THAT(expect_failure(patina({"live", "kinect2", "--simulate", sequence(), "--out", out()}), 2),
                HasSubstr("--simulate excludes the name of a camera"));
    // A run that fails before its first frame leaves no recording.
    EXPECT_THAT(expect_failure(patina({"live", "--simulate", sequence(), "--out", out(), "--lights", beside("none"),
                                       "--record", beside("b.patina")})),
                HasSubstr("none"));
    EXPECT_FALSE(fs::exists(beside("b.patina")));
    EXPECT_THAT(expect_failure(patina({"live", "--simulate", sequence(), "--out", out(), "--resume", out()})),
                HasSubstr("--resume is for recordings"));
    EXPECT_TRUE(files_in(out()).empty());
}

TEST_F(RecordingCommands, AFullDiskKeepsWhatWasRecorded) {
    synthesise("60");
    Outcome outcome;
    {
        const test::FileSizeLimit limit(300000);  // the empty tables take 262144
        outcome = patina({"record", folder_, "--out", file_, "--quiet"});
    }
    EXPECT_THAT(expect_failure(outcome), AllOf(HasSubstr("what was written before is kept"), HasSubstr("frames")));
    EXPECT_TRUE(sensor::is_recording(file_));
}

/// The same recording, played by a clock that is so many times slower: whatever else the machine does, it lasts.
void slow_down(const fs::path& from, double times, const fs::path& to) {
    const auto source = sensor::open_sequence(from);
    sensor::Recorder recorder(to, {.when_full = sensor::Recorder::WhenFull::kWait});
    sensor::RecordedSequence sequence;
    sequence.info = source->info();
    recorder.begin(sensor::SequenceRole::kMain, std::move(sequence));
    while (auto reading = source->next()) {
        Frame frame = std::get<Frame>(*std::move(reading));
        frame.timestamp_s *= times;
        recorder.record(std::move(frame));
    }
    recorder.finish();
}

TEST_F(RecordingCommands, AnInterruptEndsARecordingThatIsWhole) {
    synthesise("90");
    slow_down(folder_, 20, beside("slow.patina"));  // a minute
    Program program({"record", beside("slow.patina"), "--simulate", "--out", file_});
    await_frames(program, file_, sensor::SequenceRole::kMain);
    program.send(SIGINT);
    const Outcome outcome = program.wait();
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("reflectance: move slowly"));
    sensor::RecordingFile recording(file_);
    EXPECT_TRUE(recording.ended(sensor::SequenceRole::kMain));
    EXPECT_GT(*recording.sequence(sensor::SequenceRole::kMain).info.frames, 0u);
    EXPECT_LT(*recording.sequence(sensor::SequenceRole::kMain).info.frames, 90u);
}

/// In milliseconds: trajectory.txt has six digits of a second.
int64_t milliseconds(double timestamp_s) { return std::llround(1000 * timestamp_s); }

/// Another recording with the frames alone whose times are given.
void keep_frames(const fs::path& from, const std::set<int64_t>& times_ms, const fs::path& to) {
    const auto source = sensor::open_sequence(from);
    sensor::Recorder recorder(to, {.when_full = sensor::Recorder::WhenFull::kWait});
    sensor::RecordedSequence sequence;
    sequence.info = source->info();
    recorder.begin(sensor::SequenceRole::kMain, std::move(sequence));
    uint32_t frames = 0;
    while (auto reading = source->next()) {
        Frame frame = std::get<Frame>(*std::move(reading));
        if (!times_ms.contains(milliseconds(frame.timestamp_s))) continue;
        frame.index = frames++;
        recorder.record(std::move(frame));
    }
    recorder.finish();
    EXPECT_EQ(frames, times_ms.size());
}

TEST_F(RecordingCommands, LiveIsTheRunOfTheFramesThatItUsed) {
    synthesise("40");
    const fs::path slow = beside("slow.patina");
    slow_down(folder_, 4, slow);  // 5 s
    expect_done(patina({"live", "--simulate", slow, "--lights", folder_ / "truth/lights.json", "--texture", "off",
                        "--no-map", "--out", out(), "--record", beside("beside.patina"), "--quiet"}));
    const nlohmann::json summary = summary_of(out());
    const auto &live = summary["live"], &frames = summary["frames"];
    const auto count = [](const nlohmann::json& value) { return value.get<uint32_t>(); };
    EXPECT_EQ(summary["finished"], true);
    EXPECT_EQ(count(live["captured"]), 40u);
    EXPECT_EQ(count(frames["read"]), 40u);
    EXPECT_EQ(count(frames["used"]) + frames.value("dropped", 0u), 40u);
    EXPECT_EQ(live["dropped"], frames.value("dropped", 0u));
    EXPECT_EQ(live["exposure_to_pose"]["frames"], frames["used"]);
    EXPECT_GT(live["exposure_to_pose"]["median_ms"], 0);
    EXPECT_GT(live["exposure_to_picture"]["median_ms"], 0);
    EXPECT_THAT(read_text(out() / "report.html"), HasSubstr("From exposure to"));
    EXPECT_EQ(live["recordings"].at(0)["frames"], 40u);  // dropped ones, too
    EXPECT_EQ(sensor::open_sequence(beside("beside.patina"))->info().frames, 40u);

    std::set<int64_t> used_ms;
    for (const auto& pose : sensor::read_trajectory(out() / "trajectory.txt"))
        used_ms.insert(milliseconds(pose.timestamp_s));
    keep_frames(slow, used_ms, file_);
    expect_same(reconstructed(out()), results_of(file_, beside("again")));
}

TEST_F(RecordingCommands, LiveFindsTheLightsThatTheRunOfItsFramesFinds) {
    expect_done(patina({"synth", "cubes", "--frames", "30", "--extent", "64x53", "--quiet", "--out", folder_}));
    // With the sequence of low exposure beside it.
    expect_done(patina({"live", "--simulate", folder_, "--out", out(), "--texture", "off", "--quiet"}));
    EXPECT_THAT(patina({"info", out() / "map.sqlite"}).out, HasSubstr("the run came to its end"));
    EXPECT_THAT(expect_failure(patina({"run", "--resume", out()})), HasSubstr("is of 'patina live'"));
    const nlohmann::json lights = summary_of(out())["lights"];
    EXPECT_EQ(lights["found_by"], "lighting sequence");
    std::set<int64_t> used_ms;
    for (const auto& pose : sensor::read_trajectory(out() / "trajectory.txt"))
        used_ms.insert(milliseconds(pose.timestamp_s));
    keep_frames(folder_, used_ms, file_);
    expect_done(patina({"run", file_, "--lighting", folder_ / "lighting", "--out", beside("again"), "--texture", "off",
                        "--no-map", "--quiet"}));
    EXPECT_EQ(summary_of(beside("again"))["lights"], lights);
    expect_same(reconstructed(out()), reconstructed(beside("again")));
}

/// Whether a picture of a frame was written anywhere in a folder in which a program is at work.
bool has_picture(const fs::path& folder) {
    std::error_code gone;  // what is renamed meanwhile
    for (fs::recursive_directory_iterator entry(folder, gone), end; entry != end && !gone; entry.increment(gone))
        if (entry->path().extension() == ".exr") return true;
    return false;
}

TEST_F(RecordingCommands, AnInterruptEndsALiveRunThatIsWhole) {
    synthesise("90");
    slow_down(folder_, 30, file_);  // 90 s
    Program program({"live", "--simulate", file_, "--lighting", "none", "--dump-every", "1", "--texture", "off",
                     "--no-map", "--out", out()});
    while (program.running() && !has_picture(beside("."))) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    program.send(SIGINT);
    const Outcome outcome = program.wait();
    EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
    const nlohmann::json summary = summary_of(out());
    EXPECT_EQ(summary["finished"], true);
    EXPECT_LT(summary["frames"]["read"], 90);
}

}  // namespace
}  // namespace patina::testing::recording_test
