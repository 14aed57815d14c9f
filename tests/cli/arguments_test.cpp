#include "tests/cli/run_folder.h"

namespace patina::testing::arguments_test {
namespace {

namespace fs = std::filesystem;
using sensor::testing::read_text;
using sensor::testing::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;

class Arguments : public RunFolderTest {};

constexpr int kUsage = 2;

TEST_F(Arguments, WrongUsageIsOneLine) {
    EXPECT_THAT(expect_failure(patina({}), kUsage), HasSubstr("subcommand is required"));
    EXPECT_THAT(expect_failure(patina({"run"}), kUsage), HasSubstr("sequence is required"));
    EXPECT_THAT(expect_failure(patina({"run", sequence(), "--out", out(), "--frames", "-3"}), kUsage),
                HasSubstr("--frames"));
    EXPECT_THAT(expect_failure(patina({"run", sequence(), "--out", out(), "--speed"}), kUsage), HasSubstr("--speed"));
    EXPECT_THAT(expect_failure(patina({"run", sequence(), "--out", out(), "--gains", "maybe"}), kUsage),
                HasSubstr("--gains"));
    for (const char* up : {"0,0,0", "1,2", "1,2,3,4", "up", "0,nan,1", "0,inf,1", "1, 2,3"})
        EXPECT_THAT(expect_failure(patina({"run", sequence(), "--out", out(), "--up", up}), kUsage),
                    AllOf(HasSubstr(up), HasSubstr("X,Y,Z")));
    EXPECT_THAT(expect_failure(patina({"run", sequence(), "--out", out(), "--gltf-fresnel", "none"}), kUsage),
                HasSubstr("'none' is none of ior, constant"));
    EXPECT_FALSE(fs::exists(out()));
}

TEST_F(Arguments, WrongUsageOfSynthIsOneLine) {
    const auto complaint = [&](const std::string& option, const std::string& value) {
        return expect_failure(patina({"synth", "cubes", "--out", out(), option, value}), kUsage);
    };
    for (const char* extent : {"512", "512x", "0x424", "512x-3", "9000x10", "12x12x12"})
        EXPECT_THAT(complaint("--extent", extent), AllOf(HasSubstr(extent), HasSubstr("WIDTHxHEIGHT")));
    for (const char* noise : {"0.1", "-1,0", "0,-1", "nan,0", "0,inf", "0.1,0.1m"})
        EXPECT_THAT(complaint("--pose-noise", noise), AllOf(HasSubstr(noise), HasSubstr("METRES,DEGREES")));
    EXPECT_THAT(complaint("--bounces", "-1"), HasSubstr("--bounces"));
    EXPECT_THAT(complaint("--seed", "green"), HasSubstr("--seed"));
    EXPECT_THAT(complaint("--truth-every", "1.5"), HasSubstr("--truth-every"));
    EXPECT_FALSE(fs::exists(out()));
}

TEST_F(Arguments, WhatWasMeantIsNamed) {
    const auto complaint = [](std::vector<std::string> arguments, int exit_code = kUsage) {
        return expect_failure(patina(arguments), exit_code);
    };
    EXPECT_THAT(complaint({"rum", "x"}), HasSubstr("there is no subcommand 'rum'; did you mean 'run'?"));
    EXPECT_THAT(complaint({"rum", "x", "--out", "o"}), HasSubstr("no subcommand 'rum'; did you mean 'run'?"))
        << "not that there is no option --out";
    EXPECT_THAT(complaint({"reconstruct"}), HasSubstr("there is no subcommand 'reconstruct' ("));
    EXPECT_THAT(complaint({"run", "x", "--out", "o", "--frmaes", "3"}),
                HasSubstr("run has no option '--frmaes'; did you mean '--frames'?"));
    EXPECT_THAT(complaint({"run", "x", "--uot=o"}), HasSubstr("run has no option '--uot'; did you mean '--out'?"))
        << "not that --out is required";
    EXPECT_THAT(complaint({"--verison"}), HasSubstr("there is no option '--verison'; did you mean '--version'?"));
    EXPECT_THAT(complaint({"run", "x", "--out", "o", "--gains", "of"}),
                HasSubstr("--gains: 'of' is none of auto, on, off; did you mean 'off'?"));
    EXPECT_THAT(complaint({"run", "x", "--out", "o", "--labels", "geometri"}), HasSubstr("did you mean 'geometry'?"));
    EXPECT_THAT(complaint({"run", "x", "--out", "o", "--specular", "hemicn"}), HasSubstr("did you mean 'hemicnn'?"));
    EXPECT_THAT(complaint({"render", "x", "--show", "label"}), HasSubstr("did you mean 'labels'?"));
    EXPECT_THAT(complaint({"lights", "x", "--from", "lightning"}), HasSubstr("did you mean 'lighting'?"));
    EXPECT_THAT(complaint({"synth-hemi", "--out", "o", "--map", "parabola"}), HasSubstr("did you mean 'parabolic'?"));
    EXPECT_THAT(complaint({"synth", "cubs", "--out", beside("o")}, 1), HasSubstr("did you mean 'cubes'?"));
    EXPECT_THAT(complaint({"info", "synthetic:ofice"}, 1), HasSubstr("did you mean 'office'?"));
    EXPECT_THAT(complaint({"synth", "cubes", "--noise", "kinect", "--out", beside("o")}, 1),
                HasSubstr("did you mean 'kinect1'?"));
    EXPECT_THAT(complaint({"info", sequence(), "--format", "tumm"}, 1), HasSubstr("did you mean 'tum'?"));
    EXPECT_THAT(complaint({"run", sequence(), "--out", out(), "--set", "map.voxel=0.01"}, 1),
                AllOf(HasSubstr("there is no setting 'map.voxel'; did you mean 'map.voxel_m'?"),
                      ::testing::Not(HasSubstr("known are"))));
    EXPECT_THAT(complaint({"run", sequence(), "--out", out(), "--set", "colour=1"}, 1),
                HasSubstr("there is no setting 'colour'; known are map.voxel_m, "));
}

TEST_F(Arguments, NoFramesAreRefused) {
    const auto complaint = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"--frames", "0"});
        return expect_failure(patina(arguments), kUsage);
    };
    const std::string wanted = "--frames: '0' is not a whole number from 1";
    EXPECT_THAT(complaint({"run", sequence(), "--out", out()}), HasSubstr(wanted));
    EXPECT_THAT(complaint({"render", sequence(), "--out", out()}), HasSubstr(wanted));
    EXPECT_THAT(complaint({"synth", "cubes", "--out", out()}), HasSubstr(wanted));
    EXPECT_THAT(complaint({"lights", sequence()}), HasSubstr(wanted));
    EXPECT_FALSE(fs::exists(out()));
}

