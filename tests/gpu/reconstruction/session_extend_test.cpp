#include <filesystem>
#include <functional>
#include <memory>
#include <utility>

#include <gmock/gmock.h>

#include "reconstruction/session/session_core.h"
#include "tests/export/temporary_folder.h"
#include "tests/gpu/reconstruction/office_session.h"

// A session that begins from the map of another one.

namespace patina::session_extend_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class SessionExtendTest : public OfficeSessionTest {
  protected:
    static SessionOptions options() { return office_options("16384"); }

    SessionOptions extending(const std::filesystem::path& map) const {
        SessionOptions further = options();
        further.lighting = LightsBeside{};  // the map has lights
        further.extends = map;
        return further;
    }

    /// Of frames `begin` to `end` - 1.
    std::unique_ptr<Session> session_of(const SessionOptions& options, uint32_t begin, uint32_t end, bool with_poses) {
        auto frames = std::make_unique<ChosenFrames>(*office_, from_to(begin, end - 1), with_poses);
        return std::make_unique<Session>(*device_, std::move(frames), options);
    }

    /// A map of the same.
    std::filesystem::path map_of(uint32_t begin, uint32_t end, bool with_poses) {
        SessionOptions mapped = options();
        mapped.map = folder_ / "map.sqlite";
        const auto session = session_of(mapped, begin, end, with_poses);
        while (session->step()) continue;
        session->checkpoint();
        return mapped.map;
    }

    const test::TemporaryFolder folder_;
};

TEST_F(SessionExtendTest, TwoRecordingsGiveTheSceneOfOne) {
    const auto whole = session_of(options(), 0, 8, true);
    while (whole->step()) continue;
    const Scene expected = whole->finish();

    const auto second = session_of(extending(map_of(0, 5, true)), 5, 8, true);
    while (second->step()) continue;
    const Scene scene = second->finish();
    ASSERT_GT(expected.mesh.positions_m.size(), 1000u);
    EXPECT_TRUE(scene.mesh.positions_m == expected.mesh.positions_m);
    EXPECT_TRUE(scene.mesh.triangles == expected.mesh.triangles);
    EXPECT_TRUE(scene.reflectance.kd == expected.reflectance.kd);
    EXPECT_EQ(scene.trajectory.size(), 3u) << "its own frames";
    ASSERT_EQ(scene.lighting.lights.size(), 1u);
    EXPECT_EQ(scene.lighting.lights[0].position_m, glm::dvec3(0, -1, 0.5));
}

TEST_F(SessionExtendTest, ACameraIsFoundInTheMapAndTrackedFromThere) {
    const auto map = map_of(0, 12, false);
    // Tracked in the first session, too, whose first frame has its world in it.
    const RigidTransform world_from_first = *office_->frames[0].world_from_camera;
    const auto second = session_of(extending(map), 6, 16, false);
    for (uint32_t i = 6; second->step(); ++i) {
        ASSERT_TRUE(second->last()->fused) << i << ": " << second->last()->reason;
        const PoseError error = pose_error(world_from_first * second->last()->world_from_depth, office_->frames[i]);
        EXPECT_LT(error.translation_m, 0.03) << i;
        EXPECT_LT(error.rotation_degrees, 1) << i;
    }
    EXPECT_EQ(Access::core(*second).pipeline().frames(), 22u);
}

TEST_F(SessionExtendTest, WhatTheMapDoesNotShowIsLostUntilItDoes) {
    const auto map = map_of(0, 6, false);
    const auto elsewhere = session_of(extending(map), 26, 29, false);
    while (elsewhere->step()) {
        EXPECT_FALSE(elsewhere->last()->fused);
        EXPECT_THAT(elsewhere->last()->reason, HasSubstr("no keyframe of the map"));
    }
    EXPECT_THAT([&] { elsewhere->finish(); }, ThrowsMessage<Error>(HasSubstr("no keyframe of the map")));
}

TEST_F(SessionExtendTest, AModelOfOtherSettingsIsRefused) {
    const auto map = map_of(0, 2, true);
    const auto extended = [&](const std::function<void(SessionOptions&)>& change) {
        SessionOptions further = extending(map);
        change(further);
        session_of(further, 2, 4, true);
    };
    EXPECT_NO_THROW(extended([](SessionOptions& o) { o.hold_out = 2; }));
    EXPECT_THAT([&] { extended([](SessionOptions& o) { o.settings.set("fusion.max_depth_m", "3"); }); },
                ThrowsMessage<Error>(AllOf(HasSubstr("map.sqlite' was written with settings.fusion.max_depth_m = "),
                                           HasSubstr("now it is 3"))));
    EXPECT_THAT([&] { extended([](SessionOptions& o) { o.extends = "/nowhere/map.sqlite"; }); },
                ThrowsMessage<Error>(HasSubstr("there is no map '/nowhere/map.sqlite'")));
}

TEST_F(SessionExtendTest, GoesOnAfterABreakItself) {
    SessionOptions further = extending(map_of(0, 4, true));
    const auto finished = [](Session& session) {
        while (session.step()) continue;
        return session.finish();
    };
    const Scene whole = finished(*session_of(further, 4, 8, true));
    further.map = folder_ / "further.sqlite";
    {
        const auto broken = session_of(further, 4, 8, true);
        broken->step();
        broken->checkpoint();
    }
    further.resume = true;
    const Scene scene = finished(*session_of(further, 4, 8, true));
    EXPECT_TRUE(scene.mesh.positions_m == whole.mesh.positions_m);
    EXPECT_TRUE(scene.reflectance.kd == whole.reflectance.kd);
    EXPECT_EQ(scene.trajectory.size(), 4u);
}

}  // namespace
}  // namespace patina::session_extend_test
