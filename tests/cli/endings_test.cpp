#include <algorithm>
#include <functional>

#include "sensor/files/picture_file.h"
#include "sensor/pose.h"
#include "sensor/truth.h"
#include "tests/cli/run_folder.h"

// A run ends with what it can: geometry where there is no light, and an exit code that says what is missing.

namespace patina::testing::endings_test {
namespace {

namespace fs = std::filesystem;
using sensor::testing::read_text;
using sensor::testing::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class Endings : public RunFolderTest {
  protected:
    /// Without a texture, which takes longest, unless `more` asks for one.
    Outcome run(const std::string& input, const std::vector<std::string>& more = {}) {
        std::vector<std::string> arguments{"run", input, "--out", out()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        if (std::ranges::count(more, "--texture") == 0)
            arguments.insert(arguments.end(), {"--texture", "off", "--no-map"});
        Outcome outcome = patina(arguments);
        EXPECT_EQ(read_text(out() / "scene.glb").substr(0, 4), "glTF") << outcome.err;
        return outcome;
    }

    /// The first line of a summary that names a shortfall, which run.json and report.html name too.
    void expect_short(const Outcome& outcome, const std::string& part) {
        EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
        const std::string line = outcome.out.substr(0, outcome.out.find('\n'));
        EXPECT_THAT(line, AllOf(StartsWith("incomplete: "), HasSubstr(part)));
        EXPECT_THAT(summary_of(out())["shortfalls"].dump(), HasSubstr(part));
        EXPECT_THAT(read_text(out() / "report.html"), HasSubstr("Incomplete"));
    }

    /// Applies `change` to sequence.json.
    void edit_sequence(const std::function<void(nlohmann::json&)>& change) {
        nlohmann::json json = nlohmann::json::parse(read_text(sequence() / "sequence.json"));
        change(json);
        write_text(sequence() / "sequence.json", json.dump());
    }

    /// Records frames of the scene cubes.
    fs::path cubes(const std::string& frames, const std::string& extent) {
        const fs::path folder = beside("cubes");
        const Outcome synth = patina({"synth", "cubes", "--frames", frames, "--extent", extent, "--no-lighting",
                                      "--truth-every", "2", "--out", folder, "--quiet"});
        EXPECT_EQ(synth.exit_code, 0) << synth.err;
        return folder;
    }
};

TEST_F(Endings, WithoutLightsTheSummarySaysWhatToGive) {
    const Outcome outcome = run(sequence());
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("what lamps would light tells of none"), HasSubstr("(--lights FILE, ")));
    const nlohmann::json summary = summary_of(out());
    EXPECT_THAT(summary.value("materials_missing", ""), HasSubstr("--lighting self"));
    EXPECT_EQ(summary["lights"]["found_by"], "surroundings");
    EXPECT_TRUE(fs::exists(out() / "materials.json"));
    EXPECT_THAT(read_text(out() / "report.html"), HasSubstr("what lamps would light tells of none"));
    const double usual = summary["lights"]["ambient"][0];
    ASSERT_EQ(run(sequence(), {"--white", "0.4"}).exit_code, 0);
    EXPECT_NEAR(summary_of(out())["lights"]["ambient"][0], 2 * usual, 1e-6 * usual);
    EXPECT_NE(patina({"run", sequence(), "--out", beside("none"), "--white", "1.5"}).exit_code, 0);
}

TEST_F(Endings, WithLightsSwitchedOffThereAreNoMaterials) {
    const Outcome outcome = run(sequence(), {"--lighting", "none"});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_THAT(outcome.out, HasSubstr("no materials"));
    EXPECT_FALSE(fs::exists(out() / "materials.json"));
    EXPECT_FALSE(fs::exists(out() / "environment.exr"));
    EXPECT_THAT(read_text(out() / "report.html"), HasSubstr("no materials"));
}

TEST_F(Endings, WithoutALampThereIsAmbientLight) {
    const Outcome outcome = run(sequence(), {"--lighting", "self"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("materials hold a diffuse albedo, and gloss of mirrors at most"));
    const nlohmann::json summary = summary_of(out());
    EXPECT_TRUE(summary["lights"]["lamps"].empty());
    EXPECT_GT(summary["lights"]["ambient"][0], 0);
    EXPECT_EQ(summary["settings"]["specular"], "fit") << "mirrors need no lamp";
    EXPECT_TRUE(fs::exists(out() / "materials.json"));
    EXPECT_TRUE(fs::exists(out() / "environment.exr"));
    EXPECT_EQ(summary["gltf"]["environment"]["file"], "environment.exr");
    EXPECT_GT(summary["gltf"]["environment"]["luminance_per_pixel_value"], 0);
    EXPECT_NEAR(sensor::read_ambient(out() / "lights.json").x, summary["lights"]["ambient"][0], 1e-6);
    EXPECT_THAT(read_text(out() / "scene.glb"), HasSubstr("\"ward\""));
}

TEST_F(Endings, SceneStandsUprightAsTheUserSaysOrTheRecording) {
    const auto expect_up = [&](const std::vector<std::string>& more, const std::string& source, glm::dvec3 up) {
        ASSERT_EQ(run(sequence(), more).exit_code, 0);
        const nlohmann::json gltf = summary_of(out())["gltf"];
        EXPECT_EQ(gltf["up"]["source"], source);
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(gltf["up"]["direction"][static_cast<size_t>(axis)], up[axis], 1e-12);
            EXPECT_NEAR(gltf["gltf_from_world"][static_cast<size_t>(4 + axis)], up[axis], 1e-12) << "the row of y";
        }
        EXPECT_FALSE(gltf.contains("candela_per_intensity")) << "there is no lamp";
    };
    expect_up({"--up", "0,0,-2"}, "option", {0, 0, -1});
    edit_sequence([](nlohmann::json& json) { json["gravity"] = {-9.81, 0, 0}; });
    expect_up({}, "gravity", {1, 0, 0});
    expect_up({"--up", "0,1,0"}, "option", {0, 1, 0});
}

TEST_F(Endings, OptionsOfTheSceneReachIt) {
    write_text(beside("ambient.json"), R"({"lights": [], "ambient": [0.5, 0.5, 0.5]})");
    const auto scene_with = [&](std::vector<std::string> more) {
        more.insert(more.end(), {"--lights", beside("ambient.json"), "--detail", "coarse"});
        EXPECT_EQ(run(sequence(), more).exit_code, 0);
        return read_text(out() / "scene.glb");
    };
    const auto totals = [&] { return summary_of(out())["totals"]; };
    EXPECT_THAT(scene_with({"--texture", "auto"}), AllOf(HasSubstr("TEXCOORD_0"), Not(HasSubstr("_KD"))));
    const nlohmann::json usual = totals();
    EXPECT_THAT(
        scene_with({"--texture", "auto", "--raw-attributes", "--gltf-fresnel", "constant", "--surface-error", "20"}),
        HasSubstr("_KD"));
    EXPECT_LT(totals()["triangles"], usual["triangles"]);
    EXPECT_THAT(scene_with({"--texture", "off", "--no-map", "--surface-error", "0"}),
                AllOf(HasSubstr("COLOR_0"), Not(HasSubstr("TEXCOORD_0"))));
    const nlohmann::json all = totals();
    const auto sum = [](const nlohmann::json& of) {
        int triangles_in_all = 0;
        for (const char* name :
             {"triangles", "degenerate triangles left out", "triangles of stray parts left out", "triangles collapsed"})
            triangles_in_all += of.at(name).get<int>();
        return triangles_in_all;
    };
    EXPECT_EQ(sum(all), sum(usual)) << "none without a word";
    EXPECT_EQ(all["triangles collapsed"], 0);
    EXPECT_LT(usual["triangles"], all["triangles"].get<int>() / 2);
    EXPECT_THAT(scene_with({"--texture", "3", "--triangles", "300"}), HasSubstr("\"texel_m\":0.003"));
    EXPECT_LT(totals()["triangles"], usual["triangles"]);
    const Outcome wrong = run(sequence(), {"--texture", "fine"});
    EXPECT_NE(wrong.exit_code, 0);
    EXPECT_THAT(wrong.err, HasSubstr("'fine' is neither auto nor off nor a size of 0.1 to 100 millimetres"));
}

TEST_F(Endings, AmbientLightFromAFileIsLight) {
    write_text(beside("ambient.json"), R"({"lights": [], "ambient": [0.5, 0.5, 0.5]})");
    const Outcome outcome = run(sequence(), {"--lights", beside("ambient.json")});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_TRUE(fs::exists(out() / "materials.json"));
    EXPECT_EQ(sensor::read_ambient(out() / "lights.json"), glm::dvec3(0.5));
    write_text(beside("dark.json"), R"({"lights": []})");
    EXPECT_THAT(run(sequence(), {"--lights", beside("dark.json")}).out, HasSubstr("holds no light"));
}

TEST_F(Endings, ALightingSequenceWithoutALampTellsWhatIsAround) {
    const Outcome outcome = run(sequence(), {"--lighting", sequence()});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_TRUE(fs::exists(out() / "materials.json"));
    const nlohmann::json around = summary_of(out());
    EXPECT_EQ(around["lights"]["found_by"], "lighting sequence");
    EXPECT_EQ(around["shortfalls"].size(), 0) << around["shortfalls"];
    EXPECT_THAT(around.value("materials_missing", ""), HasSubstr("the lighting sequence shows no lamp"));
    ASSERT_EQ(run(sequence()).exit_code, 0);
    EXPECT_EQ(summary_of(out())["lights"]["ambient"], around["lights"]["ambient"])
        << "three frames tell no other light than what is assumed without a lighting sequence";
}

TEST_F(Endings, ALightingSequenceWithoutALampCostsTheLampsAloneWhereSurfacesLightNoOther) {
    edit_sequence([](nlohmann::json& json) { json["indirect_light"] = false; });
    expect_short(run(sequence(), {"--lighting", sequence()}), "no lamp was found in the lighting sequence");
    EXPECT_TRUE(fs::exists(out() / "materials.json"));
}

TEST_F(Endings, ABrokenLightingFolderCostsTheLampsAlone) {
    fs::create_directory(sequence() / "lighting");
    write_text(sequence() / "lighting/sequence.json", "half a brace {");
    expect_short(run(sequence()), "the lights could not be looked for");
    EXPECT_TRUE(fs::exists(out() / "materials.json"));
}

TEST_F(Endings, ALightingFolderOfDamagedPicturesIsNotOneWithoutALamp) {
    sensor::testing::write_native(sequence() / "lighting", 3);
    for (const auto& picture : fs::directory_iterator(sequence() / "lighting/depth")) fs::resize_file(picture, 40);
    const Outcome outcome = run(sequence());
    expect_short(outcome, "the lights could not be looked for");
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("no frame of"), HasSubstr("lighting/depth/000000.png"),
                                   HasSubstr("; lights were looked for in what they light in"),
                                   Not(HasSubstr("no lamp was found"))));
    EXPECT_TRUE(fs::exists(out() / "materials.json"));
}

