#include "patina/session.h"

#include <gmock/gmock.h>

#include "sensor/pose.h"
#include "tests/export/temporary_folder.h"
#include "tests/gpu/scenes/wall_frame.h"

namespace patina::session_test {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

constexpr uint32_t kFrames = 5;

/// A wall one metre ahead, seen by a camera that says when it ends; its third frame is damaged. Pictures differ, but in
/// `still` ones.
class LiveWall : public Source {
  public:
    explicit LiveWall(bool has_poses = true, bool still = false) : still_(still) {
        info_.name = "wall";
        info_.depth = info_.color = {{64, 48}, 60, 60, 31.5, 23.5};
        info_.has_poses = has_poses;
    }
    const SequenceInfo& info() const override { return info_; }
    std::optional<Reading> next() override {
        const uint32_t index = next_++;
        if (index == kFrames) return std::nullopt;
        if (index == 2) return Skipped{index, "a packet was lost"};
        Frame frame = wall_frame(info_, index, SrgbPixel(128));
        if (!still_) std::get<Image<SrgbPixel>>(frame.color).at(0, 0).r = static_cast<uint8_t>(index);
        return frame;
    }

  private:
    SequenceInfo info_;
    bool still_;
    uint32_t next_ = 0;
};

class SessionTest : public ::testing::Test {
  protected:
    void TearDown() override { EXPECT_THAT(device_.validation_messages(), IsEmpty()); }

