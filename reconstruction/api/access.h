#pragma once

#include <string>

#include "engine/vulkan/device.h"
#include "patina/device.h"
#include "patina/reconstruction.h"
#include "patina/session.h"
#include "patina/settings.h"
#include "reconstruction/pipeline.h"

namespace patina {

class SessionCore;

/// What is behind the public types, for the library's own programs, which show more than the public API does.
struct Access {
    static vulkan::DeviceOptions options(const DeviceChoice& choice);
    static Device device(const vulkan::DeviceOptions& options);
    static vulkan::Device& vulkan(Device& device);
    static ReconstructionSettings& values(Settings& settings);
    static const ReconstructionSettings& values(const Settings& settings);
    /// As apply_setting().
    static void assign(Settings& settings, const std::string& assignment, const std::string& where);
    /// Whether Settings::set(), load() or assign() set this key, to whatever value.
    static bool is_given(const Settings& settings, const std::string& key);
    static Pipeline& pipeline(Reconstruction& reconstruction);
    static SessionCore& core(Session& session);
    static PendingView pending(ViewReadback view);
};

}  // namespace patina
