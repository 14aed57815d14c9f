#include <cstdio>
#include <cstdlib>
#include <memory>

#include <fmt/format.h>

#include "tools/commands/commands.h"

namespace patina::tools {

namespace {

void print(const vulkan::DeviceReport& device) {
    const vulkan::DeviceCaps& caps = device.caps;
    fmt::print("device {}: {} ({})\n", device.index, caps.name, vulkan::name_of(caps.type));
    fmt::print("  driver            {}, Vulkan {}\n", caps.driver, caps.api_version);
    fmt::print("  memory            {} MiB local, {} MiB per allocation\n", caps.device_memory >> 20,
               caps.max_allocation >> 20);
    fmt::print("  storage buffers   {} MiB each, {} per stage\n", caps.max_storage_range >> 20,
               caps.max_storage_buffers);
    fmt::print("  texel buffers     {} elements\n", caps.max_texel_elements);
    fmt::print("  workgroups        {} invocations, {} KiB shared, subgroups of {}\n", caps.max_group_invocations,
               caps.max_shared_bytes >> 10, caps.subgroup_size);
    // The default pool's chunks of distances have 2^25 voxels.
    const bool texels = caps.software() && caps.max_texel_elements >= (1u << 25);
    fmt::print("  map access        {}\n", texels ? "texel buffers (faster on software devices)" : "storage buffers");
    fmt::print("  16-bit floats     {}\n", caps.float16 ? "yes" : "no");
    fmt::print("  pass times        {}\n",
               caps.timestamps ? "measured" : "not available: the device has no timestamps");
    if (device.missing.empty()) {
        fmt::print("  usable            yes\n");
        return;
    }
    for (const std::string& missing : device.missing) fmt::print("  lacks             {}\n", missing);
    fmt::print("  usable            no\n");
}

}  // namespace

void add_doctor(CLI::App& app) {
    CLI::App* command = app.add_subcommand("doctor", "List the Vulkan devices, what they offer, and what is missing");
    const auto arguments = std::make_shared<DeviceArguments>();
    arguments->add_to(*command);
    command->callback([arguments] {
        const auto devices = vulkan::list_devices();
        for (const vulkan::DeviceReport& device : devices) print(device);
        const uint32_t chosen = vulkan::choose_device(devices, arguments->selector);
        fmt::print("patina uses device {}: {}\n", chosen, devices[chosen].caps.name);
    });
}

}  // namespace patina::tools