    Device device_{DeviceChoice{.validation = true}};
};

TEST_F(SessionTest, ALiveSourceEndsWhenItSaysSo) {
    std::vector<uint32_t> done;
    SessionOptions options;
    options.lighting = NoLights{};
    options.callbacks.progress = [&](const SessionProgress& progress) {
        EXPECT_EQ(progress.task, "frames");
        EXPECT_EQ(progress.total, std::nullopt);
        done.push_back(progress.done);
    };
    Session session(device_, std::make_unique<LiveWall>(), options);
    std::vector<bool> fused;
    while (session.step()) fused.push_back(session.last()->fused);
    EXPECT_THAT(fused, ElementsAre(true, true, false, true, true));
    EXPECT_THAT(done, ElementsAre(1, 2, 3, 4, 5));
    EXPECT_THAT(session.shortfalls(), ElementsAre(HasSubstr("a packet was lost")));
    const Scene scene = session.finish();
    EXPECT_GT(scene.mesh.triangles.size(), 1000u);
    EXPECT_EQ(scene.trajectory.size(), 4u);
    EXPECT_EQ(session.statistics().frames, 4u);
    for (const glm::vec3 position_m : scene.mesh.positions_m) EXPECT_NEAR(position_m.z, 1, 0.003f);
}

TEST_F(SessionTest, FramesThatRepeatAreCountedAndLeftOut) {
    SessionOptions options;
    options.lighting = NoLights{};
    Session session(device_, std::make_unique<LiveWall>(true, true), options);
    std::vector<std::string> reasons;
    while (session.step()) reasons.push_back(session.last()->reason);
    const auto repeats = HasSubstr("its picture and depth are those of frame");
    EXPECT_THAT(reasons, ElementsAre("", repeats, HasSubstr("a packet was lost"), repeats, repeats));
    EXPECT_EQ(session.statistics().frames, 1u);
    EXPECT_EQ(session.finish().trajectory.size(), 1u);
}

TEST_F(SessionTest, TheFrameLimitHoldsForALiveSource) {
    SessionOptions options;
    options.lighting = NoLights{};
    options.frames = 2;
    Session session(device_, std::make_unique<LiveWall>(), options);
    uint32_t steps = 0;
    while (session.step()) ++steps;
    EXPECT_EQ(steps, 2u);
    EXPECT_EQ(session.finish().trajectory.size(), 2u);
}

TEST_F(SessionTest, FramesThatAreHeldOutAreNoPartOfTheModel) {
    SessionOptions options;
    options.lighting = NoLights{};
    options.hold_out = 2;
    Session session(device_, std::make_unique<LiveWall>(), options);
    std::vector<std::string> reasons;
    while (session.step()) reasons.push_back(session.last()->reason);
    EXPECT_THAT(reasons, ElementsAre("", "held out", HasSubstr("a packet was lost"), "held out", ""));
    EXPECT_EQ(session.statistics().frames, 2u);
    EXPECT_EQ(session.finish().trajectory.size(), 2u);
    options.hold_out = 1;
    EXPECT_THAT([&] { Session(device_, std::make_unique<LiveWall>(), options); },
                testing::ThrowsMessage<Error>(HasSubstr("every frame is held out")));
}

TEST_F(SessionTest, GivenLightMakesMaterials) {
    SessionOptions options;
    options.lighting = Lighting{.lights = {{glm::dvec3(0), glm::dvec3(2), 0.05}}};
    Session session(device_, std::make_unique<LiveWall>(), options);
    while (session.step()) continue;
    const Scene scene = session.finish();
    EXPECT_EQ(scene.reflectance.kd.size(), scene.mesh.positions_m.size());
    EXPECT_EQ(session.lighting().lights, scene.lighting.lights);
    EXPECT_EQ(scene.lighting.found_by, "given");
    const PendingView pending = session.view(session.info().color, RigidTransform(1.0));
    session.wait();
    const ModelView view = pending.get();
    ASSERT_TRUE(view.reflectance);
    EXPECT_NEAR(view.position_m.at(32, 24).w, 1, 0.003f);
    // What the camera saw is what the model reflects.
    EXPECT_NEAR(view.reflectance->rgb.at(32, 24).g, 0.2159f, 0.02f);
}

TEST_F(SessionTest, ASceneIsSavedWithAllItsFiles) {
    const test::TemporaryFolder folder;
    SessionOptions options;
    options.lighting =
        Lighting{.lights = {{glm::dvec3(0, 0, 0.25), glm::dvec3(2), 0.0625}}, .ambient = glm::dvec3(0.5)};
    Session session(device_, std::make_unique<LiveWall>(), options);
    while (session.step()) continue;
    const Scene scene = session.finish();
    scene.save(folder / "new/scene");
    const Lighting saved = read_lighting(folder / "new/scene/lights.json");
    EXPECT_EQ(saved.lights, scene.lighting.lights);
    EXPECT_EQ(saved.ambient, scene.lighting.ambient);
    EXPECT_EQ(sensor::read_trajectory(folder / "new/scene/trajectory.txt").size(), 4u);
    EXPECT_TRUE(std::filesystem::exists(folder / "new/scene/materials.json"));
    EXPECT_EQ(test::bytes_of(folder / "new/scene/scene.glb").substr(0, 4), "glTF");
    EXPECT_THAT([&] { scene.save(folder / "new/scene/scene.glb/inside"); },
                ThrowsMessage<Error>(HasSubstr("cannot be made")));
}

TEST_F(SessionTest, WhoeverStopsItKeepsWhatWasFused) {
    bool stop = false;
    SessionOptions options;
    options.lighting = NoLights{};
    options.callbacks.stop = [&] { return stop; };
    Session session(device_, std::make_unique<LiveWall>(), options);
    EXPECT_TRUE(session.step());
    stop = true;
    EXPECT_THROW(session.step(), Interrupted);
    EXPECT_EQ(session.finish().trajectory.size(), 1u);
}

TEST_F(SessionTest, WhatCannotBeMetIsOneSentence) {
    SessionOptions options;
    options.lighting = LightsFromMain{};
    EXPECT_THAT([&] { Session(device_, std::make_unique<LiveWall>(), options); },
                ThrowsMessage<Error>(HasSubstr("a source that is read once")));
    options.lighting = NoLights{};
    options.reflectance_for = "the viewer";
    EXPECT_THAT([&] { Session(device_, std::make_unique<LiveWall>(), options); },
                ThrowsMessage<Error>(HasSubstr("the viewer needs lights: give lights ")));
    options.reflectance_for.clear();
    options.poses = Poses::kPrior;
    EXPECT_THAT([&] { Session(device_, std::make_unique<LiveWall>(false), options); },
                ThrowsMessage<Error>(EndsWith("'wall' has no poses, but tracking was to start from them; track the "
                                              "camera without them")));
    options.hints.track = "the third switch";
    EXPECT_THAT([&] { Session(device_, std::make_unique<LiveWall>(false), options); },
                ThrowsMessage<Error>(EndsWith(" (the third switch)")));
    options.poses = Poses::kAuto;
    Session session(device_, std::make_unique<LiveWall>(), options);
    EXPECT_THAT([&] { session.finish(); }, ThrowsMessage<Error>(HasSubstr("no frame of 'wall' could be used")));
}

}  // namespace
}  // namespace patina::session_test
