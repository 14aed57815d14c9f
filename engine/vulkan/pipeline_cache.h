#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace patina::vulkan {

/// The driver's data in a pipeline cache file; empty when there is none that write_pipeline_cache wrote whole: the file
/// is missing, a folder, a pipe, longer than limits::kPipelineCacheBytes, or damaged. Drivers check no more than a
/// cache's header.
std::vector<uint8_t> read_pipeline_cache(const std::filesystem::path& file);

/// Writes the driver's data with a checksum, beside its place and then into it. A cache that cannot be kept costs the
/// next start some time and nothing else: failures leave nothing behind and are not reported. What a killed process
/// left beside it, "pipelines-*.bin.*", is removed once it is a day old.
void write_pipeline_cache(const std::filesystem::path& file, std::span<const uint8_t> data) noexcept;

}  // namespace patina::vulkan
