#include "reconstruction/store/spill_file.h"

#include <string>

#include "engine/core/error.h"
#include "engine/store/temporary_database.h"

namespace patina {

SpillFile::SpillFile() : database_(temporary_database("patina-blocks")) {
    database_.run("CREATE TABLE blocks (key INTEGER PRIMARY KEY, bytes BLOB NOT NULL)");
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
