#include "tools/report/result_names.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>

#include "engine/core/error.h"
#include "sensor/files/json_file.h"
#include "sensor/output/place.h"

namespace patina {
namespace {

namespace fs = std::filesystem;
using sensor::is_real_file;
using sensor::is_real_folder;
using sensor::is_taken;

constexpr std::array<std::string_view, 10> kRunFiles{
    "run.json",  "scene.glb",      "environment.exr", "materials.json",      "lights.json",
    "gains.txt", "trajectory.txt", "report.html",     "held_out/scores.txt", "tiles/tileset.json"};
constexpr std::array<std::string_view, 2> kEvaluationFiles{"eval.json", "report.html"};

/// A folder of a run that holds numbered files: of frames, of tiles.
struct FrameFolder {
    std::string_view name, extension;
};
constexpr std::array kViewFolders{FrameFolder{"finished", ".exr"}, FrameFolder{"novel", ".exr"},
                                  FrameFolder{"relit", ".exr"}};  // of evaluations
constexpr std::array kFrameFolders{FrameFolder{"frames", ".exr"},   FrameFolder{"previews", ".png"},
                                   FrameFolder{"held_out", ".png"}, FrameFolder{"tiles/0", ".glb"},
                                   FrameFolder{"tiles/1", ".glb"},  FrameFolder{"tiles/2", ".glb"}};

/// NNNNNN.EXTENSION, with six digits or more.
bool is_frame_name(const fs::path& name, std::string_view extension) {
    const std::string stem = name.stem().string();
    return name.extension() == extension && stem.size() >= 6 &&
           std::all_of(stem.begin(), stem.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// Where results of a kind have names.
struct Names {
    std::span<const std::string_view> files;
    std::span<const FrameFolder> folders;
};

Names names_of(ResultKind kind) {
    if (kind == ResultKind::kRun) return {kRunFiles, kFrameFolders};
    return {kEvaluationFiles, kViewFolders};
}

std::set<std::string> names_in(const fs::path& folder) {
    std::set<std::string> names;
    std::error_code failure;
    for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end; entry.increment(failure))
        names.insert(entry->path().filename().string());
    return names;
}

void add_fixed_names(const fs::path& folder, std::span<const std::string_view> fixed, std::set<std::string>& names) {
    for (const std::string_view name : fixed) {
        if (is_taken(folder / name)) names.emplace(name);
    }
}

/// All entries that stand where results go.
std::set<std::string> names_of_results(const fs::path& folder, ResultKind kind) {
    std::set<std::string> names;
    const Names known = names_of(kind);
    add_fixed_names(folder, known.files, names);
    for (const auto& [name, extension] : known.folders) {
        const fs::path first = folder / *fs::path(name).begin();
        for (const fs::path& place : {first, folder / name}) {
            if (is_taken(place) && !is_real_folder(place)) names.insert(place.lexically_relative(folder).string());
        }
        for (const std::string& file : names_in(folder / name)) {
            if (is_frame_name(file, extension)) names.insert((fs::path(name) / file).string());
        }
    }
    return names;
}

struct Mark {
    bool ours = false, finished = false;
    std::optional<std::set<std::string>> files;
};

Mark read_mark(const fs::path& folder, ResultKind kind) {
    const fs::path file = folder / mark_of(kind);
    if (!is_real_file(file)) return {};
    try {
        const auto json = sensor::JsonValue::read(file);
        const auto format = json.find("format");
        if (!format || format->string() != (kind == ResultKind::kRun ? "patina-run" : "patina-eval")) return {};
        Mark mark{true, true, {}};
        if (const auto finished = json.find("finished")) mark.finished = finished->boolean();
        if (const auto files = json.find("files")) {
            mark.files.emplace();
            for (const auto& name : files->elements()) mark.files->insert(name.string());
        }
        return mark;
    } catch (const Error&) {
        return {};  // no file of ours
    }
}

/// Evaluations of a run are written to folders in it.
void add_evaluations(const fs::path& run, std::set<std::string>& files) {
    for (const std::string& name : names_in(run)) {
        if (!is_real_folder(run / name)) continue;
        for (const std::string& file : results_in(run / name, ResultKind::kEvaluation).files)
            files.insert((fs::path(name) / file).string());
    }
}

}  // namespace

std::string mark_of(ResultKind kind) { return kind == ResultKind::kRun ? "run.json" : "eval.json"; }

bool is_result_name(ResultKind kind, const fs::path& name) {
    const Names known = names_of(kind);
    if (std::find(known.files.begin(), known.files.end(), name.string()) != known.files.end()) return true;
    return std::any_of(known.folders.begin(), known.folders.end(), [&](const FrameFolder& folder) {
        return name == fs::path(folder.name) / name.filename() && is_frame_name(name.filename(), folder.extension);
    });
}

EarlierResults results_in(const fs::path& folder, ResultKind kind) {
    EarlierResults found;
    found.names = names_of_results(folder, kind);
    const Mark mark = read_mark(folder, kind);
    if (!mark.ours) return found;
    found.finished = mark.finished;
    for (const std::string& name : found.names) {
        const bool listed = !mark.files || mark.files->contains(name) || name == mark_of(kind);
        if (listed && is_result_name(kind, name) && is_real_file(folder / name)) found.files.insert(name);
    }
    if (kind == ResultKind::kRun) add_evaluations(folder, found.files);
    return found;
}

}  // namespace patina
