#include <cstdlib>

#include "reconstruction/api/access.h"
#include "tools/commands/commands.h"

namespace patina::tools {

namespace {

std::filesystem::path cache_folder() {
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache)
        return std::filesystem::path(cache) / "patina";
    if (const char* home = std::getenv("HOME"); home && *home) return std::filesystem::path(home) / ".cache" / "patina";
    return {};
}

}  // namespace

void DeviceArguments::add_to(CLI::App& command) {
    command
        .add_option("--device", selector,
                    "Index, part of the name, or type (discrete, integrated, virtual, cpu) of the device")
        ->envname("PATINA_DEVICE");
    command.add_flag("--validation", validation,
                     "Check every Vulkan call (slow); a message ends the command with an error");
    command.add_option("--memory", memory_mib, "Device memory in MiB beyond which pools do not grow")
        ->check(CLI::Range(uint64_t{1}, uint64_t{1} << 24))
        ->option_text("MIB");
}

DeviceChoice DeviceArguments::choice() const {
    return {.selector = selector,
            .validation = validation,
            .pipeline_cache_folder = cache_folder(),
            .memory_limit = memory_mib << 20};
}

vulkan::DeviceOptions DeviceArguments::options() const { return Access::options(choice()); }

}  // namespace patina::tools
