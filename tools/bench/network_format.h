#pragma once

#include <map>
#include <string>

#include "engine/core/error.h"
#include "passes/specular/run_network.h"

namespace patina::bench {

/// What programs call the formats of a network.
inline const std::map<std::string, NetworkFormat> kNetworkFormats{
    {"floats", NetworkFormat::kFloats}, {"texels", NetworkFormat::kTexels}, {"halves", NetworkFormat::kHalves}};

inline std::string name_of(NetworkFormat format) {
    for (const auto& [name, named] : kNetworkFormats) {
        if (named == format) return name;
    }
    PATINA_ASSERT(false, static_cast<int>(format));
    return {};
}

/// The variant of a format's name; of an empty one, the variant that suits the device. Throws Error as
/// network_variant().
inline NetworkVariant named_variant(const vulkan::DeviceCaps& caps, const Network& network, uint32_t capacity,
                                    const std::string& format) {
    return format.empty() ? preferred_network_variant(caps, network, capacity)
                          : network_variant(caps, network, capacity, kNetworkFormats.at(format));
}

}  // namespace patina::bench
