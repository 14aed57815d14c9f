#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/store/database.h"

struct ZSTD_CCtx_s;

namespace patina {

/// The state of a session in one file, an SQLite database that any of its clients can open: texts by key, arrays of
/// bytes in compressed pieces, files of results. docs/develop/map_file.md has the tables. Writing it anew writes only
/// the pieces that changed. Every piece carries a digest of its content, so that reading finds damage. All functions
/// throw Error, naming the file, where it cannot be read or written.
class MapFile {
  public:
    static constexpr int kSchema = 13;
    static constexpr uint64_t kPieceBytes = uint64_t{1} << 20;  ///< of an array, but for the last piece

    /// Opens a map, or begins one. Throws Error where the file is something else, or of another schema.
    explicit MapFile(const std::filesystem::path& file) : MapFile(Database(file)) {}
    explicit MapFile(Database database);
    ~MapFile();
    MapFile(const MapFile&) = delete;
    MapFile& operator=(const MapFile&) = delete;

    /// Opens one that holds a state. Throws Error, too, where there is no file, or no checkpoint in it was completed.
    static std::unique_ptr<MapFile> with_state(const std::filesystem::path& file);

    /// Whether a checkpoint was completed: then the text "progress" is there.
    bool has_state() { return text("progress").has_value(); }

    const std::filesystem::path& file() const { return database_.file(); }
    Database& database() { return database_; }

    /// Removes everything. Within a Transaction, as all that writes.
    void clear();

    void set_text(std::string_view key, std::string_view text);
    std::optional<std::string> text(std::string_view key);
    /// Throws Error where there is none.
    std::string expect_text(std::string_view key);
    /// A text as JSON. Throws Error, too, where it is none.
    nlohmann::ordered_json expect_json(std::string_view key);

    /// Sets the size of an array in bytes; pieces beyond it go.
    void set_bytes(std::string_view array, uint64_t bytes);
    /// Throws Error where there is no such array.
    uint64_t bytes(std::string_view array);
    void set_piece(std::string_view array, uint64_t piece, std::span<const std::byte> content);
    /// Throws Error where it is missing or damaged.
    std::vector<std::byte> piece(std::string_view array, uint64_t piece);

    /// Result files that were written so far, by their relative names.
    void set_file(std::string_view name, std::string_view content);
    std::vector<std::string> files();
    std::string content_of_file(std::string_view name);

    /// Reads all pieces. Throws Error where one is missing or damaged.
    void check();

    /// What it holds, for people.
    struct Size {
        uint64_t arrays = 0, pieces = 0;
        uint64_t bytes = 0;             ///< of all arrays
        uint64_t compressed_bytes = 0;  ///< of their pieces in the file
    };
    Size size();

  private:
    Database database_;
    struct FreeContext {
        void operator()(ZSTD_CCtx_s* context) const;
    };
    std::unique_ptr<ZSTD_CCtx_s, FreeContext> compressor_;
};

}  // namespace patina
