#include "reconstruction/store/spill_file.h"

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

#include <unistd.h>

#include "engine/core/error.h"

namespace patina {

namespace {

/// A database in a file that has no name any more.
Database open_unnamed() {
    const char* folder = std::getenv("TMPDIR");
    std::string path = std::filesystem::path(folder && *folder ? folder : "/var/tmp") / "patina-blocks-XXXXXX";
    const int file = mkstemp(path.data());
    if (file < 0) throw Error("'", path, "' cannot be created: ", std::generic_category().message(errno));
    close(file);
    struct Remove {
        ~Remove() { unlink(path.c_str()); }
        const std::string& path;
    };
    const Remove after{path};
    return Database(path);
}

}  // namespace

SpillFile::SpillFile() : database_(open_unnamed()) {
    // Only this process ever reads it, so nothing has to survive it.
    database_.run(
        "PRAGMA locking_mode = EXCLUSIVE; PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF;"
        "CREATE TABLE blocks (key INTEGER PRIMARY KEY, bytes BLOB NOT NULL)");
}

void SpillFile::put(std::span<const std::pair<uint32_t, std::span<const std::byte>>> entries) {
    Transaction change(database_);
    for (const auto& [key, bytes] : entries)
        Query(database_, "INSERT OR REPLACE INTO blocks VALUES (?, ?)").with(int64_t{key}).with(bytes).run();
    change.commit();
}

std::vector<std::byte> SpillFile::read(uint32_t key) {
    Query query(database_, "SELECT bytes FROM blocks WHERE key = ?");
    query.with(int64_t{key});
    if (!query.next()) throw Error("'", database_.file().string(), "' has no block ", key);
    const std::span<const std::byte> bytes = query.blob(0);
    return {bytes.begin(), bytes.end()};
}

}  // namespace patina
