#include "engine/vulkan/context.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string_view>
#include <system_error>

#include "engine/vulkan/pipeline_cache.h"

namespace patina::vulkan {

vk::Format vk_format(Format format) {
    switch (format) {
        case Format::kR32f: return vk::Format::eR32Sfloat;
        case Format::kRgba32f: return vk::Format::eR32G32B32A32Sfloat;
        case Format::kRgba16f: return vk::Format::eR16G16B16A16Sfloat;
        case Format::kRgba8: return vk::Format::eR8G8B8A8Unorm;
        case Format::kR32u: return vk::Format::eR32Uint;
        case Format::kRgba32u: return vk::Format::eR32G32B32A32Uint;
    }
    return vk::Format::eUndefined;
}

Context::Context(const DeviceOptions& options) : options_(options), log_(std::make_unique<ValidationLog>()) {
    const uint32_t index = choose_device(list_devices(), options.selector);
    guarded("opening the device", [&] {
        instance_ = make_instance(loader_, options.validation, log_.get(), &messenger_, options.surface_extensions);
        open_device(index);
        load_pipeline_cache();
        const vk::SamplerAddressMode clamp = vk::SamplerAddressMode::eClampToEdge;
        nearest_ = device_.createSampler(
            {{}, vk::Filter::eNearest, vk::Filter::eNearest, vk::SamplerMipmapMode::eNearest, clamp, clamp, clamp});
    });
}

Context::~Context() {
    if (!*device_) return;
    save_pipeline_cache();
}

void Context::open_device(uint32_t index) {
    vk::raii::PhysicalDevices physicals(instance_);
    physical_ = std::move(physicals.at(index));
    caps_ = caps_of(physical_);
    vk::QueueFlags asked = vk::QueueFlagBits::eCompute;
    if (options_.graphics) asked |= vk::QueueFlagBits::eGraphics;
    const auto families = physical_.getQueueFamilyProperties();
    const auto family =
        std::find_if(families.begin(), families.end(), [&](const auto& f) { return (f.queueFlags & asked) == asked; });
    if (family == families.end())
        throw Error("the device '", caps_.name, "' has no queue for ", options_.graphics ? "graphics and " : "",
                    "compute");
    queue_family_ = static_cast<uint32_t>(family - families.begin());

    const float priority = 1;
    const vk::DeviceQueueCreateInfo queue({}, queue_family_, 1, &priority);
    vk::PhysicalDeviceFeatures features;
    vk::PhysicalDeviceVulkan13Features v13;
    v13.synchronization2 = true;
    v13.maintenance4 = true;
    v13.robustImageAccess = true;  // shaders may load beyond an image and get zero
    vk::PhysicalDeviceVulkan12Features v12;
    v12.timelineSemaphore = true;
    v12.shaderFloat16 = caps_.float16;
    v12.pNext = &v13;
    std::vector<const char*> extensions;
    const auto offered = physical_.enumerateDeviceExtensionProperties();
    const auto offers = [&](std::string_view name) {
        return std::ranges::any_of(offered, [&](const auto& e) { return name == e.extensionName.data(); });
    };
    has_memory_budget_ = offers(VK_EXT_MEMORY_BUDGET_EXTENSION_NAME);
    if (has_memory_budget_) extensions.push_back(VK_EXT_MEMORY_BUDGET_EXTENSION_NAME);
    if (!options_.surface_extensions.empty()) {
        if (!offers(VK_KHR_SWAPCHAIN_EXTENSION_NAME))
            throw Error("the device '", caps_.name, "' cannot show pictures in a window: it lacks ",
                        VK_KHR_SWAPCHAIN_EXTENSION_NAME);
        extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    }
    vk::DeviceCreateInfo info({}, queue, {}, extensions);
    info.pEnabledFeatures = &features;
    info.pNext = &v12;
    device_ = vk::raii::Device(physical_, info);
    queue_ = device_.getQueue(queue_family_, 0);
    debug_names_ = options_.validation || device_.getDispatcher()->vkSetDebugUtilsObjectNameEXT != nullptr;
    set_name(device_, "patina.device");
    set_name(queue_, "patina.queue");
}

vk::raii::DeviceMemory Context::allocate(const std::string& name, uint64_t bytes, uint32_t type_bits,
                                         vk::MemoryPropertyFlags required, vk::MemoryPropertyFlags preferred) {
    const std::string doing = text("allocating ", bytes, " bytes for '", name, "'");
    if (++allocations_ == options_.fail_allocation_at) {
        throw OutOfMemory("the Vulkan device ran out of memory while ", doing);
    }
    const auto properties = physical_.getMemoryProperties();
    const auto find = [&](vk::MemoryPropertyFlags flags) -> std::optional<uint32_t> {
        for (uint32_t i = 0; i < properties.memoryTypeCount; ++i) {
            if ((type_bits >> i & 1) && (properties.memoryTypes[i].propertyFlags & flags) == flags) return i;
        }
        return std::nullopt;
    };
    std::optional<uint32_t> type = find(required | preferred);
    if (!type) type = find(required);
    if (!type) throw Error("the device has no memory type for '", name, "' (type bits ", type_bits, ")");
    return guarded(doing, [&] {
        vk::raii::DeviceMemory memory = device_.allocateMemory(vk::MemoryAllocateInfo(bytes, *type));
        set_name(memory, name + ".memory");
        return memory;
    });
}

uint64_t Context::available_memory() const {
    vk::PhysicalDeviceMemoryBudgetPropertiesEXT budget;
    vk::PhysicalDeviceMemoryProperties2 properties;
    if (has_memory_budget_) properties.pNext = &budget;  // a driver without the extension may warn of the structure
    (*physical_).getMemoryProperties2(&properties, *physical_.getDispatcher());
    const uint64_t held = held_memory();
    uint64_t available = 0;
    for (uint32_t i = 0; i < properties.memoryProperties.memoryHeapCount; ++i) {
        const vk::MemoryHeap& heap = properties.memoryProperties.memoryHeaps[i];
        if (!(heap.flags & vk::MemoryHeapFlagBits::eDeviceLocal)) continue;
        const uint64_t most = has_memory_budget_ ? budget.heapBudget[i] : heap.size;
        const uint64_t used = (has_memory_budget_ ? budget.heapUsage[i] : held) + heap.size / 16;
        available = std::max(available, most - std::min(used, most));
    }
    if (options_.memory_limit == 0) return available;
    return std::min(available, options_.memory_limit - std::min(held, options_.memory_limit));
}

const Pipeline& Context::pipeline(const Shader& shader, const Specialization& constants) {
    const auto key = std::pair(&shader, constants);
    auto found = pipelines_.find(key);
    if (found == pipelines_.end()) {
        found = pipelines_
                    .emplace(key, guarded(text("building the pipeline '", shader.name, "'"),
                                          [&] { return build_pipeline(shader, constants); }))
                    .first;
    }
    return found->second;
}

std::vector<std::string> Context::built_pipelines() const {
    std::vector<std::string> names;
    for (const auto& [key, pipeline] : pipelines_) names.emplace_back(key.first->name);
    std::ranges::sort(names);
    return names;
}

namespace {

vk::DescriptorType descriptor_type(BindingKind kind) {
    switch (kind) {
        case BindingKind::kStorageBuffer: return vk::DescriptorType::eStorageBuffer;
        case BindingKind::kUniformBuffer: return vk::DescriptorType::eUniformBuffer;
        case BindingKind::kSampledImage: return vk::DescriptorType::eCombinedImageSampler;
        case BindingKind::kStorageImage: return vk::DescriptorType::eStorageImage;
        case BindingKind::kTexelBuffer: return vk::DescriptorType::eStorageTexelBuffer;
    }
    return vk::DescriptorType::eStorageBuffer;
}

}  // namespace

Pipeline Context::build_pipeline(const Shader& shader, const Specialization& constants) {
    Pipeline result;
    std::vector<vk::DescriptorSetLayoutBinding> bindings;
    for (const ShaderBinding& b : shader.bindings) {
        bindings.emplace_back(b.binding, descriptor_type(b.kind), b.count, vk::ShaderStageFlagBits::eCompute);
    }
    result.set_layout = device_.createDescriptorSetLayout({{}, bindings});
    const vk::PushConstantRange push(vk::ShaderStageFlagBits::eCompute, 0, shader.push_bytes);
    vk::PipelineLayoutCreateInfo layout({}, *result.set_layout);
    if (shader.push_bytes > 0) layout.setPushConstantRanges(push);
    result.layout = device_.createPipelineLayout(layout);

    std::vector<vk::SpecializationMapEntry> entries;
    std::vector<uint32_t> values;
    for (const auto& [id, value] : constants) {
        entries.emplace_back(id, static_cast<uint32_t>(values.size() * sizeof(uint32_t)), sizeof(uint32_t));
        values.push_back(value);
    }
    const vk::SpecializationInfo specialization(static_cast<uint32_t>(entries.size()), entries.data(),
                                                values.size() * sizeof(uint32_t), values.data());
    const vk::raii::ShaderModule module =
        device_.createShaderModule({{}, shader.words.size_bytes(), shader.words.data()});
    set_name(module, text(shader.name, ".spirv"));
    const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main",
                                                  entries.empty() ? nullptr : &specialization);
    result.pipeline =
        vk::raii::Pipeline(device_, pipeline_cache_, vk::ComputePipelineCreateInfo({}, stage, *result.layout));
    set_name(result.pipeline, shader.name);
    set_name(result.layout, text(shader.name, ".layout"));
    set_name(result.set_layout, text(shader.name, ".bindings"));
    return result;
}

std::filesystem::path Context::pipeline_cache_file() const {
    if (options_.pipeline_cache_folder.empty()) return {};
    const auto properties = physical_.getProperties();
    std::string name = "pipelines-";
    for (const uint8_t byte : properties.pipelineCacheUUID) {
        char hex[3];
        std::snprintf(hex, sizeof hex, "%02x", byte);
        name += hex;
    }
    return options_.pipeline_cache_folder / (name + ".bin");
}

void Context::load_pipeline_cache() {
    std::vector<uint8_t> data;
    if (const auto file = pipeline_cache_file(); !file.empty()) data = read_pipeline_cache(file);
    // Drivers check the header themselves and start empty when it is another driver's.
    pipeline_cache_ = device_.createPipelineCache({{}, data.size(), data.data()});
    set_name(pipeline_cache_, "patina.pipelines");
}

void Context::save_pipeline_cache() const noexcept {
    try {
        const auto file = pipeline_cache_file();
        if (!file.empty() && !pipelines_.empty()) write_pipeline_cache(file, pipeline_cache_.getData());
    } catch (const std::exception&) {  // without the data there is nothing to keep
    }
}

}  // namespace patina::vulkan
