#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace patina {

/// What a folder of results is of.
enum class ResultKind {
    kRun,        ///< `patina run`: run.json, scene.glb, frames/NNNNNN.exr and so on
    kEvaluation  ///< `patina eval`: eval.json, report.html, novel/NNNNNN.exr and so on
};

/// The file that is there when the results are whole: "run.json", "eval.json".
std::string mark_of(ResultKind kind);

/// Whether results of this kind may have a file of this relative name, as "frames/000012.exr".
bool is_result_name(ResultKind kind, const std::filesystem::path& name);

/// What is known of a folder that results are to be written to.
struct EarlierResults {
    bool finished = false;        ///< whole results of this kind are there
    std::set<std::string> files;  ///< that Patina wrote, by their relative names; those of evaluations of a run too
    std::set<std::string> names;  ///< of all entries that stand where results go, whoever wrote them
};

/// Looks at a folder; one that is missing is empty. Patina wrote what the mark's list "files" names, or, where the mark
/// has no list, every file that has the name of a result; without a mark of Patina's, nothing. Whatever a mark says, no
/// file counts that has not the name of a result.
EarlierResults results_in(const std::filesystem::path& folder, ResultKind kind);

}  // namespace patina
