#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "sensor/recording/recorded_frame.h"
#include "tests/cli/program.h"
#include "tests/sensor/sequences.h"

namespace patina::testing {

/// All files below a folder by their relative names, with their bytes.
std::map<std::string, std::string> files_in(const std::filesystem::path& folder);

/// run.json of a finished run; a failure of the test, and null, where there is none.
nlohmann::json summary_of(const std::filesystem::path& run_folder);

/// Waits until a recording that the program writes holds a frame of a sequence, or the program ends.
void await_frames(Program& program, const std::filesystem::path& recording, sensor::SequenceRole role);

/// A test with an output folder, and with a recorded sequence of three tiny frames.
class RunFolderTest : public ::testing::Test {
  protected:
    RunFolderTest();

    /// Runs `patina run INPUT --out out() --quiet` and what is added; it must succeed and print nothing.
    nlohmann::json run_quietly(const std::string& input, std::vector<std::string> more = {});

    /// As run_quietly, but the run must fail with one line on standard error, which is returned, and leave the files of
    /// an earlier run alone.
    std::string failure_of_run(const std::string& input, std::vector<std::string> more = {},
                               const Program::Environment& changes = {});

    /// `synthetic:SCENE` of the built-in cubes for a camera of 256 x 212, a quarter of the pixels.
    std::string small_cubes() const;

    const std::filesystem::path& sequence() const { return sequence_; }
    const std::filesystem::path& out() const { return out_; }
    std::filesystem::path beside(const std::string& name) const { return folder_ / name; }

  private:
    const sensor::testing::TemporaryFolder folder_;
    const std::filesystem::path sequence_ = folder_ / "sequence";
    const std::filesystem::path out_ = folder_ / "out";
};

/// Expects one line "patina: ..." on standard error, nothing on standard output and `exit_code`; returns what follows
/// the prefix.
std::string expect_failure(const Outcome& outcome, int exit_code = 1);

}  // namespace patina::testing
