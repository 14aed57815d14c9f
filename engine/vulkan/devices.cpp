// Listing and choosing devices, and what each must have.

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>

#include "engine/vulkan/context.h"
#include "engine/vulkan/floor.h"

namespace patina::vulkan {

namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    auto* log = static_cast<ValidationLog*>(user);
    const std::scoped_lock lock(log->mutex);
    log->messages.emplace_back(data->pMessage);
    return VK_FALSE;
}

std::string version_text(uint32_t version) {
    return text(VK_API_VERSION_MAJOR(version), '.', VK_API_VERSION_MINOR(version), '.', VK_API_VERSION_PATCH(version));
}

bool has_layer(const vk::raii::Context& loader, const char* name) {
    const auto layers = loader.enumerateInstanceLayerProperties();
    return std::any_of(layers.begin(), layers.end(),
                       [&](const auto& layer) { return std::strcmp(layer.layerName, name) == 0; });
}

bool has_instance_extension(const vk::raii::Context& loader, const char* name) {
    const auto extensions = loader.enumerateInstanceExtensionProperties();
    return std::any_of(extensions.begin(), extensions.end(),
                       [&](const auto& extension) { return std::strcmp(extension.extensionName, name) == 0; });
}

DeviceType device_type(vk::PhysicalDeviceType type) {
    switch (type) {
        case vk::PhysicalDeviceType::eDiscreteGpu: return DeviceType::kDiscrete;
        case vk::PhysicalDeviceType::eIntegratedGpu: return DeviceType::kIntegrated;
        case vk::PhysicalDeviceType::eVirtualGpu: return DeviceType::kVirtual;
        case vk::PhysicalDeviceType::eCpu: return DeviceType::kCpu;
        default: return DeviceType::kOther;
    }
}

std::string lower(std::string value) {
    std::transform(value.begin(), value.end(), value.begin(), [](unsigned char c) { return std::tolower(c); });
    return value;
}

/// Smaller is faster, by type; devices of one type keep the driver's order.
int rank(DeviceType type) {
    switch (type) {
        case DeviceType::kDiscrete: return 0;
        case DeviceType::kIntegrated: return 1;
        case DeviceType::kVirtual: return 2;
        case DeviceType::kOther: return 3;
        case DeviceType::kCpu: return 4;
    }
    return 5;
}

std::string listing(const std::vector<DeviceReport>& devices) {
    std::string names;
    for (const DeviceReport& device : devices) {
        names += text(names.empty() ? "" : ", ", device.index, " '", device.caps.name, "' (", name_of(device.caps.type),
                      ")");
    }
    return names;
}

}  // namespace

const char* name_of(DeviceType type) {
    switch (type) {
        case DeviceType::kDiscrete: return "discrete";
        case DeviceType::kIntegrated: return "integrated";
        case DeviceType::kVirtual: return "virtual";
        case DeviceType::kCpu: return "cpu";
        case DeviceType::kOther: return "other";
    }
    return "?";
}