TEST_F(Arguments, HelpNamesTheScenesAndTheNoisePresets) {
    const Outcome synth = patina({"synth", "--help"}), run = patina({"run", "--help"});
    EXPECT_THAT(synth.out, AllOf(HasSubstr("cubes"), HasSubstr("kinect2"), HasSubstr("--vary")));
    EXPECT_THAT(run.out, HasSubstr("cubes"));
}

TEST_F(Arguments, HelpIsNoFailure) {
    const Outcome outcome = patina({"run", "--help"});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(outcome.err, "");
    EXPECT_THAT(outcome.out, HasSubstr("--dump-every"));
}

TEST_F(Arguments, HelpOfRunHasTheBasicOptionsFirst) {
    const std::string help = patina({"run", "--help"}).out;
    const size_t basic = help.find("\nOptions:"), more = help.find("\nMore options:");
    ASSERT_NE(more, std::string::npos);
    EXPECT_LT(basic, help.find("--out "));
    EXPECT_LT(help.find("--frames "), more);
    EXPECT_GT(help.find("--dump-every "), more);
}

TEST_F(Arguments, OutputFolderIsCheckedBeforeAnythingElse) {
    write_text(beside("file"), "content");
    // The sequence is missing too: the first complaint is about what the run would write into.
    for (const fs::path& bad : {beside("file"), beside("file") / "below", fs::path("/proc/patina")}) {
        EXPECT_THAT(expect_failure(patina({"run", beside("nowhere"), "--out", bad})),
                    AllOf(HasSubstr("output folder"), HasSubstr(bad.string())));
    }
    EXPECT_EQ(read_text(beside("file")), "content");
    EXPECT_THAT(failure_of_run(sequence(), {"--dump-graph", beside("nowhere") / "graph"}),
                HasSubstr("there is no folder"));
}