TEST_F(Endings, TooFewFrames) {
    fs::remove(sequence() / "color/000001.png");
    const Outcome outcome = run(sequence());
    expect_short(outcome, "only 2 of 3 frames were used; the first was left out because: ");
    EXPECT_THAT(outcome.out, HasSubstr("color/000001 is missing"));
    const Outcome quiet = patina({"run", sequence(), "--out", out(), "--quiet"});
    EXPECT_EQ(quiet.exit_code, 3);
    EXPECT_EQ(quiet.out, "");
    EXPECT_THAT(quiet.err, StartsWith("patina: only 2 of 3 frames"));
}

TEST_F(Endings, RenderFallsShortOfTheSame) {
    fs::remove(sequence() / "color/000001.png");
    const Outcome outcome = patina({"render", sequence(), "--out", beside("views")});
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    EXPECT_THAT(outcome.out, StartsWith("incomplete: only 2 of 3 frames"));
    EXPECT_EQ(files_in(beside("views")).size(), 2u);
}

TEST_F(Endings, AnEmptySurface) {
    // A tenth of a millimetre away: the whole picture is smaller than a voxel.
    edit_sequence([](nlohmann::json& json) { json["depth"]["metres_per_unit"] = 1e-7; });
    const Outcome outcome = run(sequence());
    expect_short(outcome, "the surface is empty");
    EXPECT_THAT(outcome.out, HasSubstr("metres_per_unit may be 0.001"));
}

