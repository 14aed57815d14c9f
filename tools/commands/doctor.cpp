#include <cstdio>
#include <cstdlib>
#include <memory>

#include <fmt/format.h>

#include "engine/core/printable.h"
#include "engine/vulkan/floor.h"
#include "sensor/kinect2/diagnosis.h"
#include "sensor/live/other_cameras.h"
#include "tools/commands/commands.h"
#include "tools/program/standard_streams.h"

namespace patina::tools {

namespace {

/// What the device offers; "floor" is the least that Patina runs with.
void print(const vulkan::DeviceReport& device) {
    namespace floor = vulkan::floor;
    const vulkan::DeviceCaps& caps = device.caps;
    print_out("device {}: {} ({})\n", device.index, caps.name, vulkan::name_of(caps.type));
    print_out("  driver            {}, Vulkan {}\n", caps.driver, caps.api_version);
    print_out("  memory            {} MiB local, {} MiB per allocation\n", caps.device_memory >> 20,
              caps.max_allocation >> 20);
    print_out("  storage buffers   {} MiB each (floor {}), {} per stage (floor {})\n", caps.max_storage_range >> 20,
              floor::kStorageRange >> 20, caps.max_storage_buffers, floor::kStorageBuffers);
    print_out("  storage images    {} per stage (floor {})\n", caps.max_storage_images, floor::kStorageImages);
    print_out("  texel buffers     {} elements\n", caps.max_texel_elements);
    print_out("  push constants    {} bytes (floor {})\n", caps.max_push_bytes, floor::kPushBytes);
    print_out("  workgroups        {} invocations (floor {}), {} KiB shared (floor {}), subgroups of {}\n",
              caps.max_group_invocations, floor::kGroupInvocations, caps.max_shared_bytes >> 10,
              floor::kSharedBytes >> 10, caps.subgroup_size);
    // The default pool's chunks of distances have 2^25 voxels.
    const bool texels = caps.software() && caps.max_texel_elements >= (1u << 25) &&
                        caps.max_storage_images >= floor::kTexelVariantImages;
    print_out("  map access        {}\n", texels ? "texel buffers (faster on software devices)" : "storage buffers");
    print_out("  16-bit floats     {}\n", caps.float16 ? "yes" : "no");
    print_out("  pass times        {}\n", caps.timestamps ? "measured" : "not available: the device has no timestamps");
    if (device.missing.empty()) {
        print_out("  usable            yes\n");
        return;
    }
    for (const std::string& missing : device.missing) print_out("  lacks             {}\n", missing);
    print_out("  usable            no\n");
}

}  // namespace

void add_doctor(CLI::App& app) {
    CLI::App* command = app.add_subcommand(
        "doctor", "List the Vulkan devices and connected cameras, what they offer, and what is missing");
    const auto arguments = std::make_shared<DeviceArguments>();
    arguments->add_to(*command);
    command->callback([arguments] {
        print_out("{}", sensor::kinect2::format(sensor::kinect2::diagnose()));  // first: no Vulkan device ends it below
        print_out("{}{}", printable_lines(sensor::kinect1_report()), printable_lines(sensor::openni2_report()));
        const auto devices = vulkan::list_devices();
        for (const vulkan::DeviceReport& device : devices) print(device);
        const uint32_t chosen = vulkan::choose_device(devices, arguments->selector);
        print_out("patina uses device {}: {}\n", chosen, devices[chosen].caps.name);
    });
}

}  // namespace patina::tools
