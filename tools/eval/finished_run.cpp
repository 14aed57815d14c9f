#include "tools/eval/finished_run.h"

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "sensor/files/json_file.h"

namespace patina::eval {

std::string id_of_finished_run(const std::filesystem::path& run) {
    const std::filesystem::path file = run / "run.json";
    if (!path_exists(file)) throw Error(run.string(), " holds no run.json, so its run did not finish");
    const auto json = sensor::JsonValue::read(file);
    const auto finished = json.find("finished"), id = json.find("id");
    if (finished && !finished->boolean()) throw Error(file.string(), ": finished is false: the run was stopped");
    return id ? id->string() : std::string();
}

}  // namespace patina::eval
