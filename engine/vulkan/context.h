#pragma once

// Private to engine/vulkan and the graph's executor: the one place that pulls in Vulkan's own headers.

#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <vulkan/vulkan_raii.hpp>

#include "engine/core/error.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/shader.h"

namespace patina::vulkan {

/// Messages of the validation layer; the layer may call from any thread.
struct ValidationLog {
    mutable std::mutex mutex;
    std::vector<std::string> messages;
};

/// A compute pipeline with its layouts.
struct Pipeline {
    vk::raii::DescriptorSetLayout set_layout = nullptr;
    vk::raii::PipelineLayout layout = nullptr;
    vk::raii::Pipeline pipeline = nullptr;
};

/// Values of specialization constants by id.
using Specialization = std::vector<std::pair<uint32_t, uint32_t>>;

vk::Format vk_format(Format format);

/// Opens the Vulkan loader; with `validation`, the layer reports to `log`. `more_extensions`: of the instance. Throws
/// Error as list_devices() does, and where the loader lacks an extension.
vk::raii::Instance make_instance(const vk::raii::Context& loader, bool validation, ValidationLog* log,
                                 vk::raii::DebugUtilsMessengerEXT* messenger,
                                 const std::vector<std::string>& more_extensions = {});

DeviceCaps caps_of(const vk::raii::PhysicalDevice& physical);
std::vector<std::string> missing_from_floor(const vk::raii::PhysicalDevice& physical, const DeviceCaps& caps);

/// Runs `work`, turning Vulkan's exceptions into one Error that says what was being done ("creating the buffer 'x'").
template <class Work>
auto guarded(const std::string& doing, Work&& work) {
    try {
        return work();
    } catch (const vk::DeviceLostError&) {
        throw Error("the Vulkan device was lost while ", doing, "; the driver's log may say why");
    } catch (const vk::OutOfDeviceMemoryError&) {
        throw OutOfMemory("the Vulkan device ran out of memory while ", doing);
    } catch (const vk::OutOfHostMemoryError&) {
        throw OutOfMemory("the host ran out of memory while ", doing);
    } catch (const vk::SystemError& error) {
        throw Error("Vulkan reported '", error.what(), "' while ", doing);
    }
}

class Context {
  public:
    explicit Context(const DeviceOptions& options);
    ~Context();

    const DeviceCaps& caps() const { return caps_; }
    const vk::raii::Instance& instance() const { return instance_; }
    const vk::raii::PhysicalDevice& physical() const { return physical_; }
    const vk::raii::Device& device() const { return device_; }
    const vk::raii::Queue& queue() const { return queue_; }
    uint32_t queue_family() const { return queue_family_; }
    const ValidationLog& validation_log() const { return *log_; }
    uint64_t next_serial() { return ++serial_; }

    /// Gives a Vulkan object the name that validation messages and captures show.
    template <class Handle>
    void set_name(const Handle& handle, const std::string& name) const {
        if (!debug_names_) return;
        using CType = typename Handle::CType;
        const uint64_t raw = reinterpret_cast<uint64_t>(static_cast<CType>(*handle));
        device_.setDebugUtilsObjectNameEXT({Handle::objectType, raw, name.c_str()});
    }
    bool debug_names() const { return debug_names_; }

    /// Allocates memory of a type in `type_bits` that has `required`, and `preferred` if there is one.
    vk::raii::DeviceMemory allocate(const std::string& name, uint64_t bytes, uint32_t type_bits,
                                    vk::MemoryPropertyFlags required, vk::MemoryPropertyFlags preferred);

    /// The pipeline for a shader with these constants, built at first use. The push range is the shader's own.
    const Pipeline& pipeline(const Shader& shader, const Specialization& constants);

    /// The shaders' names, one for each pipeline that was built so far, sorted.
    std::vector<std::string> built_pipelines() const;

    vk::Sampler nearest_sampler() const { return *nearest_; }

    /// Counts memory that was allocated (or, below 0, freed).
    void note_memory(int64_t bytes) { allocated_bytes_ += bytes; }
    /// See Device::available_memory.
    uint64_t available_memory() const;
    /// See Device::held_memory.
    uint64_t held_memory() const { return static_cast<uint64_t>(allocated_bytes_.load()); }

  private:
    void open_device(uint32_t index);
    void load_pipeline_cache();
    void save_pipeline_cache() const noexcept;
    std::filesystem::path pipeline_cache_file() const;
    Pipeline build_pipeline(const Shader& shader, const Specialization& constants);

    DeviceOptions options_;
    vk::raii::Context loader_;
    std::unique_ptr<ValidationLog> log_;
    vk::raii::Instance instance_ = nullptr;
    vk::raii::DebugUtilsMessengerEXT messenger_ = nullptr;
    vk::raii::PhysicalDevice physical_ = nullptr;
    DeviceCaps caps_;
    bool debug_names_ = false;
    bool has_memory_budget_ = false;
    std::atomic<int64_t> allocated_bytes_{0};
    vk::raii::Device device_ = nullptr;
    uint32_t queue_family_ = 0;
    vk::raii::Queue queue_ = nullptr;
    vk::raii::PipelineCache pipeline_cache_ = nullptr;
    vk::raii::Sampler nearest_ = nullptr;
    std::map<std::pair<const Shader*, Specialization>, Pipeline> pipelines_;
    uint32_t allocations_ = 0;
    std::atomic<uint64_t> serial_{0};
};

struct MemoryObject {
    MemoryObject() = default;
    ~MemoryObject();
    MemoryObject(const MemoryObject&) = delete;
    MemoryObject& operator=(const MemoryObject&) = delete;

    std::shared_ptr<Context> context;  ///< set once there is memory
    vk::raii::DeviceMemory memory = nullptr;
    uint64_t bytes = 0;
};

struct BufferObject {
    std::shared_ptr<Context> context;
    MemoryRef memory;
    BufferDesc desc;
    std::byte* mapped = nullptr;
    vk::raii::Buffer buffer = nullptr;
    std::map<Format, vk::raii::BufferView> texel_views;

    /// The view through which shaders fetch texels of `format`, made at first use. Throws Error above the device's
    /// limit.
    vk::BufferView texel_view(Format format);
};

struct ImageObject {
    std::shared_ptr<Context> context;
    MemoryRef memory;
    ImageDesc desc;
    vk::raii::Image image = nullptr;
    vk::raii::ImageView view = nullptr;
};

/// Runs commands at once, and waits for their end. Vulkan's exceptions are the caller's.
void submit_and_wait(Context& context, const std::function<void(vk::CommandBuffer)>& record);

vk::BufferCreateInfo create_info(const BufferDesc& desc);
vk::ImageCreateInfo create_info(const ImageDesc& desc);

}  // namespace patina::vulkan
