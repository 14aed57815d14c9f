#include "engine/vulkan/pipeline_cache.h"

#include <array>
#include <chrono>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#ifdef _WIN32
#include <process.h>
#define getpid _getpid
#else
#include <unistd.h>
#endif

#include "engine/core/digest.h"
#include "engine/core/error.h"
#include "engine/core/input_file.h"

namespace patina::vulkan {
namespace {

namespace fs = std::filesystem;

struct Header {
    std::array<char, 8> name{'P', 'a', 't', 'P', 'i', 'p', 'e', '1'};
    uint64_t checksum = 0;

    bool operator==(const Header&) const = default;
};

/// Its checksum notices damage, not intent: who may write here may replace the program's libraries too.
Header header_of(std::span<const uint8_t> data) {
    Digest digest;
    digest.add({reinterpret_cast<const char*>(data.data()), data.size()});
    Header header;
    header.checksum = digest.value();
    return header;
}

/// Removes what processes that were killed while they wrote left beside a cache, of this driver or another: files of
/// another process's that are new may still be written.
void remove_abandoned(const fs::path& folder) {
    const auto newest = fs::file_time_type::clock::now() - std::chrono::hours(24);
    std::error_code failure;
    for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end; entry.increment(failure)) {
        const std::string name = entry->path().filename().string();
        std::error_code none;
        const bool temporary = name.starts_with("pipelines-") && name.find(".bin.") != std::string::npos;
        if (!temporary || !fs::is_regular_file(entry->symlink_status(none))) continue;
        const fs::file_time_type written = entry->last_write_time(none);
        if (!none && written < newest) fs::remove(entry->path(), none);
    }
}

}  // namespace

std::vector<uint8_t> read_pipeline_cache(const fs::path& file) try {
    std::vector<uint8_t> bytes = read_file(file, limits::kPipelineCacheBytes);
    Header header;
    if (bytes.size() < sizeof(header)) return {};
    std::memcpy(&header, bytes.data(), sizeof(header));
    bytes.erase(bytes.begin(), bytes.begin() + sizeof(header));
    return header == header_of(bytes) ? bytes : std::vector<uint8_t>();
} catch (const std::exception&) {
    return {};
}

void write_pipeline_cache(const fs::path& file, std::span<const uint8_t> data) noexcept {
    std::error_code ignored;
    try {
        fs::create_directories(file.parent_path());
        remove_abandoned(file.parent_path());
        const fs::path temporary = text(file.string(), '.', getpid());
        fs::remove(temporary, ignored);
        const Header header = header_of(data);
        std::ofstream out(temporary, std::ios::binary);
        out.write(reinterpret_cast<const char*>(&header), sizeof(header));
        out.write(reinterpret_cast<const char*>(data.data()), static_cast<std::streamsize>(data.size()));
        out.close();
        std::error_code failure;
        if (out) fs::rename(temporary, file, failure);
        if (!out || failure) fs::remove(temporary, ignored);
    } catch (const std::exception&) {
    }
}

}  // namespace patina::vulkan
