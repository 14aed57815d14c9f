#include "engine/store/database.h"

#include <cstring>
#include <utility>

#include <sqlite3.h>

namespace patina {

namespace {

/// How long to wait for another process: whoever looks into a map reads it for seconds.
constexpr int kPatienceMs = 20000;

/// What a code means to a person; empty where SQLite's own words do.
const char* meaning_of(int code) {
    switch (code & 0xff) {
        case SQLITE_BUSY:
        case SQLITE_LOCKED: return "another process is writing to it";
        case SQLITE_FULL: return "no space is left on the disk";
        case SQLITE_CORRUPT: return "it is damaged";
        case SQLITE_NOTADB: return "it is no SQLite database";
        case SQLITE_CANTOPEN: return "it cannot be opened";
        case SQLITE_READONLY: return "it cannot be written to";
        case SQLITE_NOMEM: return "memory has run out";
        default: return nullptr;
    }
}

}  // namespace

void Database::Close::operator()(sqlite3* handle) const { sqlite3_close(handle); }

Database::Database(std::filesystem::path file, DatabaseUse use) : file_(std::move(file)) {
    const int access = use == DatabaseUse::kRead ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
    sqlite3* handle = nullptr;
    const int code = sqlite3_open_v2(file_.c_str(), &handle, access | SQLITE_OPEN_NOMUTEX, nullptr);
    handle_.reset(handle);
    if (code != SQLITE_OK) fail(code);
    sqlite3_extended_result_codes(handle, 1);
    sqlite3_busy_timeout(handle, kPatienceMs);
    run("PRAGMA temp_store = MEMORY");
    switch (use) {
        case DatabaseUse::kState:
            // A commit that returned is on the disk. What is large is not written twice, as a write-ahead log would.
            run("PRAGMA synchronous = FULL; PRAGMA journal_mode = DELETE");
            break;
        case DatabaseUse::kLog:
            // The page size holds for the file's life, so it comes first. Large pages make short chains of large
            // values.
            // Who commits does not wait for the disk: checkpoints, which do, are the owner's to run.
            // A log that has been brought into the file gives its space back, but for 64 MiB.
            run("PRAGMA page_size = 32768; PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL;"
                "PRAGMA wal_autocheckpoint = 0; PRAGMA journal_size_limit = 67108864");
            break;
        case DatabaseUse::kRead:
            sqlite3_limit(handle, SQLITE_LIMIT_LENGTH, kLongestValue);
            sqlite3_db_config(handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
            run("PRAGMA cell_size_check = ON; PRAGMA mmap_size = 0");
            break;
    }
}

void Database::run(const std::string& sql) {
    const int code = sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr);
    if (code != SQLITE_OK) fail(code);
}

void Database::fail(int code) const {
    const char* meaning = meaning_of(code);
    const int system = (code & 0xff) == SQLITE_IOERR ? sqlite3_system_errno(handle_.get()) : 0;
    const std::string sentence = text("'", file_.string(), "': ", meaning ? meaning : sqlite3_errmsg(handle_.get()),
                                      system != 0 ? text(": ", std::strerror(system)) : "");
    if ((code & 0xff) == SQLITE_BUSY || (code & 0xff) == SQLITE_LOCKED) throw DatabaseBusy(sentence);
    throw Error(sentence);
}

void Query::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

Query::Query(Database& database, std::string_view sql) : database_(database) {
    sqlite3_stmt* statement = nullptr;
    check(sqlite3_prepare_v2(database.handle_.get(), sql.data(), static_cast<int>(sql.size()), &statement, nullptr));
    statement_.reset(statement);
}

void Query::check(int code) const {
    if (code != SQLITE_OK) database_.fail(code);
}

Query& Query::with(int64_t number) {
    check(sqlite3_bind_int64(statement_.get(), ++given_, number));
    return *this;
}

Query& Query::with(double number) {
    check(sqlite3_bind_double(statement_.get(), ++given_, number));
    return *this;
}

Query& Query::with(std::string_view text) {
    check(sqlite3_bind_text64(statement_.get(), ++given_, text.data(), text.size(), SQLITE_STATIC, SQLITE_UTF8));
    return *this;
}

Query& Query::with(std::span<const std::byte> blob) {
    check(sqlite3_bind_blob64(statement_.get(), ++given_, blob.data(), blob.size(), SQLITE_STATIC));
    return *this;
}

bool Query::next() {
    const int code = sqlite3_step(statement_.get());
    if (code != SQLITE_ROW && code != SQLITE_DONE) database_.fail(code);
    return code == SQLITE_ROW;
}

void Query::run() {
    while (next()) {
    }
}

Query& Query::again() {
    sqlite3_reset(statement_.get());  // its code is that of the last step, which was reported
    given_ = 0;
    return *this;
}

int64_t Query::number(int column) const { return sqlite3_column_int64(statement_.get(), column); }

double Query::real(int column) const { return sqlite3_column_double(statement_.get(), column); }

bool Query::is_null(int column) const { return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL; }

std::string Query::text(int column) const {
    const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
    return text ? std::string(text, static_cast<size_t>(sqlite3_column_bytes(statement_.get(), column))) : "";
}

std::span<const std::byte> Query::blob(int column) const {
    const auto* bytes = static_cast<const std::byte*>(sqlite3_column_blob(statement_.get(), column));
    return {bytes, static_cast<size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

void check_integrity(Database& database) {
    Query check(database, "PRAGMA integrity_check(1)");
    if (check.next() && check.text(0) == "ok") return;
    throw Error("'", database.file().string(), "': it is damaged: ", check.text(0));
}

Transaction::Transaction(Database& database) : database_(database) { database_.run("BEGIN IMMEDIATE"); }

Transaction::~Transaction() {
    if (!open_) return;
    try {
        database_.run("ROLLBACK");
    } catch (const Error&) {
        // SQLite undid it already, or does when the file is opened next.
    }
}

void Transaction::commit() {
    database_.run("COMMIT");
    open_ = false;
}

}  // namespace patina
