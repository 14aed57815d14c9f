#include <filesystem>
#include <memory>
#include <numeric>
#include <vector>

#include <gmock/gmock.h>

#include "engine/store/temporary_database.h"
#include "reconstruction/session/session_core.h"
#include "tests/gpu/reconstruction/office_session.h"

// A session that goes back to a model that it kept: what was fused since is as if it had never been.

namespace patina::session_undo_test {
namespace {

using ::testing::HasSubstr;

class SessionUndoTest : public OfficeSessionTest {
  protected:
    // The pool grows, and is small again afterwards.
    static SessionOptions options() { return office_options("64"); }

    static std::unique_ptr<Session> session_of(const std::vector<uint32_t>& indices, bool with_poses) {
        return std::make_unique<Session>(*device_, std::make_unique<ChosenFrames>(*office_, indices, with_poses),
                                         options());
    }

    static void step(Session& session, uint32_t count) {
        for (uint32_t i = 0; i < count; ++i) ASSERT_TRUE(session.step());
    }

    MapFile kept_{temporary_database("patina-test")};
};

TEST_F(SessionUndoTest, TheSceneIsThatOfTheFramesThatWereNotUndone) {
    const auto expected = session_of({0, 1, 2, 3, 7, 8, 9, 10}, true);
    step(*expected, 8);
    const auto session = session_of(from_to(0, 10), true);
    SessionCore& core = Access::core(*session);
    step(*session, 4);
    core.keep_model(kept_);
    step(*session, 3);
    core.go_back(kept_);
    EXPECT_EQ(core.fused(), nullptr);
    EXPECT_EQ(core.pipeline().frames(), 4u);
    EXPECT_EQ(core.ledger().used(), 4u);
    EXPECT_EQ(core.ledger().undone(), 3u);
    step(*session, 4);
    EXPECT_FALSE(session->step());
    core.end();  // the ledger adds up

    const Scene is = session->finish(), should = expected->finish();
    ASSERT_GT(should.mesh.positions_m.size(), 1000u);
    EXPECT_TRUE(is.mesh.positions_m == should.mesh.positions_m);
    EXPECT_TRUE(is.mesh.triangles == should.mesh.triangles);
    EXPECT_TRUE(is.reflectance.kd == should.reflectance.kd);
    EXPECT_EQ(is.trajectory.size(), 8u);
    EXPECT_EQ(is.trajectory[4].timestamp_s, office_->frames[7].timestamp_s);
}

TEST_F(SessionUndoTest, ATrackedCameraIsFoundInTheModelAsItWas) {
    const RigidTransform world_from_first = *office_->frames[0].world_from_camera;
    std::vector<uint32_t> way = from_to(0, 20);
    const std::vector<uint32_t> back = from_to(8, 14);
    way.insert(way.end(), back.begin(), back.end());
    const auto session = session_of(way, false);
    SessionCore& core = Access::core(*session);
    step(*session, 12);
    core.keep_model(kept_);
    step(*session, 9);
    ASSERT_TRUE(session->last()->fused);
    core.go_back(kept_);
    EXPECT_EQ(core.pipeline().frames(), 12u);
    for (const uint32_t i : back) {
        ASSERT_TRUE(session->step());
        ASSERT_TRUE(session->last()->fused) << i << ": " << session->last()->reason;
        const PoseError error = pose_error(world_from_first * session->last()->world_from_depth, office_->frames[i]);
        EXPECT_LT(error.translation_m, 0.03) << i;
        EXPECT_LT(error.rotation_degrees, 1) << i;
    }
    EXPECT_EQ(core.pipeline().frames(), 19u);
}

TEST_F(SessionUndoTest, WhatTheModelDoesNotShowAnyMoreIsLost) {
    std::vector<uint32_t> way = from_to(0, 29);
    const auto session = session_of(way, false);
    SessionCore& core = Access::core(*session);
    step(*session, 6);
    core.keep_model(kept_);
    step(*session, 20);
    core.go_back(kept_);
    step(*session, 2);
    EXPECT_FALSE(session->last()->fused);
    EXPECT_THAT(session->last()->reason, HasSubstr("no keyframe of the map"));
}

TEST_F(SessionUndoTest, KeepingAModelChangesNothing) {
    const auto expected = session_of(from_to(0, 7), false), session = session_of(from_to(0, 7), false);
    for (uint32_t i = 0; i < 8; ++i) {
        step(*expected, 1);
        step(*session, 1);
        Access::core(*session).keep_model(kept_);
    }
    EXPECT_TRUE(session->finish().mesh.positions_m == expected->finish().mesh.positions_m);
}

TEST_F(SessionUndoTest, ADamagedFileIsRefusedBeforeAnythingChanges) {
    const auto session = session_of(from_to(0, 5), true);
    SessionCore& core = Access::core(*session);
    step(*session, 2);
    core.keep_model(kept_);
    step(*session, 2);
    kept_.database().run("UPDATE pieces SET zstd = zeroblob(20) WHERE array = 'map.tsdf'");
    EXPECT_THROW(core.go_back(kept_), Error);
    EXPECT_EQ(core.pipeline().frames(), 4u);
    step(*session, 2);
    EXPECT_EQ(core.ledger().undone(), 0u);
    EXPECT_GT(session->finish().mesh.positions_m.size(), 1000u);
}

}  // namespace
}  // namespace patina::session_undo_test
