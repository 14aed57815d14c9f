#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <utility>

#include <gmock/gmock.h>

#include "patina/session.h"
#include "reconstruction/api/access.h"
#include "reconstruction/session/session_core.h"
#include "reconstruction/store/map_file.h"
#include "scenes/files/scene_file.h"
#include "tests/export/temporary_folder.h"
#include "tests/gpu/scenes/wall_frame.h"
#include "tests/scenes/small_cubes.h"

// A session that goes on from a map yields what one without a break does.

namespace patina::session_map_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

constexpr uint32_t kFrames = 8;

/// A camera before a wall that becomes brighter.
class BrighterWall : public Source {
  public:
    BrighterWall() {
        info_.name = "wall";
        info_.depth = info_.color = {{64, 48}, 60, 60, 31.5, 23.5};
        info_.has_poses = true;
    }
    const SequenceInfo& info() const override { return info_; }
    std::optional<Reading> next() override {
        if (next_ == kFrames) return std::nullopt;
        const uint32_t index = next_++;
        return wall_frame(info_, index, SrgbPixel(static_cast<uint8_t>(100 + 10 * index)));
    }

  private:
    SequenceInfo info_;
    uint32_t next_ = 0;
};

class SessionMapTest : public ::testing::Test {
  protected:
    static void SetUpTestSuite() { device_ = std::make_unique<Device>(DeviceChoice{.validation = true}); }
    static void TearDownTestSuite() { device_.reset(); }
    void TearDown() override { EXPECT_THAT(device_->validation_messages(), IsEmpty()); }

    /// A built-in scene at a resolution that makes many of its records change in every frame.
    SessionOptions options() const {
        SessionOptions options;
        options.sequence = testing::small_cubes(folder_ / "cubes.json", 0.5);
        options.frames = kFrames;
        options.lighting = Lighting{.lights = scenes::load_scene("cubes").lights};
        for (const auto& [key, value] : {std::pair{"map.voxel_m", "0.02"},
                                         {"map.initial_blocks", "4096"},
                                         {"reflectance.voxel_m", "0.08"},
                                         {"reflectance.initial_blocks", "4096"},
                                         {"reflectance.initial_records", "8192"}})
            options.settings.set(key, value);
        options.map = folder_ / "map.sqlite";
        return options;
    }

    /// All files of the scene; and what the session counted, which later frames would depend on.
    std::string bytes_of(Session& session) const {
        session.finish().save(folder_ / "scene");
        std::string bytes;
        for (const char* name : {"scene.glb", "materials.json", "trajectory.txt"}) {
            std::ifstream file(folder_ / "scene" / name, std::ios::binary);
            bytes.append(std::istreambuf_iterator<char>(file), {});
        }
        SessionCore& core = Access::core(session);
        for (const PoolState& pool : core.pools())
            bytes += text(pool.name, ' ', pool.capacity, ' ', pool.used, ' ', pool.refused, ' ', pool.growths, '\n');
        return bytes + core.gains_text();
    }

    std::string straight(SessionOptions options) {
        options.map.clear();
        Session session(*device_, options);
        while (session.step()) continue;
        return bytes_of(session);
    }

    /// With a break after these frames, in two sessions.
    std::string broken(SessionOptions options, uint32_t frames) {
        std::filesystem::remove(options.map);
        {
            Session session(*device_, options);
            for (uint32_t i = 0; i < frames; ++i) EXPECT_TRUE(session.step());
            session.checkpoint();
            EXPECT_TRUE(session.step());  // what was not kept is done again
        }
        options.resume = true;
        Session session(*device_, options);
        uint32_t steps = 0;
        while (session.step()) ++steps;
        EXPECT_EQ(steps, kFrames - frames);
        return bytes_of(session);
    }

    static inline std::unique_ptr<Device> device_;
    const test::TemporaryFolder folder_;
};

TEST_F(SessionMapTest, GoesOnToTheSameBytes) {
    const std::string whole = straight(options());
    ASSERT_GT(whole.size(), 10000u);
    for (const uint32_t frames : {1u, 6u}) EXPECT_TRUE(broken(options(), frames) == whole) << frames;
}

TEST_F(SessionMapTest, TrackedOnesWithGainsToo) {
    SessionOptions tracked = options();
    tracked.poses = Poses::kTrack;
    tracked.gains = Gains::kOn;
    EXPECT_TRUE(broken(tracked, 4) == straight(tracked));
}

