#include <functional>

#include "sensor/files/picture_file.h"
#include "tests/cli/run_folder.h"

// What the outside does wrong, as a user meets it: one line that names the cause, and nothing lost.

namespace patina::testing::bad_input_test {
namespace {

namespace fs = std::filesystem;
using sensor::testing::read_text;
using sensor::testing::replace_text;
using sensor::testing::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;

class BadInput : public RunFolderTest {
  protected:
    /// Runs the sequence, in which frame 1 alone is damaged; returns the reason why it is skipped.
    std::string reason_of_skipped_frame() {
        const Outcome outcome = patina({"run", sequence(), "--out", out(), "--texture", "off", "--no-map", "--quiet"});
        EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
        EXPECT_THAT(outcome.err, ::testing::StartsWith("patina: only 2 of 3 frames were used"));
        const nlohmann::json summary = summary_of(out());
        const nlohmann::json frames = summary.value("frames", nlohmann::json::object());
        EXPECT_EQ(frames.value("read", 0), 3);
        EXPECT_EQ(frames.value("used", 0), 2);
        const nlohmann::json skipped = frames.value("skipped", nlohmann::json::array());
        if (skipped.size() != 1 || skipped[0].value("index", 0) != 1) {
            ADD_FAILURE() << "skipped: " << skipped;
            return "";
        }
        EXPECT_TRUE(fs::exists(out() / "scene.glb"));
        return skipped[0].value("reason", "");
    }

