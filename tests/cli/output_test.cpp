#include <chrono>
#include <csignal>
#include <set>
#include <thread>

#include "tests/cli/run_folder.h"
#include "tests/support/file_size_limit.h"
#include "tools/eval/exr_planes.h"

// What the program does to the files around its results.

namespace patina::testing::output_test {
namespace {

namespace fs = std::filesystem;
using sensor::testing::read_text;
using sensor::testing::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;

class Output : public RunFolderTest {
  protected:
    /// A finished run of little work.
    void run_into(const fs::path& folder, std::vector<std::string> more = {}) {
        std::vector<std::string> arguments{"run",       sequence(), "--out",    folder,
                                           "--texture", "off",      "--no-map", "--quiet"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = patina(arguments);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    }

    /// Runs a command that must be refused, and change no file of the test's.
    std::string refusal(const std::vector<std::string>& arguments) {
        const auto before = files_in(beside(""));
        const std::string message = expect_failure(patina(arguments));
        EXPECT_EQ(files_in(beside("")), before);
        return message;
    }

    static void await(Program& program, const fs::path& file) {
        while (!fs::exists(file) && program.running()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
};

TEST_F(Output, TilesAreResultsAsOthers) {
    run_into(out(), {"--tiles"});
    const auto files = files_in(out());
    for (const char* name : {"tiles/tileset.json", "tiles/0/000000.glb", "tiles/2/000000.glb", "scene.glb"}) {
        EXPECT_EQ(files.count(name), 1u) << name;
        EXPECT_THAT(summary_of(out())["files"], ::testing::Contains(name));
    }
    run_into(out());
    EXPECT_EQ(files_in(out()).count("tiles/tileset.json"), 0u) << "of an earlier run";
}

TEST_F(Output, InputsAreNotWrittenTo) {
    fs::create_symlink(sequence(), beside("link"));
    fs::create_directory(beside("kept"));
    write_text(beside("kept/l.json"), R"({"lights": [{"position": [0, -2, 0], "intensity": [1, 1, 1]}]})");
    write_text(beside("kept/s.toml"), "");
    const std::string lights = beside("kept/l.json"), settings = beside("kept/s.toml");
    const auto run = [&](const fs::path& out, std::vector<std::string> more = {}) {
        std::vector<std::string> arguments{"run", sequence(), "--quiet", "--out", out};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return refusal(arguments);
    };
    EXPECT_THAT(run(sequence()), AllOf(HasSubstr("is the input"), HasSubstr(sequence().string())));
    EXPECT_THAT(run(beside("link")), HasSubstr("is the input"));
    EXPECT_THAT(run(sequence() / "out"), HasSubstr("lies inside the input"));
    EXPECT_THAT(run(beside("link") / "color"), HasSubstr("lies inside the input"));
    EXPECT_THAT(run(sequence().parent_path()), HasSubstr("holds the input"));
    EXPECT_THAT(run(beside("kept"), {"--lights", lights}), HasSubstr("holds the input"));
    EXPECT_THAT(run(beside("kept"), {"--settings", settings}), HasSubstr("holds the input"));
    EXPECT_THAT(run(out(), {"--dump-graph", sequence() / "sequence"}), HasSubstr("lies inside the input"));
    EXPECT_THAT(run(out(), {"--dump-graph", out() / "run"}), HasSubstr("a result has that name"));
    EXPECT_THAT(refusal({"lights", sequence(), "--out", sequence() / "trajectory.txt"}), HasSubstr("lies inside"));
    EXPECT_THAT(refusal({"render", sequence(), "--out", sequence() / "views"}), HasSubstr("lies inside"));
    EXPECT_THAT(refusal({"render", sequence(), "--video", sequence() / "v.avi"}), HasSubstr("lies inside"));
    EXPECT_THAT(refusal({"render", sequence(), "--poses", settings, "--out", settings}), HasSubstr("is the input"));
}

TEST_F(Output, AFailingStartTouchesNothing) {
    write_text(beside("l.json"), R"({"lights": []})");
    for (const std::vector<std::string>& wrong : {std::vector<std::string>{"run", beside("nowhere")},
                                                  {"run", sequence(), "--device", "99"},
                                                  {"run", sequence(), "--set", "map.voxel_m=0"},
                                                  {"run", sequence(), "--network", beside("l.json")}}) {
        fs::create_directories(out() / "frames");
        write_text(out() / "run.json", R"({"format": "patina-run"})");
        write_text(out() / "frames/000000.exr", "an earlier view");
        std::vector<std::string> arguments = wrong;
        arguments.insert(arguments.end(), {"--out", out(), "--quiet"});
        refusal(arguments);
    }
}

TEST_F(Output, NothingOfAnEarlierRunStaysAndTheUsersFilesDo) {
    run_into(out(), {"--dump-every", "1", "--set", "fusion.color=true"});
    EXPECT_EQ(files_in(out()).count("frames/000002.exr"), 1u);
    write_text(out() / "notes.txt", "mine");
    fs::create_directory(out() / "photos");
    write_text(out() / "photos/a.jpg", "mine");
    run_into(out());
    const auto files = files_in(out());
    EXPECT_FALSE(fs::exists(out() / "frames"));
    EXPECT_EQ(files.at("notes.txt") + files.at("photos/a.jpg"), "minemine");
    std::set<std::string> listed;
    const nlohmann::json summary = summary_of(out());
    for (const auto& name : summary["files"]) listed.insert(name.get<std::string>());
    for (const auto& [name, bytes] : files)
        EXPECT_EQ(listed.contains(name), name != "notes.txt" && name != "photos/a.jpg") << name;
    EXPECT_EQ(std::distance(fs::directory_iterator(out().parent_path()), {}), 2) << "sequence and out";
}

TEST_F(Output, FilesThatNoRunWroteAreNotReplaced) {
    fs::create_directory(out());
    write_text(out() / "scene.glb", "my own scene");
    EXPECT_THAT(refusal({"run", sequence(), "--out", out()}), AllOf(HasSubstr("holds 'scene.glb'")));
}

TEST_F(Output, OneRunAtATimeAndAKilledOneLeavesOneFolderThatTheNextRemoves) {
    run_into(out());
    const auto earlier = files_in(out());
    const fs::path partial = beside(".out.patina-partial");
    Program first({"run", "synthetic:cubes", "--detail", "coarse", "--frames", "100000", "--lighting", "none",
                   "--dump-every", "1", "--out", out(), "--quiet"});
    await(first, partial / "frames/000000.exr");
    EXPECT_THAT(expect_failure(patina({"run", sequence(), "--out", out(), "--quiet"})),
                HasSubstr("another process is writing"));
    first.send(SIGKILL);
    EXPECT_EQ(first.wait().signal, SIGKILL);
    EXPECT_EQ(files_in(out()), earlier);
    EXPECT_EQ(std::distance(fs::directory_iterator(out().parent_path()), {}), 3) << "sequence, out, and one more";
    run_into(out());
    EXPECT_EQ(std::distance(fs::directory_iterator(out().parent_path()), {}), 2);
}

TEST_F(Output, ADiskThatRefusesIsReportedAndLeavesEarlierResults) {
    run_into(out());
    const auto earlier = files_in(out());
    const test::FileSizeLimit limit(2000);
    EXPECT_THAT(expect_failure(patina({"run", sequence(), "--out", out(), "--quiet"})),
                AllOf(HasSubstr("run.json cannot be written"), HasSubstr("bytes were refused"),
                      HasSubstr("larger than"), HasSubstr("out-new' holds what could still be written")));
    EXPECT_EQ(files_in(out()), earlier);
    const auto kept = files_in(beside("out-new"));
    EXPECT_TRUE(kept.contains("trajectory.txt"));
    EXPECT_FALSE(kept.contains("run.json")) << "not half of it";
    EXPECT_THAT(refusal({"render", sequence(), "--lighting", "none", "--quiet", "--video", beside("v.avi")}),
                HasSubstr("v.avi"));
}

TEST_F(Output, AVideoThatCannotBeWrittenCostsNoPicture) {
    const test::FileSizeLimit limit(4000);  // a picture of 32 x 24 pixels takes less, the header of a video more
    EXPECT_THAT(expect_failure(patina({"render", sequence(), "--lighting", "none", "--quiet", "--video",
                                       beside("v.avi"), "--out", beside("views")})),
                HasSubstr("v.avi"));
    EXPECT_EQ(files_in(beside("views")).size(), 3u);
    EXPECT_FALSE(fs::exists(beside("v.avi")));
}

TEST_F(Output, AMotionJpegVideoNeedsNoFfmpeg) {
    const Outcome outcome = patina({"render", sequence(), "--lighting", "none", "--quiet", "--video", beside("v.avi")},
                                   {{"OPENCV_VIDEOIO_PRIORITY_FFMPEG", "0"}});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_TRUE(fs::exists(beside("v.avi")));
}

TEST_F(Output, APlaceThatNamesNothingIsRefused) {
    EXPECT_THAT(refusal({"run", sequence(), "--quiet", "--out", ""}), HasSubstr("empty"));
    EXPECT_THAT(refusal({"synth", "cubes", "--quiet", "--out", ""}), HasSubstr("empty"));
    fs::create_directory(beside("gone"));
    const std::string err = beside("err").string();
    EXPECT_EQ(shell("cd '" + beside("gone").string() + "' && rmdir ../gone && exec \"$PATINA\" run '" +
                    sequence().string() + "' --quiet --out results 2>'" + err + "'"),
              1);
    EXPECT_THAT(read_text(err), HasSubstr("'results' leads nowhere"));
}

TEST_F(Output, EveryPictureHasItsRunsIdAndEvalRefusesAMixture) {
    const fs::path recording = beside("cubes"), other = beside("other");
    const Outcome synth = patina({"synth", "cubes", "--frames", "2", "--truth-every", "1", "--extent", "96x80",
                                  "--no-lighting", "--quiet", "--out", recording});
    ASSERT_EQ(synth.exit_code, 0) << synth.err;
    const auto run = [&](const fs::path& folder, const char* voxel) {
        const Outcome outcome = patina({"run", recording, "--dump-every", "1", "--set", voxel, "--texture", "off",
                                        "--no-map", "--quiet", "--out", folder});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        return summary_of(folder)["id"].get<std::string>();
    };
    const std::string id = run(out(), "map.voxel_m=0.04"), other_id = run(other, "map.voxel_m=0.05");
    EXPECT_NE(id, other_id);
    EXPECT_EQ(run(beside("again"), "map.voxel_m=0.04"), id);
    EXPECT_TRUE(files_in(out()).at("frames/000001.exr") == files_in(beside("again")).at("frames/000001.exr"));
    for (const char* frame : {"frames/000000.exr", "frames/000001.exr"})
        EXPECT_EQ(eval::ExrPlanes::read(out() / frame).run_id(), id);

    const std::vector<std::string> eval{"eval", recording, out(), "--seen", "1", "--quiet"};
    EXPECT_EQ(patina(eval).exit_code, 0);
    EXPECT_EQ(patina(eval).exit_code, 0) << "an evaluation replaces an evaluation";
    fs::copy_file(other / "frames/000001.exr", out() / "frames/000001.exr", fs::copy_options::overwrite_existing);
    EXPECT_THAT(refusal(eval), AllOf(HasSubstr("000001.exr"), HasSubstr(id), HasSubstr(other_id)));
    EXPECT_THAT(refusal({"eval", recording, out(), "--out", out()}), HasSubstr("is the input"));
    EXPECT_THAT(refusal({"eval", recording, out(), "--out", out() / "frames"}), HasSubstr("is the input"));
    EXPECT_THAT(refusal({"eval", recording, out(), "--out", recording / "eval"}), HasSubstr("lies inside the input"));
    fs::remove(out() / "run.json");
    EXPECT_THAT(refusal(eval), HasSubstr("holds no run.json"));
    write_text(out() / "run.json", R"({"format": "patina-run", "finished": false})");
    EXPECT_THAT(refusal(eval), HasSubstr("finished is false"));
}

}  // namespace
}  // namespace patina::testing::output_test
