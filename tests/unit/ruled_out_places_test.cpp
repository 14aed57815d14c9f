#include "reconstruction/lights/ruled_out_places.h"

#include <gtest/gtest.h>

namespace patina::ruled_out_places_test {
namespace {

/// At (1, 0, 0), looking along +x with y down.
gpu::Camera camera() {
    gpu::Camera camera{};
    const glm::mat4 world_from_camera(0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1);
    camera.camera_from_world = glm::inverse(world_from_camera);
    camera.focal_center_px = {100, 100, 99.5f, 49.5f};
    camera.extent = {200, 100};
    return camera;
}

TEST(RuledOutPlaces, APictureHoldsWhatIsNotAtItsBorder) {
    EXPECT_TRUE(is_in_picture(camera(), {3, 0, 0}));
    EXPECT_TRUE(is_in_picture(camera(), {3, 0, -1.8f}));
    EXPECT_FALSE(is_in_picture(camera(), {3, 0, -1.94f})) << "within 3 % of its width";
    EXPECT_TRUE(is_in_picture(camera(), {3, 0.9f, 0}));
    EXPECT_FALSE(is_in_picture(camera(), {3, -0.97f, 0}));
    EXPECT_FALSE(is_in_picture(camera(), {-1, 0, 0})) << "behind the camera";
}

TEST(RuledOutPlaces, WhoeverCarriesTheCameraStandsBehindIt) {
    EXPECT_TRUE(is_carrier(camera(), {1.3f, 0, 0}));
    EXPECT_FALSE(is_carrier(camera(), {1.5f, 0, 0}));
    EXPECT_TRUE(is_carrier(camera(), {0.5f, 0.3f, -0.2f}));
    EXPECT_FALSE(is_carrier(camera(), {0.5f, 0.3f, -0.3f}));
    EXPECT_TRUE(is_carrier(camera(), {-0.1f, 0, 0}));
    EXPECT_FALSE(is_carrier(camera(), {-0.3f, 0, 0}));
}

}  // namespace
}  // namespace patina::ruled_out_places_test