TEST_F(Endings, AUnitThatIsOffAThousandTimesIsToldBeforeTheWork) {
    edit_sequence([](nlohmann::json& json) { json["depth"]["metres_per_unit"] = 1; });
    EXPECT_THAT(expect_failure(patina({"run", sequence(), "--out", out()})),
                AllOf(HasSubstr("no depth reading"), HasSubstr("within 8 m"),
                      HasSubstr("metres_per_unit may be 0.001 instead of 1")));
    EXPECT_TRUE(files_in(out()).empty());
}

TEST_F(Endings, TrackingThatIsLostForGood) {
    const fs::path recording = cubes("6", "256x212");
    fs::remove(recording / "trajectory.txt");
    for (const char* frame : {"4", "5"}) {
        const fs::path picture = recording / "depth" / (std::string("00000") + frame + ".png");
        sensor::write_png(picture, Image<uint16_t>({256, 212}, 0));
    }
    const Outcome outcome = run(recording, {"--detail", "coarse", "--texture", "off", "--no-map"});
    expect_short(outcome, "tracking was lost at frame 4 and not found again");
    EXPECT_THAT(outcome.out, HasSubstr("the last 2 frames are left out"));
}

TEST_F(Endings, AReportThatCannotBeWrittenCostsTheReportAlone) {
    // Of all files the report, which holds the pictures, is the largest by far where the surface has few triangles.
    const std::vector<std::string> coarse{"--set", "map.voxel_m=0.04", "--set", "fusion.truncation_m=0.16"};
    run(sequence(), coarse);
    const uintmax_t report = fs::file_size(out() / "report.html");
    std::map<std::string, std::string> others = files_in(out());
    others.erase("report.html");
    for (const auto& [name, content] : others) EXPECT_LT(content.size() + 4096, report) << name;
    const std::string limit = std::to_string((report - 2048) / 512);  // in the blocks of ulimit
    EXPECT_EQ(shell("ulimit -f " + limit + "; exec \"$PATINA\" run '" + sequence().string() + "' --out '" +
                    out().string() + "' --set map.voxel_m=0.04 --set fusion.truncation_m=0.16 >/dev/null 2>&1"),
              3);
    const nlohmann::json summary = summary_of(out());
    EXPECT_EQ(summary["finished"], true);
    EXPECT_THAT(summary["shortfalls"].dump(), HasSubstr("report.html could not be written: "));
    EXPECT_EQ(read_text(out() / "scene.glb").substr(0, 4), "glTF");
    EXPECT_FALSE(fs::exists(out() / "report.html"));
}

