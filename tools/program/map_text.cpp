#include "tools/program/map_text.h"

#include <array>
#include <fstream>

#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "reconstruction/store/map_file.h"
#include "sensor/recording/container.h"
#include "tools/program/mebibytes.h"

namespace patina::tools {

namespace {

namespace fs = std::filesystem;

/// An empty file, too, which is what a run leaves that was stopped while it began its map.
bool is_database(const fs::path& file) {
    std::error_code failure;
    if (file.extension() == ".sqlite" && fs::file_size(file, failure) == 0) return true;
    constexpr std::array kMark = std::to_array("SQLite format 3");  // with its zero
    std::array<char, kMark.size()> start{};
    std::ifstream(file, std::ios::binary).read(start.data(), start.size());
    return start == kMark;
}

}  // namespace

fs::path map_at(const fs::path& path) {
    std::error_code failure;
    if (sensor::is_recording(path)) return {};
    if (fs::is_regular_file(path, failure)) return is_database(path) ? path : fs::path();
    const fs::path inside = path / "map.sqlite";
    const bool alone = fs::is_regular_file(inside, failure) && !fs::exists(path / "sequence.json", failure);
    return alone ? inside : fs::path();
}

std::string describe_map(const fs::path& file) {
    const auto map = MapFile::with_state(file);
    map->check();
    const MapFile::Size size = map->size();
    std::string lines;
    const auto add = [&](const char* label, const std::string& value) {
        lines += fmt::format("{:<10}{}\n", label, printable(value));
    };
    try {
        const auto progress = map->expect_json("progress"), session = map->expect_json("session"),
                   lights = map->expect_json("lights");
        const auto word = [](const auto& json, const char* key) { return json.at(key).template get<std::string>(); };
        const auto count = [&](const char* key) { return progress.at(key).get<uint32_t>(); };
        const std::string of = progress.contains("frames") ? fmt::format(" of {}", count("frames")) : "";
        add("map", fmt::format("{}, of patina {}", file.string(), word(session, "patina")));
        add("sequence", fmt::format("{} ({})", word(session, "sequence"), word(session, "format")));
        add("frames", fmt::format("{}{} read, {} used; {}", count("read"), of, count("used"),
                                  progress.at("ended").get<bool>() ? "the run came to its end" : "the run can go on"));
        add("lights", fmt::format("{} lamps, found by: {}", lights.at("lamps").size(), word(lights, "found_by")));
    } catch (const nlohmann::json::exception& failure) {
        throw Error("'", file.string(), "' does not say what it holds: ", failure.what());
    }
    add("device", map->expect_text("device"));
    add("state", fmt::format("{} arrays of {:.1f} MiB, {:.1f} MiB compressed, all whole", size.arrays,
                             mebibytes(size.bytes), mebibytes(size.compressed_bytes)));
    if (const size_t files = map->files().size(); files > 0) add("pictures", fmt::format("{} files of results", files));
    return lines;
}

}  // namespace patina::tools