    /// Applies `change` to sequence.json.
    void edit_sequence(const std::function<void(nlohmann::json&)>& change) {
        nlohmann::json json = nlohmann::json::parse(read_text(sequence() / "sequence.json"));
        change(json);
        write_text(sequence() / "sequence.json", json.dump());
    }
};

TEST_F(BadInput, MissingSequence) {
    EXPECT_THAT(failure_of_run(beside("nowhere")), AllOf(HasSubstr("nowhere"), HasSubstr("does not exist")));
}

TEST_F(BadInput, FolderThatHoldsNoSequence) {
    fs::create_directory(beside("empty"));
    EXPECT_THAT(failure_of_run(beside("empty")), HasSubstr(beside("empty").string()));
}

TEST_F(BadInput, TruncatedPictureIsSkipped) {
    sensor::testing::shorten(sequence() / "depth/000001.png", 20);
    EXPECT_THAT(reason_of_skipped_frame(), AllOf(HasSubstr("depth/000001.png"), HasSubstr("truncated")));
}

TEST_F(BadInput, MissingPictureIsSkipped) {
    fs::remove(sequence() / "color/000001.png");
    EXPECT_THAT(reason_of_skipped_frame(), HasSubstr("color/000001 is missing"));
}

TEST_F(BadInput, PictureOfAnotherSizeIsSkipped) {
    sensor::write_png(sequence() / "depth/000001.png", Image<uint16_t>({8, 6}));
    EXPECT_THAT(reason_of_skipped_frame(),
                AllOf(HasSubstr("depth/000001.png"), HasSubstr("8 x 6"), HasSubstr("16 x 12")));
}

TEST_F(BadInput, PoseThatIsNoNumberIsSkipped) {
    write_text(sequence() / "trajectory.txt", "0 0 0 0 0 0 0 1\n0.03333 nan 0 0 0 0 0 1\n0.06667 0 0 0 0 0 0 1\n");
    EXPECT_THAT(reason_of_skipped_frame(), HasSubstr("trajectory.txt:2"));
}

TEST_F(BadInput, FrameWithoutPoseIsSkipped) {
    write_text(sequence() / "trajectory.txt", "0 0 0 0 0 0 0 1\n0.06667 0 0 0 0 0 0 1\n");
    EXPECT_THAT(reason_of_skipped_frame(), HasSubstr("no pose"));
}

TEST_F(BadInput, SkippedFramesAreToldAsTheyHappen) {
    fs::remove(sequence() / "color/000001.png");
    const Outcome outcome = patina({"run", sequence(), "--out", out(), "--texture", "off", "--no-map"});
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_THAT(outcome.err, HasSubstr("frame 1 is skipped: "));
    EXPECT_THAT(outcome.out, HasSubstr("2 of 3 frames"));
}

TEST_F(BadInput, NoUsableFrame) {
    for (const auto& picture : fs::directory_iterator(sequence() / "depth")) fs::resize_file(picture, 40);
    EXPECT_THAT(failure_of_run(sequence()), AllOf(HasSubstr("no frame"), HasSubstr("depth/000000.png")));
}

TEST_F(BadInput, MissingIntrinsics) {
    edit_sequence([](nlohmann::json& json) { json["depth"].erase("fx"); });
    EXPECT_THAT(failure_of_run(sequence()), AllOf(HasSubstr("sequence.json"), HasSubstr("depth.fx")));
}

TEST_F(BadInput, ZeroFrames) {
    edit_sequence([](nlohmann::json& json) { json["frames"] = 0; });
    EXPECT_THAT(failure_of_run(sequence()), AllOf(HasSubstr("sequence.json"), HasSubstr("frames")));
}

TEST_F(BadInput, NoPoses) {
    fs::remove(sequence() / "trajectory.txt");
    EXPECT_THAT(failure_of_run(sequence(), {"--poses", "given"}),
                HasSubstr("' has no poses, but they were to be used as given; track the camera without them "
                          "(--poses track)"));
    EXPECT_THAT(failure_of_run(sequence(), {"--poses", "prior"}),
                HasSubstr("' has no poses, but tracking was to start from them; track the camera without them "
                          "(--poses track)"));
}

TEST_F(BadInput, ALossFromTheFirstFrameOn) {
    fs::remove(sequence() / "trajectory.txt");
    // Three tiny pictures hold fewer readings than tracking asks for.
    EXPECT_THAT(failure_of_run(sequence(), {"--set", "tracking.levels=1", "--set", "tracking.finest=0"}),
                AllOf(HasSubstr("no frame"), HasSubstr("tracking was lost: the first frame has ")));
}

TEST_F(BadInput, UnknownScene) {
    EXPECT_THAT(failure_of_run("synthetic:teapots"), AllOf(HasSubstr("'teapots'"), HasSubstr("cubes")));
}

TEST_F(BadInput, UnknownSceneOfSynth) {
    EXPECT_THAT(expect_failure(patina({"synth", "teapots", "--out", beside("teapots")})), HasSubstr("'teapots'"));
    EXPECT_FALSE(fs::exists(beside("teapots")));
}

TEST_F(BadInput, SynthOfWhatIsNotThere) {
    const auto complaint = [&](const std::string& option, const std::string& value) {
        return expect_failure(patina({"synth", "cubes", "--extent", "16x12", "--out", out(), option, value}));
    };
    EXPECT_THAT(complaint("--noise", "xtion"), AllOf(HasSubstr("'xtion'"), HasSubstr("kinect2")));
    EXPECT_THAT(complaint("--environment", "nowhere.hdr"), HasSubstr("nowhere.hdr"));
    EXPECT_FALSE(fs::exists(out()));
    EXPECT_THAT(expect_failure(patina({"synth", "cubes", "--out", sequence()})), HasSubstr("exists and is not empty"));
}

TEST_F(BadInput, ReflectanceWithoutLights) {
    EXPECT_THAT(expect_failure(patina(
                    {"run", sequence(), "--materials", "truth", "--lighting", "none", "--out", out(), "--quiet"})),
                AllOf(HasSubstr("reflectance needs lights: give lights "), HasSubstr("(--lights FILE, ")));
}

TEST_F(BadInput, ReflectanceWithLightsThatShineNowhere) {
    write_text(beside("dark.json"), R"({"lights": []})");
    EXPECT_THAT(expect_failure(patina({"run", sequence(), "--lights", beside("dark.json"), "--materials", "truth",
                                       "--out", out(), "--quiet"})),
                AllOf(HasSubstr("reflectance needs lights"), HasSubstr("dark.json' holds no light")));
}

TEST_F(BadInput, LightsOfASequenceWithoutAUsableFrame) {
    for (const auto& picture : fs::directory_iterator(sequence() / "depth")) fs::resize_file(picture, 40);
    write_text(beside("lights.json"), "earlier lights");
    for (const char* from : {"self", "lighting"}) {
        EXPECT_THAT(
            expect_failure(patina({"lights", sequence(), "--from", from, "--out", beside("lights.json"), "--quiet"})),
            AllOf(HasSubstr("no frame of"), HasSubstr("could be used"), HasSubstr("depth/000000.png")));
        EXPECT_EQ(read_text(beside("lights.json")), "earlier lights");
    }
}

TEST_F(BadInput, LightsFileThatIsMissingOrWrong) {
    const auto run_with = [&](const fs::path& lights) {
        return expect_failure(patina({"run", sequence(), "--lights", lights, "--out", out(), "--quiet"}));
    };
    EXPECT_THAT(run_with(beside("none.json")), HasSubstr("none.json"));
    write_text(beside("dark.json"), R"({"lights": [{"position": [0, 0, 0], "intensity": [1, -1, 1]}]})");
    EXPECT_THAT(run_with(beside("dark.json")), AllOf(HasSubstr("lights[0].intensity"), HasSubstr("-1")));
}

TEST_F(BadInput, TruthThatIsNotThere) {
    write_text(beside("l.json"), R"({"lights": [{"position": [0, -2, 0], "intensity": [1, 1, 1]}]})");
    EXPECT_THAT(expect_failure(patina({"run", sequence(), "--lights", beside("l.json"), "--materials", "truth", "--out",
                                       out(), "--quiet"})),
                HasSubstr("materials.json"));
}

TEST_F(BadInput, LightingSequenceThatIsMissing) {
    EXPECT_THAT(expect_failure(patina({"lights", beside("nothing"), "--quiet"})), HasSubstr("nothing does not exist"));
    EXPECT_THAT(failure_of_run(sequence(), {"--lighting", beside("nothing")}), HasSubstr("nothing does not exist"));
}

TEST_F(BadInput, ABrokenNetworkIsToldBeforeLightsAreLookedFor) {
    const fs::path network = beside("network.safetensors");
    const std::vector<std::string> arguments{"--network", network.string(), "--lighting", beside("nowhere").string()};
    EXPECT_THAT(failure_of_run(sequence(), arguments), HasSubstr(network.string()));
    write_text(network, "half a header");
    EXPECT_THAT(failure_of_run(sequence(), arguments), HasSubstr(network.string()));
}

TEST_F(BadInput, InfoOfNothing) {
    EXPECT_THAT(expect_failure(patina({"info", beside("nowhere")})), HasSubstr("nowhere"));
}

TEST_F(BadInput, FullVoxelPoolEndsWell) {
    const Outcome outcome = patina({"run", small_cubes(), "--frames", "3", "--lighting", "none", "--out", out(),
                                    "--texture", "off", "--no-map", "--set", "map.capacity_blocks=200"});
    EXPECT_EQ(outcome.exit_code, 3);
    const nlohmann::json summary = summary_of(out());
    EXPECT_EQ(summary["voxel_pool"]["blocks_used"], 200);
    const uint64_t refused = summary["voxel_pool"]["blocks_refused"];
    EXPECT_GT(refused, 0u);
    EXPECT_THAT(outcome.err, HasSubstr("the pool of voxel blocks is full"));
    EXPECT_THAT(outcome.out,
                AllOf(::testing::StartsWith("incomplete: the pool of voxel blocks is full: " + std::to_string(refused) +
                                            " requests were refused, it holds 200"),
                      HasSubstr("raise map.capacity_blocks")));
    EXPECT_EQ(read_text(out() / "scene.glb").substr(0, 4), "glTF");
    EXPECT_GT(summary["totals"]["triangles"], 0);
}

TEST_F(BadInput, FullPoolOfObservationsEndsWellAndIsTold) {
    write_text(beside("l.json"), R"({"lights": [{"position": [0, -2, 0], "intensity": [1, 1, 1]}]})");
    const Outcome outcome =
        patina({"run", small_cubes(), "--frames", "2", "--lights", beside("l.json"), "--out", out(), "--detail",
                "coarse", "--texture", "off", "--no-map", "--set", "reflectance.capacity_records=1000"});
    EXPECT_EQ(outcome.exit_code, 3);
    const nlohmann::json summary = summary_of(out());
    EXPECT_GT(summary["observation_pool"]["records_used"], 900);
    EXPECT_LE(summary["observation_pool"]["records_used"], 1000);
    const uint64_t refused = summary["observation_pool"]["records_refused"];
    EXPECT_GT(refused, 0u);
    EXPECT_THAT(outcome.err, HasSubstr("the pool of observed voxels is full"));
    EXPECT_THAT(outcome.out, HasSubstr("the pool of observed voxels is full: " + std::to_string(refused) +
                                       " requests were refused"));
    EXPECT_THAT(summary["shortfalls"].dump(), HasSubstr("reflectance.capacity_records"));
}

TEST_F(BadInput, SmallVoxelsThatCutTheViewAreTold) {
    const Outcome outcome =
        patina({"run", small_cubes(), "--frames", "1", "--lighting", "none", "--out", out(), "--texture", "off",
                "--no-map", "--set", "map.voxel_m=0.0025", "--set", "fusion.truncation_m=0.01"});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_THAT(outcome.err, HasSubstr("with voxels of 0.0025 m the view reaches 3."));
    EXPECT_THAT(summary_of(out())["warnings"].dump(), HasSubstr("not 6.00 m: what lies farther is left out"));
}

TEST_F(BadInput, FinerObservationsGetTheRecordsThatTheyTake) {
    write_text(beside("l.json"), R"({"lights": [{"position": [0, -2, 0], "intensity": [1, 1, 1]}]})");
    const Outcome outcome =
        patina({"run", small_cubes(), "--frames", "1", "--lights", beside("l.json"), "--observation-mm", "10",
                "--texture", "off", "--no-map", "--out", out(), "--quiet"});
    EXPECT_EQ(outcome.exit_code, 0);
    const nlohmann::json summary = summary_of(out());
    EXPECT_EQ(summary["settings"]["reflectance.voxel_m"], 0.01);
    EXPECT_GT(summary["observation_pool"]["records_used"], 10000);
    EXPECT_EQ(summary["observation_pool"]["records_refused"], 0);
}

const Program::Environment kNoDriver{{"VK_DRIVER_FILES", "/nonexistent"}, {"VK_ICD_FILENAMES", "/nonexistent"}};

TEST_F(BadInput, NoDevice) {
    EXPECT_THAT(failure_of_run(sequence(), {}, kNoDriver), HasSubstr("no Vulkan driver was found: install"));
    const Outcome doctor = patina({"doctor"}, kNoDriver);
    EXPECT_NE(doctor.exit_code, 0);
    EXPECT_THAT(doctor.err, HasSubstr("no Vulkan driver was found: install"));
    EXPECT_THAT(doctor.out, HasSubstr("Kinect v2: ")) << "what is known of cameras is said all the same";
}

TEST_F(BadInput, UnknownDevice) {
    EXPECT_THAT(failure_of_run(sequence(), {"--device", "abacus"}), AllOf(HasSubstr("'abacus'"), HasSubstr("0 '")));
    EXPECT_THAT(failure_of_run(sequence(), {"--device", "7"}), AllOf(HasSubstr("'7'"), HasSubstr("0 '")));
}

}  // namespace
}  // namespace patina::testing::bad_input_test