/// The number behind a key of eval.json, of the object means.
double mean_error(const fs::path& run, const char* quantity) {
    const auto json = nlohmann::json::parse(read_text(run / "eval/eval.json"));
    return json["object_means"][quantity]["mean"]["filled"]["mad"];
}

TEST_F(Endings, AWorldFarFromItsOriginIsMovedAndComesOutWhereItWas) {
    const fs::path near = cubes("3", "128x106"), far = beside("far");
    fs::copy(near, far, fs::copy_options::recursive);
    const glm::dvec3 offset_m(3e6, -2e6, 5e6);
    for (const fs::path& file : {far / "trajectory.txt", far / "truth/trajectory.txt"}) {
        std::vector<sensor::StampedPose> poses = sensor::read_trajectory(file);
        for (sensor::StampedPose& pose : poses) pose.world_from_camera[3] += glm::dvec4(offset_m, 0);
        sensor::write_trajectory(file, poses);
    }
    std::vector<Light> lights = sensor::read_lights(far / "truth/lights.json");
    for (Light& light : lights) light.position_m += offset_m;
    sensor::write_lights(far / "truth/lights.json", lights);

    for (const fs::path& recording : {near, far}) {
        const fs::path to = beside(recording.filename().string() + "-run");
        const Outcome outcome =
            patina({"run", recording, "--out", to, "--lights", recording / "truth/lights.json", "--dump-every", "2",
                    "--checkpoint-every", "3", "--texture", "off", "--detail", "coarse", "--quiet"});
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        const Outcome eval = patina({"eval", recording, to, "--seen", "1", "--quiet"});
        ASSERT_EQ(eval.exit_code, 0) << eval.err;
    }
    const nlohmann::json moved = summary_of(beside("far-run")), stayed = summary_of(beside("cubes-run"));
    EXPECT_FALSE(stayed.contains("world_offset_m"));
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(moved["world_offset_m"][axis], offset_m[axis], 5);
        EXPECT_EQ(moved["world_offset_m"][axis], std::round(moved["world_offset_m"][axis].get<double>()));
        EXPECT_NEAR(sensor::read_lights(beside("far-run") / "lights.json").at(0).position_m[axis],
                    lights.at(0).position_m[axis], 1e-5);
    }
    EXPECT_THAT(read_text(beside("far-run") / "scene.glb"), HasSubstr("world_offset_m"));
    const auto poses = sensor::read_trajectory(beside("far-run") / "trajectory.txt");
    const auto given = sensor::read_trajectory(far / "trajectory.txt");
    EXPECT_LT(glm::distance(glm::dvec3(poses.at(2).world_from_camera[3]), glm::dvec3(given.at(2).world_from_camera[3])),
              2e-6);
    for (const char* quantity : {"kd", "rgb"})
        EXPECT_NEAR(mean_error(beside("far-run"), quantity), mean_error(beside("cubes-run"), quantity), 0.005);

    // What extends its map is in its world, wherever the first camera of that recording is.
    const fs::path aside = beside("aside");
    fs::copy(far, aside, fs::copy_options::recursive);
    auto poses_aside = given;
    for (sensor::StampedPose& pose : poses_aside) pose.world_from_camera[3] += glm::dvec4(7, 0, 0, 0);
    sensor::write_trajectory(aside / "trajectory.txt", poses_aside);
    const Outcome extended = patina({"run", aside, "--out", beside("aside-run"), "--extend", beside("far-run"),
                                     "--texture", "off", "--no-map", "--quiet"});
    ASSERT_EQ(extended.exit_code, 0) << extended.err;
    EXPECT_EQ(summary_of(beside("aside-run"))["world_offset_m"], moved["world_offset_m"]);
    EXPECT_LT(glm::distance(
                  glm::dvec3(sensor::read_trajectory(beside("aside-run") / "trajectory.txt")[2].world_from_camera[3]),
                  glm::dvec3(poses_aside[2].world_from_camera[3])),
              2e-6);
}

}  // namespace
}  // namespace patina::testing::endings_test