TEST_F(SessionMapTest, ACameraGoesOnToTheSameAmbientLight) {
    SessionOptions camera = options();
    camera.sequence.clear();
    camera.frames = 0;
    camera.lighting = {};
    const auto last_ambient = [](Session& session) {
        while (session.step()) continue;
        return session.lighting().ambient.g;
    };
    Session whole(*device_, std::make_unique<BrighterWall>(), camera);
    {
        Session first(*device_, std::make_unique<BrighterWall>(), camera);
        for (int i = 0; i < 3; ++i) EXPECT_TRUE(first.step());
        first.checkpoint();
        EXPECT_LT(first.lighting().ambient.g, last_ambient(whole)) << "of the first two frames";
    }
    camera.resume = true;
    Session resumed(*device_, std::make_unique<BrighterWall>(), camera);
    EXPECT_EQ(last_ambient(resumed), whole.lighting().ambient.g);
}

TEST_F(SessionMapTest, PoolsThatGrewComeBackAsLarge) {
    SessionOptions small = options();
    for (const char* key : {"map.initial_blocks", "reflectance.initial_blocks", "reflectance.initial_records"})
        small.settings.set(key, "64");
    small.settings.set("segmentation.initial_labels", "2");
    EXPECT_TRUE(broken(small, 1) == straight(small));
}

TEST_F(SessionMapTest, CheckpointsAreWrittenWhenTheyAreDue) {
    SessionOptions every = options();
    every.checkpoint_every = 3;
    const auto progress = [&] { return MapFile(every.map).expect_text("progress"); };
    Session session(*device_, every);
    for (uint32_t i = 0; i < 2; ++i) session.step();
    EXPECT_FALSE(std::filesystem::exists(every.map));
    session.step();
    EXPECT_THAT(progress(), AllOf(HasSubstr("\"read\": 3"), HasSubstr("\"ended\": false")));
    while (session.step()) continue;
    EXPECT_THAT(progress(), AllOf(HasSubstr("\"read\": 8"), HasSubstr("\"ended\": true")));
}

TEST_F(SessionMapTest, WhatHasNotEndedIsNotReplaced) {
    {
        Session session(*device_, options());
        session.step();
        session.checkpoint();
    }
    EXPECT_THAT([&] { Session(*device_, options()); },
                ThrowsMessage<Error>(HasSubstr("has not come to its end, after 1 frames; go on with it, or remove")));
    SessionOptions onwards = options();
    onwards.resume = true;
    onwards.checkpoint_every = kFrames;
    {
        Session session(*device_, onwards);
        while (session.step()) continue;
    }
    Session again(*device_, options());
    again.step();
    again.checkpoint();
    EXPECT_THAT(MapFile(options().map).expect_text("progress"), HasSubstr("\"read\": 1"));
}

TEST_F(SessionMapTest, OtherOptionsAreRefused) {
    {
        Session session(*device_, options());
        session.step();
        session.checkpoint();
    }
    const auto resumed = [&](const std::function<void(SessionOptions&)>& change) {
        SessionOptions other = options();
        other.resume = true;
        change(other);
        Session session(*device_, other);
    };
    EXPECT_THAT([&] { resumed([](SessionOptions& o) { o.settings.set("fusion.max_depth_m", "3"); }); },
                ThrowsMessage<Error>(AllOf(HasSubstr("map.sqlite' was written with settings.fusion.max_depth_m = "),
                                           HasSubstr("now it is 3"))));
    EXPECT_THAT([&] { resumed([](SessionOptions& o) { o.labels = Labels::kOff; }); },
                ThrowsMessage<Error>(HasSubstr("labels = \"geometry\", now it is \"off\"")));
    EXPECT_THAT([&] { resumed([](SessionOptions& o) { o.map = "/nowhere/map.sqlite"; }); },
                ThrowsMessage<Error>(HasSubstr("there is no map '/nowhere/map.sqlite'")));
}

TEST_F(SessionMapTest, ACheckpointThatFailsIsAShortfall) {
    SessionOptions nowhere = options();
    std::ofstream(folder_ / "file") << "no folder";
    nowhere.map = folder_ / "file/map.sqlite";
    nowhere.checkpoint_every = 2;
    Session session(*device_, nowhere);
    while (session.step()) continue;
    EXPECT_THAT(session.shortfalls(), ::testing::Contains(HasSubstr("the state after 8 frames could not be kept: ")));
    EXPECT_GT(session.finish().mesh.triangles.size(), 0u);
}

}  // namespace
}  // namespace patina::session_map_test
