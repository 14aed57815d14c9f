#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.h"

struct sqlite3;
struct sqlite3_stmt;

namespace patina {

/// What a database is opened for.
enum class DatabaseUse {
    kState,  ///< content that is replaced: rollback journal, so that what is large is written once
    kLog,    ///< content that is appended all the time: write-ahead log. A commit survives the process; the power's end
             ///< only after a checkpoint, which is run by hand
    kRead    ///< only read, whoever wrote it: a schema runs no code, and values are limited to kLongestValue
};

/// Another process was at a database for longer than is waited for it.
class DatabaseBusy : public Error {
  public:
    using Error::Error;
};

/// An SQLite database in one file, on one thread. All that it does throws Error, naming the file and the reason, where
/// the disk refuses, another process is at it, or the file is damaged.
class Database {
  public:
    /// Of a database that is only read, in bytes: a picture of 8192 x 8192 pixels with three bytes each.
    static constexpr int kLongestValue = 192 << 20;

    /// Opens the file, or creates it where it is not only to be read; what a process that was killed left half done is
    /// undone. Whatever is done with it waits some seconds for another process that is at it, then throws DatabaseBusy.
    explicit Database(std::filesystem::path file, DatabaseUse use = DatabaseUse::kState);

    /// Runs statements without values.
    void run(const std::string& sql);

    const std::filesystem::path& file() const { return file_; }

  private:
    friend class Query;
    struct Close {
        void operator()(sqlite3* handle) const;
    };
    [[noreturn]] void fail(int code) const;

    std::filesystem::path file_;
    std::unique_ptr<sqlite3, Close> handle_;
};

/// One statement with values in place of its question marks. Blobs and texts that are given must outlive it.
class Query {
  public:
    Query(Database& database, std::string_view sql);

    /// Sets the next value.
    Query& with(int64_t number);
    Query& with(double number);  ///< NaN becomes NULL
    Query& with(std::string_view text);
    Query& with(std::span<const std::byte> blob);

    /// Steps to the next row; false after the last.
    bool next();
    /// Runs a statement that yields no rows.
    void run();
    /// Makes the statement ready for other values, where it is to be used again.
    Query& again();

    /// Columns of the row, from 0 on. A blob is valid until the next step.
    int64_t number(int column) const;
    double real(int column) const;
    bool is_null(int column) const;
    std::string text(int column) const;
    std::span<const std::byte> blob(int column) const;

  private:
    void check(int code) const;
    struct Finalize {
        void operator()(sqlite3_stmt* statement) const;
    };

    Database& database_;
    std::unique_ptr<sqlite3_stmt, Finalize> statement_;
    int given_ = 0;
};

/// Throws Error, naming the first fault, where the database's structure is damaged. Reads all of the file.
void check_integrity(Database& database);

/// Changes that are made together or not at all: without commit() all are undone.
class Transaction {
  public:
    explicit Transaction(Database& database);
    ~Transaction();
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;

    /// Brings the changes to the disk.
    void commit();

  private:
    Database& database_;
    bool open_ = true;
};

}  // namespace patina
