#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace patina {

/// Which Vulkan device to use, and how.
struct DeviceChoice {
    /// An index ("0"), a part of a name ("llvmpipe", any case), or a type ("discrete", "integrated", "virtual", "cpu");
    /// empty takes the fastest real GPU, else a software device.
    std::string selector{};
    /// Turns on the Khronos validation layer with synchronization validation; every message is kept. Slow.
    bool validation = false;
    /// Folder in which compiled pipelines are kept from run to run; empty keeps none.
    std::filesystem::path pipeline_cache_folder{};
    /// Bytes of device memory that pools may grow into, in all; 0: as much as there is.
    uint64_t memory_limit = 0;
};

/// An opened Vulkan device. It outlives what is made on it. One thread at a time.
class Device {
  public:
    /// Throws Error where there is no Vulkan device, none fits, or one lacks what Patina needs.
    explicit Device(const DeviceChoice& choice = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    std::string name() const;    ///< as the driver reports it
    std::string driver() const;  ///< name and version

    /// Every message of the validation layer so far, oldest first; empty without validation.
    std::vector<std::string> validation_messages() const;

  private:
    friend struct Access;
    struct State;
    explicit Device(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

/// The names of this machine's Vulkan devices in the driver's order, those included that cannot be used. Throws Error
/// when there is no Vulkan loader, driver or device.
std::vector<std::string> device_names();

}  // namespace patina