TEST_F(Arguments, BadSettingsAreNamed) {
    const auto complaint = [&](const std::string& setting) {
        return expect_failure(patina({"run", sequence(), "--out", out(), "--set", setting}));
    };
    EXPECT_THAT(complaint("map.voxels=3"), AllOf(HasSubstr("no setting 'map.voxels'"), HasSubstr("map.voxel_m")));
    EXPECT_THAT(complaint("map.voxel_m=thick"), AllOf(HasSubstr("map.voxel_m"), HasSubstr("'thick'")));
    EXPECT_THAT(complaint("map.voxel_m=-1"), HasSubstr("map.voxel_m"));
    EXPECT_THAT(complaint("map.voxel_m"), HasSubstr("no '='"));
    EXPECT_THAT(complaint("map.capacity_blocks=1.5"), HasSubstr("whole number"));
    EXPECT_FALSE(fs::exists(out()));
}

TEST_F(Arguments, SettingsThatNoRunCanUse) {
    const auto complaint = [&](const char* setting) { return failure_of_run(sequence(), {"--set", setting}); };
    EXPECT_THAT(complaint("map.voxel_m=0"), HasSubstr("map.voxel_m is 0, it must be a number from 0.0001 to 1 m"));
    EXPECT_THAT(complaint("fusion.allocation_stride_px=0"), HasSubstr("fusion.allocation_stride_px is 0"));
    EXPECT_THAT(complaint("fusion.max_weight=0"), HasSubstr("fusion.max_weight is 0"));
    EXPECT_THAT(complaint("fusion.max_color_weight=65536"), HasSubstr("fusion.max_color_weight is 65536"));
    EXPECT_THAT(complaint("fusion.settled_color_every=0"), HasSubstr("fusion.settled_color_every is 0"));
    EXPECT_THAT(complaint("fusion.truncation_m=0.5"), HasSubstr("truncation band is 0.54 m wide"));
}

TEST_F(Arguments, BadSettingsFilesAreNamed) {
    const fs::path file = beside("settings.toml");
    const auto complaint = [&] {
        return expect_failure(patina({"run", sequence(), "--out", out(), "--settings", file}));
    };
    EXPECT_THAT(complaint(), AllOf(HasSubstr("settings.toml"), HasSubstr("does not exist")));
    write_text(file, "[map]\nvoxel_m = \n");
    EXPECT_THAT(complaint(), HasSubstr("settings.toml, line 2"));
    write_text(file, "[map]\nvoxels = 3\n");
    EXPECT_THAT(complaint(), AllOf(HasSubstr("settings.toml"), HasSubstr("no setting 'map.voxels'")));
    write_text(file, "voxel_m = 0.01\n");
    EXPECT_THAT(complaint(), HasSubstr("'voxel_m' is not a table"));
}

TEST_F(Arguments, SettingsAreEchoed) {
    const fs::path file = beside("settings.toml");
    write_text(file, "[map]\nvoxel_m = 0.02\ncapacity_blocks = 1000\n[fusion]\nmax_depth_m = 3\n");
    const nlohmann::json summary = run_quietly(
        sequence(), {"--settings", file, "--set", "map.capacity_blocks=2000", "--frames", "2", "--seed", "7"});
    const nlohmann::json& settings = summary["settings"];
    EXPECT_EQ(settings["map.voxel_m"], 0.02);
    EXPECT_EQ(settings["map.capacity_blocks"], 2000) << "the command line wins over the file";
    EXPECT_EQ(settings["fusion.max_depth_m"], 3);
    EXPECT_EQ(settings["fusion.max_weight"], 6) << "defaults are echoed too";
    EXPECT_EQ(settings["frames"], 2);
    EXPECT_EQ(summary["seed"], 7);
    EXPECT_EQ(summary["frames"]["used"], 2);
}

}  // namespace
}  // namespace patina::testing::arguments_test
