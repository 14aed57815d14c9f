#include "tools/program/map_text.h"

#include <array>
#include <cstring>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "reconstruction/store/map_file.h"

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

double mebibytes(uint64_t bytes) { return static_cast<double>(bytes) / (1 << 20); }

}  // namespace

fs::path map_at(const fs::path& path) {
    std::error_code failure;
    if (fs::is_regular_file(path, failure)) return is_database(path) ? path : fs::path();
    const fs::path inside = path / "map.sqlite";
    const bool alone = fs::is_regular_file(inside, failure) && !fs::exists(path / "sequence.json", failure);
    return alone ? inside : fs::path();
}

std::string describe_map(const fs::path& file) {
    const auto map = MapFile::with_state(file);
    const auto progress = nlohmann::json::parse(map->expect_text("progress"));
    const auto session = nlohmann::json::parse(map->expect_text("session"));
    const auto lights = nlohmann::json::parse(map->expect_text("lights"));
    map->check();
    const MapFile::Size size = map->size();
    const std::string of = progress.contains("frames") ? fmt::format(" of {}", progress["frames"].get<uint32_t>()) : "";
    std::string lines =
        fmt::format("map       {}, of patina {}\n", file.string(), session["patina"].get<std::string>());
    lines += fmt::format("sequence  {} ({})\n", session["sequence"].get<std::string>(),
                         session["format"].get<std::string>());
    lines += fmt::format("frames    {}{} read, {} used; {}\n", progress["read"].get<uint32_t>(), of,
                         progress["used"].get<uint32_t>(),
                         progress["ended"].get<bool>() ? "the run came to its end" : "the run can go on");
    lines += fmt::format("lights    {} lamps, found by: {}\n", lights["lamps"].size(),
                         lights["found_by"].get<std::string>());
    lines += fmt::format("device    {}\n", map->expect_text("device"));
    lines += fmt::format("state     {} arrays of {:.1f} MiB, {:.1f} MiB compressed, all whole\n", size.arrays,
                         mebibytes(size.bytes), mebibytes(size.compressed_bytes));
    if (const size_t files = map->files().size(); files > 0)
        lines += fmt::format("pictures  {} files of results\n", files);
    return lines;
}

}  // namespace patina::tools
