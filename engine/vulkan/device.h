#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "engine/vulkan/resources.h"

namespace patina::vulkan {

/// Memory ran out, or one allocation was larger than the device makes.
class OutOfMemory : public Error {
  public:
    using Error::Error;
};

/// How to open a device.
struct DeviceOptions {
    /// An index ("0"), a part of a name ("llvmpipe", any case), or a type ("discrete", "integrated", "virtual", "cpu");
    /// empty takes the fastest real GPU, else a software device.
    std::string selector;
    /// Turns on the Khronos validation layer with synchronization validation; every message is kept.
    bool validation = false;
    /// Folder in which compiled pipelines are kept from run to run; empty keeps nothing.
    std::filesystem::path pipeline_cache_folder;
    /// Device memory that pools may grow into, bytes in all; 0: as much as there is.
    uint64_t memory_limit = 0;
    /// The queue takes graphics too: a user interface is drawn on the device (compose.h).
    bool graphics = false;
    /// Instance extensions by which the window system makes surfaces; the device presents pictures in windows then
    /// (swapchain.h). Empty: it presents none.
    std::vector<std::string> surface_extensions;
    /// Fault injection for tests: the n-th memory allocation fails as if memory had run out; 0 fails none.
    uint32_t fail_allocation_at = 0;
};

enum class DeviceType : uint8_t { kDiscrete, kIntegrated, kVirtual, kCpu, kOther };

const char* name_of(DeviceType type);

/// What a device offers, as far as Patina's passes ask.
struct DeviceCaps {
    std::string name;
    std::string driver;  ///< name and version as the driver reports them
    std::string api_version;
    DeviceType type = DeviceType::kOther;
    uint32_t subgroup_size = 0;
    uint32_t max_group_invocations = 0;
    uint32_t max_shared_bytes = 0;
    uint32_t max_push_bytes = 0;
    uint32_t max_storage_buffers = 0;  ///< per stage
    uint32_t max_storage_images = 0;   ///< per stage
    uint64_t max_storage_range = 0;    ///< bytes
    uint64_t max_texel_elements = 0;
    uint64_t max_allocation = 0;  ///< bytes
    uint64_t device_memory = 0;   ///< bytes of the largest device-local heap
    bool float16 = false;         ///< shaders may compute in 16-bit floats
    bool timestamps = false;
    double timestamp_period_ns = 0;

    bool software() const { return type == DeviceType::kCpu; }
};

/// One device as `patina doctor` shows it.
struct DeviceReport {
    uint32_t index = 0;
    DeviceCaps caps;
    std::vector<std::string> missing;  ///< what the portability floor asks and the device lacks; empty where it will do
};

/// Lists the devices of this machine in the driver's order. Throws Error, with one sentence that says what to install,
/// when there is no Vulkan loader, driver or device.
std::vector<DeviceReport> list_devices();

/// The device that `selector` means, as an index into `devices`. Throws Error when none fits.
uint32_t choose_device(const std::vector<DeviceReport>& devices, const std::string& selector);

/// Vulkan itself (instance, device, queue, caches); its definition is private to engine/vulkan.
class Context;

/// An opened Vulkan device with one compute queue. Objects made from it keep it alive. Not thread-safe, except that it
/// may be destroyed on any thread.
class Device {
  public:
    /// Throws Error where no device fits, one lacks the floor, or validation is asked for and not installed.
    explicit Device(const DeviceOptions& options = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceCaps& caps() const;

    /// Creates a buffer or image with memory of its own. Content is undefined. Throws Error when memory runs out,
    /// naming the resource and its size.
    BufferRef create_buffer(const BufferDesc& desc);
    ImageRef create_image(const ImageDesc& desc);

    /// Creates a block of device memory in which transient resources are placed.
    MemoryRef create_memory(const std::string& name, uint64_t bytes, bool for_images);
    BufferRef create_placed_buffer(const BufferDesc& desc, const MemoryRef& memory, uint64_t offset);
    ImageRef create_placed_image(const ImageDesc& desc, const MemoryRef& memory, uint64_t offset);

    /// Bytes and alignment that such a resource takes in device memory.
    MemoryRequirement requirement(const BufferDesc& desc) const;
    MemoryRequirement requirement(const ImageDesc& desc) const;

    /// Bytes of device memory that may still be allocated without crowding others out: what the driver's budget leaves
    /// (VK_EXT_memory_budget), else the heap less what this device holds of it; less a sixteenth of the heap. No more
    /// than DeviceOptions::memory_limit leaves.
    uint64_t available_memory() const;

    /// Bytes of memory that this device holds now: those of all its buffers, images and blocks.
    uint64_t held_memory() const;

    /// Waits until the device has done all that was submitted.
    void wait_idle();

    /// Every message of the validation layer so far, oldest first; empty without validation.
    std::vector<std::string> validation_messages() const;

    Context& context() { return *context_; }
    const std::shared_ptr<Context>& shared_context() const { return context_; }

  private:
    std::shared_ptr<Context> context_;
};

}  // namespace patina::vulkan