vk::raii::Instance make_instance(const vk::raii::Context& loader, bool validation, ValidationLog* log,
                                 vk::raii::DebugUtilsMessengerEXT* messenger,
                                 const std::vector<std::string>& more_extensions) {
    const bool debug_utils = has_instance_extension(loader, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (validation && !(has_layer(loader, kValidationLayer) && debug_utils)) {
        throw Error("validation was asked for but the layer ", kValidationLayer,
                    " is not installed (Debian package vulkan-validationlayers)");
    }
    const vk::ApplicationInfo application("patina", 1, "patina", 1, VK_API_VERSION_1_3);
    std::vector<const char*> layers;
    std::vector<const char*> extensions;
    if (debug_utils) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    for (const std::string& extension : more_extensions) {
        if (!has_instance_extension(loader, extension.c_str()))
            throw Error("no window can be opened: no Vulkan driver offers ", extension);
        extensions.push_back(extension.c_str());
    }
    const std::array enabled = {vk::ValidationFeatureEnableEXT::eSynchronizationValidation};
    const vk::ValidationFeaturesEXT features(enabled);
    vk::InstanceCreateInfo info({}, &application);
    if (validation) {
        layers.push_back(kValidationLayer);
        info.pNext = &features;
    }
    info.setPEnabledLayerNames(layers).setPEnabledExtensionNames(extensions);
    try {
        vk::raii::Instance instance(loader, info);
        if (validation) {
            using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
            using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
            // Not its performance advice: that objects to the general layout, in which our images stay on purpose.
            const vk::DebugUtilsMessengerCreateInfoEXT callback({}, Severity::eError | Severity::eWarning,
                                                                Type::eValidation, on_message, log);
            *messenger = vk::raii::DebugUtilsMessengerEXT(instance, callback);
        }
        return instance;
    } catch (const vk::IncompatibleDriverError&) {
        throw Error(
            "no Vulkan driver was found: install the graphics card's driver, or Debian's mesa-vulkan-drivers, which "
            "also "
            "brings a software device");
    }
}

DeviceCaps caps_of(const vk::raii::PhysicalDevice& physical) {
    const auto chain = physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan11Properties,
                                               vk::PhysicalDeviceVulkan12Properties>();
    const auto& properties = chain.get<vk::PhysicalDeviceProperties2>().properties;
    const auto& v11 = chain.get<vk::PhysicalDeviceVulkan11Properties>();
    const auto& v12 = chain.get<vk::PhysicalDeviceVulkan12Properties>();
    DeviceCaps caps;
    caps.name = properties.deviceName.data();
    caps.driver = text(v12.driverName.data(), ' ', v12.driverInfo.data());
    caps.api_version = version_text(properties.apiVersion);
    caps.type = device_type(properties.deviceType);
    caps.subgroup_size = v11.subgroupSize;
    caps.max_group_invocations = properties.limits.maxComputeWorkGroupInvocations;
    caps.max_shared_bytes = properties.limits.maxComputeSharedMemorySize;
    caps.max_push_bytes = properties.limits.maxPushConstantsSize;
    caps.max_storage_buffers = properties.limits.maxPerStageDescriptorStorageBuffers;
    caps.max_storage_images = properties.limits.maxPerStageDescriptorStorageImages;
    caps.max_storage_range = properties.limits.maxStorageBufferRange;
    caps.max_texel_elements = properties.limits.maxTexelBufferElements;
    caps.max_allocation = v11.maxMemoryAllocationSize;
    caps.float16 = physical.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features>()
                       .get<vk::PhysicalDeviceVulkan12Features>()
                       .shaderFloat16;
    for (const auto& heap : physical.getMemoryProperties().memoryHeaps) {
        if (heap.flags & vk::MemoryHeapFlagBits::eDeviceLocal) {
            caps.device_memory = std::max<uint64_t>(caps.device_memory, heap.size);
        }
    }
    caps.timestamp_period_ns = properties.limits.timestampPeriod;
    for (const auto& family : physical.getQueueFamilyProperties()) {
        if (family.queueFlags & vk::QueueFlagBits::eCompute) {
            caps.timestamps = family.timestampValidBits > 0;
            break;
        }
    }
    return caps;
}

std::vector<std::string> missing_from_floor(const vk::raii::PhysicalDevice& physical, const DeviceCaps& caps) {
    std::vector<std::string> missing;
    const uint32_t version = physical.getProperties().apiVersion;
    if (version < VK_API_VERSION_1_3) {
        missing.push_back(text("Vulkan 1.3 (the device offers ", version_text(version), ")"));
        return missing;
    }
    const auto need = [&](uint64_t has, uint64_t wanted, const char* what) {
        if (has < wanted) missing.push_back(text(what, " of at least ", wanted, " (the device has ", has, ")"));
    };
    need(caps.max_storage_range, floor::kStorageRange, "a storage buffer range");
    need(caps.max_push_bytes, floor::kPushBytes, "push constants");
    need(caps.max_storage_buffers, floor::kStorageBuffers, "storage buffers per stage");
    need(caps.max_storage_images, floor::kStorageImages, "storage images per stage");
    need(caps.max_shared_bytes, floor::kSharedBytes, "shared memory");
    need(caps.max_group_invocations, floor::kGroupInvocations, "workgroup invocations");
    const auto features = physical.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features,
                                                vk::PhysicalDeviceVulkan13Features>();
    if (!features.get<vk::PhysicalDeviceVulkan12Features>().timelineSemaphore) missing.push_back("timeline semaphores");
    if (!features.get<vk::PhysicalDeviceVulkan13Features>().synchronization2) missing.push_back("synchronization2");
    return missing;
}

std::vector<DeviceReport> list_devices() {
    return guarded("listing the devices", [] {
        const vk::raii::Context loader;
        const vk::raii::Instance instance = make_instance(loader, false, nullptr, nullptr);
        std::vector<DeviceReport> reports;
        for (const vk::raii::PhysicalDevice& physical : vk::raii::PhysicalDevices(instance)) {
            DeviceReport report;
            report.index = static_cast<uint32_t>(reports.size());
            report.caps = caps_of(physical);
            report.missing = missing_from_floor(physical, report.caps);
            reports.push_back(std::move(report));
        }
        return reports;
    });
}

uint32_t choose_device(const std::vector<DeviceReport>& devices, const std::string& selector) {
    if (devices.empty()) {
        throw Error(
            "Vulkan is installed but offers no device: install the graphics card's driver or mesa-vulkan-drivers");
    }
    const DeviceReport* best = nullptr;
    const DeviceReport* unfit = nullptr;
    uint32_t index = 0;
    const char* end = selector.data() + selector.size();
    const bool by_index =
        !selector.empty() && std::from_chars(selector.data(), end, index).ptr == end && selector.size() < 6;
    for (const DeviceReport& device : devices) {
        const bool named = selector.empty() || (by_index && device.index == index) ||
                           (!by_index && (lower(selector) == name_of(device.caps.type) ||
                                          lower(device.caps.name).find(lower(selector)) != std::string::npos));
        if (!named) continue;
        if (!device.missing.empty()) {
            unfit = &device;
        } else if (!best || rank(device.caps.type) < rank(best->caps.type)) {
            best = &device;
        }
    }
    if (best) return best->index;
    if (unfit) throw Error("the device '", unfit->caps.name, "' cannot be used: it lacks ", unfit->missing.front());
    throw Error("no device fits '", selector, "'; this machine has ", listing(devices));
}

}  // namespace patina::vulkan
