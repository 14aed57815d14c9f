#pragma once

#include <filesystem>
#include <string>

namespace patina::eval {

/// The id that run.json of a run's folder has (tools/report/run_id.h); empty where it has none, as of other programs.
/// Throws Error when the run did not finish: there is no run.json, or it says so; also when the file is damaged.
std::string id_of_finished_run(const std::filesystem::path& run);

}  // namespace patina::eval
