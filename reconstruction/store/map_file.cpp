#include "reconstruction/store/map_file.h"

#include <cstring>
#include <new>
#include <utility>

#include <zstd.h>

#include "engine/core/error.h"
#include "engine/store/content_digest.h"

namespace patina {

namespace {

constexpr int64_t kApplication = 0x5054'4e41;  // "PTNA", in the file's header
constexpr int kLevel = 1;                      // of compression: it is to keep pace with the disk

bool same(std::span<const std::byte> a, std::span<const std::byte> b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size()) == 0);
}

std::span<const std::byte> bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }

int64_t pragma(Database& database, const char* name) {
    Query query(database, std::string("PRAGMA ") + name);
    return query.next() ? query.number(0) : 0;
}

constexpr const char* kTables = R"(
    CREATE TABLE texts (key TEXT PRIMARY KEY, text TEXT NOT NULL);
    CREATE TABLE arrays (name TEXT PRIMARY KEY, bytes INTEGER NOT NULL);
    CREATE TABLE pieces (array TEXT NOT NULL, piece INTEGER NOT NULL, bytes INTEGER NOT NULL, digest BLOB NOT NULL,
                         zstd BLOB NOT NULL, PRIMARY KEY (array, piece));
    CREATE TABLE files (name TEXT PRIMARY KEY, content BLOB NOT NULL);
)";

}  // namespace

void MapFile::FreeContext::operator()(ZSTD_CCtx_s* context) const { ZSTD_freeCCtx(context); }

MapFile::MapFile(Database database) : database_(std::move(database)), compressor_(ZSTD_createCCtx()) {
    if (!compressor_) throw std::bad_alloc();
    if (pragma(database_, "schema_version") == 0) {
        Transaction begin(database_);
        database_.run(kTables);
        database_.run(patina::text("PRAGMA application_id = ", kApplication, "; PRAGMA user_version = ", kSchema));
        begin.commit();
    }
    if (pragma(database_, "application_id") != kApplication)
        throw Error("'", file().string(), "' is no map of Patina's");
    if (const int64_t schema = pragma(database_, "user_version"); schema != kSchema)
        throw Error("'", file().string(), "' is a map of schema ", schema, ", this program reads ", kSchema);
}

MapFile::~MapFile() = default;

std::unique_ptr<MapFile> MapFile::with_state(const std::filesystem::path& file) {
    std::error_code failure;
    if (!std::filesystem::is_regular_file(file, failure)) throw Error("there is no map '", file.string(), "'");
    auto map = std::make_unique<MapFile>(file);
    if (!map->has_state())
        throw Error("'", file.string(),
                    "' holds no state yet: the run was stopped before its first checkpoint was whole");
    return map;
}

void MapFile::clear() { database_.run("DELETE FROM texts; DELETE FROM arrays; DELETE FROM pieces; DELETE FROM files"); }

void MapFile::set_text(std::string_view key, std::string_view text) {
    Query(database_, "INSERT OR REPLACE INTO texts VALUES (?, ?)").with(key).with(text).run();
}

std::optional<std::string> MapFile::text(std::string_view key) {
    Query query(database_, "SELECT text FROM texts WHERE key = ?");
    query.with(key);
    return query.next() ? std::optional(query.text(0)) : std::nullopt;
}

std::string MapFile::expect_text(std::string_view key) {
    std::optional<std::string> found = text(key);
    if (!found) throw Error("'", file().string(), "' has no text '", std::string(key), "'");
    return *std::move(found);
}

nlohmann::ordered_json MapFile::expect_json(std::string_view key) {
    auto json = nlohmann::ordered_json::parse(expect_text(key), nullptr, false);
    if (json.is_discarded()) throw Error("'", file().string(), "': the text '", std::string(key), "' is no JSON");
    return json;
}

void MapFile::set_bytes(std::string_view array, uint64_t bytes) {
    Query(database_, "INSERT OR REPLACE INTO arrays VALUES (?, ?)").with(array).with(static_cast<int64_t>(bytes)).run();
    const auto pieces = static_cast<int64_t>((bytes + kPieceBytes - 1) / kPieceBytes);
    Query(database_, "DELETE FROM pieces WHERE array = ? AND piece >= ?").with(array).with(pieces).run();
}

