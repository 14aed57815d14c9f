#include "engine/core/expect_path.h"

#include "engine/core/error.h"
#include "engine/core/input_file.h"

namespace patina {

namespace fs = std::filesystem;

void expect_folder(const fs::path& folder) {
    if (!path_exists(folder)) throw Error(folder.string(), " does not exist");
    if (!is_folder(folder)) throw Error(folder.string(), " is a file, not a folder");
}

void expect_place_for(const fs::path& file) {
    const fs::path folder = file.parent_path();
    if (!folder.empty() && !is_folder(folder))
        throw Error("the file '", file.string(), "' cannot be written: there is no folder '", folder.string(), "'");
    if (is_folder(file)) throw Error("the file '", file.string(), "' cannot be written: it is a folder");
}

}  // namespace patina
