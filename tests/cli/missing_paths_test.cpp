#include "tests/cli/run_folder.h"

// Paths that lead nowhere, or to a file in place of a folder and the other way round: one sentence with the path.

namespace patina::testing::missing_paths_test {
namespace {

namespace fs = std::filesystem;
using sensor::testing::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;

class MissingPaths : public RunFolderTest {
  protected:
    MissingPaths() {
        write_text(file_, "content");
        fs::create_directory(folder_);
        write_text(lights_, R"({"lights": [{"position": [0, -2, 0], "intensity": [1, 1, 1]}]})");
    }

    static std::string complaint(const std::vector<std::string>& arguments) {
        return expect_failure(patina(arguments));
    }

    /// Expects that the command, which ends with the path of a file, names it where there is none, or a folder.
    void expect_file_is_missed(std::vector<std::string> command, const std::string& extension = "") const {
        const fs::path nowhere = beside("nowhere" + extension), folder = beside("folder" + extension);
        fs::create_directories(folder);
        command.push_back(nowhere);
        EXPECT_THAT(complaint(command), HasSubstr(nowhere.string() + " does not exist")) << command[0];
        command.back() = folder;
        EXPECT_THAT(complaint(command), HasSubstr(folder.string() + " is a folder, not a file")) << command[0];
    }

    const fs::path nowhere_ = beside("nowhere"), file_ = beside("a-file"), folder_ = beside("a-folder"),
                   lights_ = beside("lights.json");
};

TEST_F(MissingPaths, Sequences) {
    for (const char* command : {"info", "lights", "run", "render"}) {
        std::vector<std::string> arguments{command, nowhere_};
        if (command == std::string("run") || command == std::string("render"))
            arguments.insert(arguments.end(), {"--out", out()});
        EXPECT_THAT(complaint(arguments), HasSubstr(nowhere_.string() + " does not exist")) << command;
        arguments[1] = file_;
        EXPECT_THAT(complaint(arguments), HasSubstr(file_.string() + " is a file, but a sequence is a folder"));
        arguments[1] = folder_;
        EXPECT_THAT(complaint(arguments), HasSubstr(folder_.string() + " is no sequence: it holds no sequence.json"));
        arguments[1] = "";
        EXPECT_THAT(complaint(arguments), HasSubstr("a sequence is named by an empty path")) << command;
    }
    for (const fs::path& lighting : {nowhere_, file_, folder_}) {
        EXPECT_THAT(complaint({"run", sequence(), "--out", out(), "--lighting", lighting}),
                    HasSubstr(lighting.string() + (lighting == nowhere_ ? " does not exist" : " is ")));
    }
}

TEST_F(MissingPaths, FilesOfRunAndRender) {
    for (const char* option : {"--lights", "--settings", "--network"})
        expect_file_is_missed({"run", sequence(), "--out", out(), "--quiet", option});
    for (const char* option : {"--poses", "--relight"})
        expect_file_is_missed({"render", sequence(), "--out", out(), "--lights", lights_, option});
}

TEST_F(MissingPaths, FilesOfScenes) {
    expect_file_is_missed({"synth", "--out", out()}, ".json");
    expect_file_is_missed({"synth", "cubes", "--out", out(), "--environment"});
    for (const char* scene : {"bunnies", "cubes"}) expect_file_is_missed({"synth", scene, "--out", out(), "--mesh"});
    EXPECT_THAT(complaint({"info", "synthetic:" + beside("none.json").string()}),
                HasSubstr("none.json does not exist"));
    const auto complaint_of_scene = [&](const std::string& kd, const std::string& part, const std::string& more) {
        write_text(beside("scene.json"), R"({"objects": [{"name": "a", "material": {"kd": )" + kd +
                                             R"(, "ks": 0, "alpha": 0.1}, "parts": [)" + part + "]}]," + more +
                                             R"("path": {"orbit": {"target": [0, 0, 0], "distance": 2}}})");
        return complaint({"synth", beside("scene.json"), "--out", out()});
    };
    const std::string sphere = R"({"sphere": {"radius": 0.2}})";
    const auto named = [&](const std::string& key, const std::string& file) {
        return AllOf(HasSubstr("scene.json: " + key), HasSubstr(beside(file).string() + " does not exist"));
    };
    EXPECT_THAT(complaint_of_scene(R"("t")", sphere, R"("textures": {"t": {"file": "no.png"}},)"),
                named("textures.t.file", "no.png"));
    EXPECT_THAT(complaint_of_scene("0.5", R"({"mesh": {"file": "no.ply"}})", ""),
                named("objects[0].parts[0].mesh.file", "no.ply"));
    EXPECT_THAT(complaint_of_scene("0.5", sphere, R"("environment": {"file": "no.hdr"},)"),
                named("environment.file", "no.hdr"));
    EXPECT_FALSE(fs::exists(out()));
}

TEST_F(MissingPaths, FoldersOfEval) {
    const auto complaint_of = [](const fs::path& recording, const fs::path& run) {
        return complaint({"eval", recording, run});
    };
    EXPECT_THAT(complaint_of(nowhere_, folder_), HasSubstr(nowhere_.string() + " does not exist"));
    EXPECT_THAT(complaint_of(sequence(), nowhere_), HasSubstr(nowhere_.string() + " does not exist"));
    EXPECT_THAT(complaint_of(file_, folder_), HasSubstr(file_.string() + " is a file, not a folder"));
    EXPECT_THAT(complaint_of(sequence(), file_), HasSubstr(file_.string() + " is a file, not a folder"));
}

TEST_F(MissingPaths, PlacesThatNothingCanBeWrittenToAreToldAtOnce) {
    const std::string no_folder = "there is no folder '" + nowhere_.string() + "'";
    EXPECT_THAT(complaint({"lights", sequence(), "--out", nowhere_ / "lights.json"}), HasSubstr(no_folder));
    EXPECT_THAT(complaint({"lights", sequence(), "--out", folder_}), HasSubstr(folder_.string() + "' cannot be"));
    EXPECT_THAT(complaint({"synth-hemi", "--examples", "1", "--out", nowhere_ / "a"}), HasSubstr(no_folder));
    EXPECT_THAT(complaint({"run", sequence(), "--out", out(), "--dump-graph", nowhere_ / "graph"}),
                HasSubstr(no_folder));
    EXPECT_THAT(complaint({"render", sequence(), "--video", nowhere_ / "a.avi"}), HasSubstr(no_folder));
}

}  // namespace
}  // namespace patina::testing::missing_paths_test