uint64_t MapFile::bytes(std::string_view array) {
    Query query(database_, "SELECT bytes FROM arrays WHERE name = ?");
    query.with(array);
    if (!query.next()) throw Error("'", file().string(), "' has no array '", std::string(array), "'");
    return static_cast<uint64_t>(query.number(0));
}

void MapFile::set_piece(std::string_view array, uint64_t piece, std::span<const std::byte> content) {
    const ContentDigest digest = digest_of(content);
    const auto index = static_cast<int64_t>(piece);
    {
        Query known(database_, "SELECT digest FROM pieces WHERE array = ? AND piece = ? AND bytes = ?");
        known.with(array).with(index).with(static_cast<int64_t>(content.size()));
        if (known.next() && same(known.blob(0), digest)) return;
    }
    std::vector<std::byte> compressed(ZSTD_compressBound(content.size()));
    const size_t size = ZSTD_compressCCtx(compressor_.get(), compressed.data(), compressed.size(), content.data(),
                                          content.size(), kLevel);
    if (ZSTD_isError(size)) throw Error("'", file().string(), "': ", ZSTD_getErrorName(size));
    Query(database_, "INSERT OR REPLACE INTO pieces VALUES (?, ?, ?, ?, ?)")
        .with(array)
        .with(index)
        .with(static_cast<int64_t>(content.size()))
        .with(digest)
        .with(std::span<const std::byte>(compressed).first(size))
        .run();
}

std::vector<std::byte> MapFile::piece(std::string_view array, uint64_t piece) {
    Query query(database_, "SELECT bytes, digest, zstd FROM pieces WHERE array = ? AND piece = ?");
    query.with(array).with(static_cast<int64_t>(piece));
    const auto fail = [&](const char* how) {
        throw Error("'", file().string(), "': piece ", piece, " of '", std::string(array), "' is ", how);
    };
    if (!query.next()) fail("missing");
    const int64_t bytes = query.number(0);
    if (bytes < 0 || static_cast<uint64_t>(bytes) > kPieceBytes) fail("damaged");
    std::vector<std::byte> content(static_cast<size_t>(bytes));
    const std::span<const std::byte> compressed = query.blob(2);
    const size_t size = ZSTD_decompress(content.data(), content.size(), compressed.data(), compressed.size());
    if (ZSTD_isError(size) || size != content.size() || !same(query.blob(1), digest_of(content))) fail("damaged");
    return content;
}

void MapFile::set_file(std::string_view name, std::string_view content) {
    Query(database_, "INSERT OR REPLACE INTO files VALUES (?, ?)").with(name).with(bytes_of(content)).run();
}

std::vector<std::string> MapFile::files() {
    std::vector<std::string> names;
    Query query(database_, "SELECT name FROM files ORDER BY name");
    while (query.next()) names.push_back(query.text(0));
    return names;
}

std::string MapFile::content_of_file(std::string_view name) {
    Query query(database_, "SELECT content FROM files WHERE name = ?");
    query.with(name);
    if (!query.next()) throw Error("'", file().string(), "' has no file '", std::string(name), "'");
    const std::span<const std::byte> content = query.blob(0);
    return {reinterpret_cast<const char*>(content.data()), content.size()};
}

void MapFile::check() {
    Query arrays(database_, "SELECT name, bytes FROM arrays ORDER BY name");
    while (arrays.next()) {
        const std::string name = arrays.text(0);
        uint64_t bytes = 0;
        const auto expected = static_cast<uint64_t>(arrays.number(1));
        for (uint64_t i = 0; i * kPieceBytes < expected; ++i) bytes += piece(name, i).size();
        if (bytes != expected)
            throw Error("'", file().string(), "': '", name, "' has ", bytes, " bytes, not ", expected);
    }
}

MapFile::Size MapFile::size() {
    Size size;
    Query arrays(database_, "SELECT COUNT(*), TOTAL(bytes) FROM arrays");
    if (arrays.next()) {
        size.arrays = static_cast<uint64_t>(arrays.number(0));
        size.bytes = static_cast<uint64_t>(arrays.number(1));
    }
    Query pieces(database_, "SELECT COUNT(*), TOTAL(LENGTH(zstd)) FROM pieces");
    if (pieces.next()) {
        size.pieces = static_cast<uint64_t>(pieces.number(0));
        size.compressed_bytes = static_cast<uint64_t>(pieces.number(1));
    }
    return size;
}

}  // namespace patina
