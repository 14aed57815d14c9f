// A Vulkan layer that lets one call of a program fail, as drivers do once in a while: PATINA_FAULT="vkAllocateMemory 3
// -2" returns VkResult -2 from the third call of vkAllocateMemory and does nothing else. With -4 (device lost) the
// device stays lost: every later submission and wait returns it too. A lost device runs nothing any more, so that what
// was submitted before is waited for. A fourth number lets every call of that name wait so many milliseconds first, as
// on a slow device: "vkQueueSubmit2 0 0 100" fails none.

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string>
#include <thread>

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

namespace {

struct Fault {
    std::string call;
    int at = 0;
    int result = VK_SUCCESS;
    int delay_ms = 0;
};

const Fault& fault() {
    static const Fault read = [] {
        Fault made;
        if (const char* wanted = std::getenv("PATINA_FAULT"))
            std::istringstream(wanted) >> made.call >> made.at >> made.result >> made.delay_ms;
        return made;
    }();
    return read;
}

std::atomic<int> calls{0};
std::atomic<bool> lost{false};
PFN_vkGetInstanceProcAddr next_instance_call = nullptr;
PFN_vkGetDeviceProcAddr next_device_call = nullptr;
VkInstance instance = VK_NULL_HANDLE;
VkDevice device_made = VK_NULL_HANDLE;

void lose_device() {
    lost = true;
    const auto wait = reinterpret_cast<PFN_vkDeviceWaitIdle>(next_device_call(device_made, "vkDeviceWaitIdle"));
    wait(device_made);
}

/// Stands before a call: `Counted` ones are those that the fault names, others only know of a lost device.
template <bool Counted, class Function>
struct Before;

template <bool Counted, class... Arguments>
struct Before<Counted, VkResult(VKAPI_PTR*)(Arguments...)> {
    static inline VkResult(VKAPI_PTR* next)(Arguments...) = nullptr;

    static VKAPI_ATTR VkResult VKAPI_CALL call(Arguments... arguments) {
        if (lost) return VK_ERROR_DEVICE_LOST;
        if (Counted) std::this_thread::sleep_for(std::chrono::milliseconds(fault().delay_ms));
        if (Counted && ++calls == fault().at) {
            if (fault().result == VK_ERROR_DEVICE_LOST) lose_device();
            return static_cast<VkResult>(fault().result);
        }
        return next(arguments...);
    }
};

template <bool Counted, class Function>
PFN_vkVoidFunction put_before(PFN_vkVoidFunction next) {
    Before<Counted, Function>::next = reinterpret_cast<Function>(next);
    return reinterpret_cast<PFN_vkVoidFunction>(&Before<Counted, Function>::call);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_call(VkDevice device, const char* name) {
    const PFN_vkVoidFunction next = next_device_call(device, name);
    const bool counted = fault().call == name;
#define PATINA_FAULT_CALL(call) \
    if (counted && std::strcmp(name, #call) == 0) return put_before<true, PFN_##call>(next);
    PATINA_FAULT_CALL(vkAllocateCommandBuffers)
    PATINA_FAULT_CALL(vkAllocateDescriptorSets)
    PATINA_FAULT_CALL(vkAllocateMemory)
    PATINA_FAULT_CALL(vkBeginCommandBuffer)
    PATINA_FAULT_CALL(vkBindBufferMemory)
    PATINA_FAULT_CALL(vkCreateBuffer)
    PATINA_FAULT_CALL(vkCreateComputePipelines)
    PATINA_FAULT_CALL(vkCreateDescriptorPool)
    PATINA_FAULT_CALL(vkCreateImageView)
    PATINA_FAULT_CALL(vkCreateSemaphore)
    PATINA_FAULT_CALL(vkDeviceWaitIdle)
    PATINA_FAULT_CALL(vkEndCommandBuffer)
    PATINA_FAULT_CALL(vkGetPipelineCacheData)
    PATINA_FAULT_CALL(vkGetQueryPoolResults)
    PATINA_FAULT_CALL(vkMapMemory)
    PATINA_FAULT_CALL(vkQueueSubmit2)
    PATINA_FAULT_CALL(vkQueueWaitIdle)
    PATINA_FAULT_CALL(vkResetCommandPool)
    PATINA_FAULT_CALL(vkWaitSemaphores)
#undef PATINA_FAULT_CALL
    if (std::strcmp(name, "vkDeviceWaitIdle") == 0) return put_before<false, PFN_vkDeviceWaitIdle>(next);
    if (std::strcmp(name, "vkQueueSubmit2") == 0) return put_before<false, PFN_vkQueueSubmit2>(next);
    if (std::strcmp(name, "vkQueueWaitIdle") == 0) return put_before<false, PFN_vkQueueWaitIdle>(next);
    if (std::strcmp(name, "vkWaitSemaphores") == 0) return put_before<false, PFN_vkWaitSemaphores>(next);
    return next;
}

/// The loader's link to the next layer, taken off its chain.
template <class LinkInfo, class CreateInfo>
auto* take_link(const CreateInfo& info, VkStructureType type) {
    const auto* link = static_cast<const LinkInfo*>(info.pNext);
    while (link->sType != type || link->function != VK_LAYER_LINK_INFO)
        link = static_cast<const LinkInfo*>(link->pNext);
    auto*& place = const_cast<LinkInfo*>(link)->u.pLayerInfo;
    auto* taken = place;
    place = place->pNext;
    return taken;
}

VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                                               VkInstance* made) {
    const auto* link = take_link<VkLayerInstanceCreateInfo>(*info, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    next_instance_call = link->pfnNextGetInstanceProcAddr;
    const auto create = reinterpret_cast<PFN_vkCreateInstance>(next_instance_call(nullptr, "vkCreateInstance"));
    const VkResult result = create(info, allocator, made);
    instance = *made;
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                             const VkAllocationCallbacks* allocator, VkDevice* made) {
    const auto* link = take_link<VkLayerDeviceCreateInfo>(*info, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    next_device_call = link->pfnNextGetDeviceProcAddr;
    const auto create =
        reinterpret_cast<PFN_vkCreateDevice>(link->pfnNextGetInstanceProcAddr(instance, "vkCreateDevice"));
    const VkResult result = create(physical, info, allocator, made);
    device_made = *made;
    return result;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_call(VkInstance of, const char* name) {
    if (std::strcmp(name, "vkCreateInstance") == 0) return reinterpret_cast<PFN_vkVoidFunction>(&create_instance);
    if (std::strcmp(name, "vkCreateDevice") == 0) return reinterpret_cast<PFN_vkVoidFunction>(&create_device);
    if (std::strcmp(name, "vkGetInstanceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(&instance_call);
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(&device_call);
    return next_instance_call ? next_instance_call(of, name) : nullptr;
}

}  // namespace

extern "C" VK_LAYER_EXPORT VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* interface) {
    interface->loaderLayerInterfaceVersion = 2;
    interface->pfnGetInstanceProcAddr = &instance_call;
    interface->pfnGetDeviceProcAddr = &device_call;
    interface->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
