#include "tests/cli/run_folder.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "engine/core/error.h"
#include "sensor/recording/container.h"
#include "tests/scenes/small_cubes.h"

namespace patina::testing {

namespace fs = std::filesystem;
using sensor::testing::read_text;
using sensor::testing::write_text;

std::map<std::string, std::string> files_in(const fs::path& folder) {
    std::map<std::string, std::string> files;
    if (!fs::exists(folder)) return files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file()) files[fs::relative(entry.path(), folder).string()] = read_text(entry.path());
    }
    return files;
}

nlohmann::json summary_of(const fs::path& run_folder) {
    const auto summary = nlohmann::json::parse(read_text(run_folder / "run.json"), nullptr, false);
    EXPECT_FALSE(summary.is_discarded()) << "no run.json in " << run_folder;
    return summary.is_discarded() ? nlohmann::json() : summary;
}

namespace {

uint32_t frames_so_far(const fs::path& recording, sensor::SequenceRole role) {
    try {
        return *sensor::RecordingFile(recording).sequence(role).info.frames;
    } catch (const Error&) {  // it has not begun
        return 0;
    }
}

}  // namespace

void await_frames(Program& program, const fs::path& recording, sensor::SequenceRole role) {
    while (program.running() && frames_so_far(recording, role) == 0)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

std::string expect_failure(const Outcome& outcome, int exit_code) {
    EXPECT_EQ(outcome.signal, 0);
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_THAT(outcome.err, ::testing::StartsWith("patina: "));
    EXPECT_THAT(outcome.err, ::testing::EndsWith("\n"));
    return outcome.err.size() > 9 ? outcome.err.substr(8, outcome.err.size() - 9) : "";
}

std::string RunFolderTest::small_cubes() const { return testing::small_cubes(beside("small-cubes.json")); }

RunFolderTest::RunFolderTest() { sensor::testing::write_native(sequence_, 3); }

namespace {

std::vector<std::string> run_arguments(const std::string& input, const fs::path& out,
                                       const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"run", input, "--out", out.string(), "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

}  // namespace

nlohmann::json RunFolderTest::run_quietly(const std::string& input, std::vector<std::string> more) {
    const Outcome outcome = patina(run_arguments(input, out_, more));
    EXPECT_EQ(outcome.exit_code, 0) << "signal " << outcome.signal;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err, "");
    return summary_of(out_);
}

std::string RunFolderTest::failure_of_run(const std::string& input, std::vector<std::string> more,
                                          const Program::Environment& changes) {
    const std::map<std::string, std::string> earlier{{"scene.glb", "an earlier scene"},
                                                     {"frames/000000.exr", "an earlier view"},
                                                     {"run.json", R"({"format": "patina-run"})"}};
    fs::create_directories(out_ / "frames");
    for (const auto& [name, content] : earlier) write_text(out_ / name, content);
    const std::string message = expect_failure(patina(run_arguments(input, out_, more), changes));
    EXPECT_EQ(files_in(out_), earlier);
    return message;
}

}  // namespace patina::testing
