#pragma once

#include <memory>
#include <vector>

#include <gmock/gmock.h>

#include "patina/session.h"
#include "reconstruction/api/access.h"
#include "tests/gpu/scenes/small_office.h"

namespace patina {

/// Tests of sessions over frames of the small office, on one device that checks every call.
class OfficeSessionTest : public ::testing::Test {
  protected:
    static constexpr uint32_t kFrames = 30;

    static void SetUpTestSuite() {
        device_ = std::make_unique<Device>(DeviceChoice{.validation = true});
        office_ = std::make_unique<SmallOffice>(Access::vulkan(*device_), kFrames);
    }
    static void TearDownTestSuite() {
        office_.reset();
        device_.reset();
    }
    void TearDown() override { EXPECT_THAT(device_->validation_messages(), ::testing::IsEmpty()); }

    /// Coarse, under a lamp that is known. `blocks`: of the voxel map's pool at first.
    static SessionOptions office_options(const char* blocks) {
        SessionOptions options;
        options.lighting = Lighting{.lights = {{{0, -1, 0.5}, glm::dvec3(4)}}};
        options.materials = Materials::kFit;
        for (const auto& [key, value] : {std::pair{"map.voxel_m", "0.02"},
                                         {"fusion.truncation_m", "0.06"},
                                         {"tracking.finest", "0"},
                                         {"map.initial_blocks", blocks},
                                         {"reflectance.voxel_m", "0.08"}})
            options.settings.set(key, value);
        return options;
    }

    static inline std::unique_ptr<Device> device_;
    static inline std::unique_ptr<SmallOffice> office_;
};

}  // namespace patina
