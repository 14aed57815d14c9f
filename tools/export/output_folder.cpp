#include "tools/export/output_folder.h"

#include <fstream>
#include <system_error>
#include <utility>

#include "engine/core/error.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

/// Beside `place`, so that the rename stays within one file system.
fs::path temporary_for(const fs::path& place) {
    return place.parent_path() / (".patina-partial-" + place.filename().string());
}

void create_folder(const fs::path& folder) {
    std::error_code failure;
    if (fs::exists(folder, failure) && !fs::is_directory(folder, failure)) {
        throw Error("output folder ", folder, ": is a file, not a folder");
    }
    fs::create_directories(folder, failure);
    if (failure) throw Error("output folder ", folder, ": cannot be created: ", failure.message());
}

void write_file(const fs::path& path, std::string_view bytes) {
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file) throw Error("cannot write ", bytes.size(), " bytes to ", path);
}

/// Permissions alone do not tell (read-only file systems, root), so a file is really written.
void check_writable(const fs::path& folder) {
    const fs::path probe = temporary_for(folder / "probe");
    std::ofstream file(probe);
    if (!file.put('\n').flush()) throw Error("output folder ", folder, ": cannot be written to");
    file.close();
    std::error_code failure;
    if (!fs::remove(probe, failure))
        throw Error("output folder ", folder, ": files in it cannot be removed: ", failure.message());
}

void remove_finished_mark(const fs::path& folder, const std::string& mark) {
    std::error_code failure;
    fs::remove(folder / mark, failure);
    if (failure) {
        throw Error("output folder ", folder, ": an earlier ", mark, " cannot be removed: ", failure.message());
    }
}

void check_name(const fs::path& name) {
    bool inside = name.is_relative() && name.has_filename();
    for (const fs::path& part : name) inside = inside && part != ".." && part != ".";
    PATINA_ASSERT(inside, "an output file's name must be a plain relative path: ", name);
}

}  // namespace

OutputFolder::OutputFolder(fs::path path, const std::string& finished_mark) : path_(std::move(path)) {
    create_folder(path_);
    check_writable(path_);
    remove_finished_mark(path_, finished_mark);
}

OutputFolder::~OutputFolder() {
    for (const std::string& name : staged_) {
        std::error_code ignored;
        fs::remove(temporary_for(path_ / name), ignored);
    }
}

void OutputFolder::write(const std::string& name, std::string_view bytes) {
    write_file(stage(name), bytes);
    publish(name);
}

fs::path OutputFolder::stage(const std::string& name) {
    check_name(name);
    const fs::path place = path_ / name;
    create_folder(place.parent_path());
    staged_.insert(name);
    return temporary_for(place);
}

void OutputFolder::publish(const std::string& name) {
    PATINA_ASSERT(staged_.contains(name), "published without being staged: ", name);
    const fs::path place = path_ / name;
    std::error_code failure;
    fs::rename(temporary_for(place), place, failure);
    if (failure) throw Error("output file ", place, ": cannot be put in place: ", failure.message());
    staged_.erase(name);
}

}  // namespace patina
