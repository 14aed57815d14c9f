#include "tests/simulated_kinect2/usbip/descriptors.h"

#include <initializer_list>
#include <string>

namespace patina::sensor::kinect2::testing::usbip {
namespace {

constexpr uint8_t kDevice = 1, kConfiguration = 2, kString = 3, kInterface = 4, kEndpoint = 5, kBinaryObjects = 15;
constexpr uint8_t kCapability = 16, kCompanion = 48;
constexpr uint8_t kIsochronous = 1, kBulk = 2, kInterrupt = 3;
constexpr uint8_t kVendorSpecific = 0xFF;

constexpr uint8_t low(uint32_t word) { return static_cast<uint8_t>(word); }
constexpr uint8_t high(uint32_t word) { return static_cast<uint8_t>(word >> 8); }

void add(std::vector<uint8_t>& bytes, uint8_t kind, std::initializer_list<uint8_t> body) {
    bytes.push_back(static_cast<uint8_t>(body.size() + 2));
    bytes.push_back(kind);
    bytes.insert(bytes.end(), body);
}

void add_interface(std::vector<uint8_t>& bytes, uint8_t number, uint8_t setting, uint8_t endpoints) {
    add(bytes, kInterface, {number, setting, endpoints, kVendorSpecific, 0, 0, 0});
}

/// `burst`: packets at once; `attributes` and `bytes_per_interval` as in the companion descriptor of SuperSpeed.
void add_endpoint(std::vector<uint8_t>& bytes, uint8_t address, uint8_t kind, uint16_t packet, uint8_t interval,
                  uint8_t burst, uint8_t attributes, uint32_t bytes_per_interval) {
    add(bytes, kEndpoint, {address, kind, low(packet), high(packet), interval});
    add(bytes, kCompanion,
        {static_cast<uint8_t>(burst - 1), attributes, low(bytes_per_interval), high(bytes_per_interval)});
}

std::vector<uint8_t> device() {
    std::vector<uint8_t> bytes;
    // USB 3.0, no class, packets of 2^9 bytes, 045E:02C4, strings 1 to 3, one configuration.
    add(bytes, kDevice, {0x00, 0x03, 0, 0, 0, 9, 0x5E, 0x04, 0xC4, 0x02, 0x00, 0x01, 1, 2, 3, 1});
    return bytes;
}

std::vector<uint8_t> binary_objects() {
    std::vector<uint8_t> bytes;
    add(bytes, kBinaryObjects, {22, 0, 2});
    add(bytes, kCapability, {2, 0, 0, 0, 0});                 // USB 2.0 extension, without LPM
    add(bytes, kCapability, {3, 0, 0x08, 0x00, 3, 0, 0, 0});  // SuperSpeed alone, latencies of 0: no LPM
    return bytes;
}

std::vector<uint8_t> configuration(uint32_t infrared_bytes_per_interval) {
    std::vector<uint8_t> bytes;
    add(bytes, kConfiguration, {0, 0, 2, 1, 0, 0xC0, 0});  // two interfaces, self-powered
    add_interface(bytes, 0, 0, 4);
    add_endpoint(bytes, 0x02, kBulk, 1024, 0, 1, 0, 0);
    add_endpoint(bytes, 0x81, kBulk, 1024, 0, 1, 0, 0);
    add_endpoint(bytes, 0x82, kInterrupt, 64, 8, 1, 0, 64);
    add_endpoint(bytes, 0x83, kBulk, 1024, 0, 16, 0, 0);
    add_interface(bytes, 1, 0, 0);
    add_interface(bytes, 1, 1, 1);
    // 11 packets at once, three times an interval: 33 KiB.
    add_endpoint(bytes, 0x84, kIsochronous, 1024, 1, 11, 2, infrared_bytes_per_interval);
    bytes[2] = low(static_cast<uint32_t>(bytes.size()));
    bytes[3] = high(static_cast<uint32_t>(bytes.size()));
    return bytes;
}

std::vector<uint8_t> text(uint8_t index) {
    if (index == 0) return {4, kString, 0x09, 0x04};  // English
    const std::string words = index == 1 ? "Patina" : index == 2 ? "Simulated Kinect v2" : "012345678901";
    std::vector<uint8_t> bytes{static_cast<uint8_t>(2 + 2 * words.size()), kString};
    for (const char letter : words) {
        bytes.push_back(static_cast<uint8_t>(letter));
        bytes.push_back(0);
    }
    return bytes;
}

}  // namespace

std::vector<uint8_t> descriptor(uint16_t value, uint32_t infrared_bytes_per_interval) {
    const uint8_t index = low(value);
    switch (high(value)) {
        case kDevice: return device();
        case kConfiguration: return index == 0 ? configuration(infrared_bytes_per_interval) : std::vector<uint8_t>();
        case kString: return index <= 3 ? text(index) : std::vector<uint8_t>();
        case kBinaryObjects: return binary_objects();
        default: return {};
    }
}

}  // namespace patina::sensor::kinect2::testing::usbip
