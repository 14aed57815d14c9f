#include "patina/device.h"

#include "reconstruction/api/access.h"

namespace patina {

struct Device::State {
    vulkan::Device device;
};

Device::Device(const DeviceChoice& choice) : state_(new State{vulkan::Device(Access::options(choice))}) {}
Device::Device(std::unique_ptr<State> state) : state_(std::move(state)) {}

Device::~Device() = default;

std::string Device::name() const { return state_->device.caps().name; }
std::string Device::driver() const { return state_->device.caps().driver; }
std::vector<std::string> Device::validation_messages() const { return state_->device.validation_messages(); }

std::vector<std::string> device_names() {
    std::vector<std::string> names;
    for (const vulkan::DeviceReport& device : vulkan::list_devices()) names.push_back(device.caps.name);
    return names;
}

vulkan::DeviceOptions Access::options(const DeviceChoice& choice) {
    vulkan::DeviceOptions options;
    options.selector = choice.selector;
    options.validation = choice.validation;
    options.pipeline_cache_folder = choice.pipeline_cache_folder;
    options.memory_limit = choice.memory_limit;
    return options;
}

Device Access::device(const vulkan::DeviceOptions& options) {
    return Device(std::unique_ptr<Device::State>(new Device::State{vulkan::Device(options)}));
}

vulkan::Device& Access::vulkan(Device& device) { return device.state_->device; }

}  // namespace patina
