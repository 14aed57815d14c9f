#pragma once

#include <cstdint>

#include "engine/vulkan/device.h"
#include "passes/state/observation_map.h"
#include "passes/state/voxel_map.h"

namespace patina {

/// Through which descriptors shaders read the map.
enum class MapAccess : uint8_t {
    kStorage,  ///< storage buffers: every device
    kTexel,    ///< texel buffers: 1.5 to 2 times as fast on software devices, where their size allows
};

/// The faster way on this device that its limits allow for this map.
MapAccess preferred_map_access(const vulkan::DeviceCaps& caps, const VoxelMap& map);
MapAccess preferred_map_access(const vulkan::DeviceCaps& caps, const ObservationMap& map);

}  // namespace patina
