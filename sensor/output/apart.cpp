#include "sensor/output/apart.h"

#include <algorithm>
#include <optional>
#include <system_error>

#include <sys/stat.h>

#include "engine/core/error.h"

namespace patina::sensor {
namespace {

namespace fs = std::filesystem;

/// What a file is, whatever its name.
struct Identity {
    dev_t device;
    ino_t inode;
    bool operator==(const Identity&) const = default;
};

std::optional<Identity> identity_of(const fs::path& path) {
    struct stat status {};
    if (stat(path.c_str(), &status) != 0) return std::nullopt;
    return Identity{status.st_dev, status.st_ino};
}

/// Of a resolved path and all folders above it, those that exist.
std::vector<Identity> identities_up_from(fs::path path) {
    std::vector<Identity> list;
    for (;; path = path.parent_path()) {
        if (const auto identity = identity_of(path)) list.push_back(*identity);
        if (path == path.root_path() || path.empty()) return list;
    }
}

bool holds(const std::vector<Identity>& list, const Identity& identity) {
    return std::find(list.begin(), list.end(), identity) != list.end();
}

/// The input, and what links directly inside it lead to.
std::vector<fs::path> with_links(const fs::path& input) {
    std::vector<fs::path> all{input};
    std::error_code failure;
    for (fs::directory_iterator entry(input, failure), end; !failure && entry != end; entry.increment(failure)) {
        std::error_code none;
        if (entry->is_symlink(none) && fs::exists(entry->path(), none)) all.push_back(entry->path());
    }
    return all;
}

void expect_place_apart(const fs::path& output, const fs::path& place, const fs::path& input, const fs::path& of) {
    const auto read = identity_of(input);
    if (!read) return;
    const auto written = identity_of(place);
    const char* relation = nullptr;
    if (written == read) {
        relation = "is";
    } else if (holds(identities_up_from(place), *read)) {
        relation = "lies inside";
    } else if (written && holds(identities_up_from(resolved(input)), *written)) {
        relation = "holds";
    }
    if (!relation) return;
    const std::string target = input == of ? "" : text(", which '", of.string(), "' links to");
    throw Error("the output '", output.string(), "' ", relation, " the input '", input.string(), "'", target,
                "; results are written apart from what is read");
}

}  // namespace

fs::path resolved(const fs::path& path) {
    if (path.empty()) throw Error("a path is empty, but must name a file or a folder");
    std::error_code failure;
    const fs::path absolute = fs::absolute(path, failure).lexically_normal();
    if (failure || !absolute.is_absolute())
        throw Error("'", path.string(), "' leads nowhere: the folder that this program was started in cannot be found");
    const fs::path trimmed = absolute.has_filename() ? absolute : absolute.parent_path();
    if (fs::is_symlink(trimmed, failure) && !fs::exists(trimmed, failure))
        throw Error("'", path.string(), "' is a link that leads nowhere");
    fs::path result = fs::weakly_canonical(trimmed, failure);
    if (failure) throw Error("'", path.string(), "' cannot be followed: ", failure.message());
    return result;
}

bool lies_in(const fs::path& path, const fs::path& folder) {
    const auto outer = identity_of(folder);
    return outer && holds(identities_up_from(resolved(path)), *outer);
}

void expect_apart(const fs::path& output, const std::vector<fs::path>& inputs) {
    const fs::path place = resolved(output);
    for (const fs::path& input : inputs) {
        if (input.empty()) continue;
        for (const fs::path& each : with_links(input)) expect_place_apart(output, place, each, input);
    }
}

}  // namespace patina::sensor
