#include "engine/store/temporary_database.h"

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include <unistd.h>

#include "engine/core/error.h"

namespace patina {

Database temporary_database(const std::string& prefix) {
    const char* folder = std::getenv("TMPDIR");
    std::string path = std::filesystem::path(folder && *folder ? folder : "/var/tmp") / (prefix + "-XXXXXX");
    const int file = mkstemp(path.data());
    if (file < 0) throw Error("'", path, "' cannot be created: ", std::generic_category().message(errno));
    close(file);
    struct Remove {
        ~Remove() { unlink(path.c_str()); }
        const std::string& path;
    };
    const Remove after{path};
    Database database(path);
    // Only this process ever reads it, so nothing has to survive it.
    database.run("PRAGMA locking_mode = EXCLUSIVE; PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF");
    return database;
}

}  // namespace patina
