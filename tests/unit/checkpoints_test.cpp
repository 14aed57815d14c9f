// When the window keeps states of a model, and which of them it goes back to.

#include "tools/viewer/checkpoints.h"

#include <gtest/gtest.h>

#include "engine/store/database.h"

namespace patina::tools::checkpoints_test {
namespace {

/// One frame a second is fused; a state holds `bytes`, and takes `took_s` to keep.
class Scan {
  public:
    void go_on_to(double end_s, double took_s = 0) {
        for (; now_.frame_s < end_s; now_.frame_s += 1, ++now_.frames) {
            if (!checkpoints_.due(now_, now_.frame_s)) continue;
            MapFile& map = checkpoints_.begin();
            map.set_text("second", std::to_string(static_cast<int>(now_.frame_s)));
            checkpoints_.kept(now_, now_.frame_s, took_s);
            kept_.push_back(now_.frame_s);
        }
    }

    /// Goes back; returns the second that the state is of, -1 where there is none. lost_s_ is what was lost.
    int undo() {
        EXPECT_EQ(checkpoints_.can_go_back(now_), checkpoints_.choose(now_) != nullptr);
        MapFile* map = checkpoints_.choose(now_);
        if (!map) return -1;
        const int second = std::stoi(map->expect_text("second"));
        lost_s_ = checkpoints_.went_back(now_);
        now_.frames = static_cast<uint32_t>(second) + 1;  // as many were fused by then
        return second;
    }

    Checkpoints checkpoints_;
    RunMoment now_{0, 1};
    std::vector<double> kept_;
    double lost_s_ = 0;
};

TEST(Checkpoints, AreKeptFromTheFirstFrameOnAtTheFramesOwnPace) {
    Scan scan;
    scan.go_on_to(35);
    EXPECT_EQ(scan.kept_, (std::vector<double>{0, 10, 20, 30}));
    scan.go_on_to(1000);
    EXPECT_EQ(scan.checkpoints_.size(), Checkpoints::kMost);
}

TEST(Checkpoints, NothingIsKeptWhereNothingWasFused) {
    Checkpoints checkpoints;
    EXPECT_FALSE(checkpoints.due({5, 0}, 5));
    checkpoints.begin();
    checkpoints.kept({5, 1}, 5, 0);
    EXPECT_FALSE(checkpoints.due({100, 1}, 100));
    EXPECT_TRUE(checkpoints.due({100, 2}, 100));
}

TEST(Checkpoints, SlowOnesComeSeldom) {
    Scan scan;
    scan.go_on_to(100, 2);  // two seconds are a twentieth of forty
    EXPECT_EQ(scan.kept_, (std::vector<double>{0, 40, 80}));
}

TEST(Checkpoints, UndoGoesBackStepByStep) {
    Scan scan;
    scan.go_on_to(25);
    EXPECT_EQ(scan.undo(), 20);
    EXPECT_EQ(scan.lost_s_, 5);
    EXPECT_EQ(scan.undo(), 10) << "at once: nothing was fused since the first";
    EXPECT_EQ(scan.lost_s_, 10);
    scan.now_.frame_s += 5;  // five more seconds in which the camera is lost
    EXPECT_EQ(scan.undo(), 0);
    EXPECT_EQ(scan.undo(), -1);
}

TEST(Checkpoints, WhatWasScannedSinceAnUndoCanBeUndoneToo) {
    Scan scan;
    scan.go_on_to(15);
    EXPECT_EQ(scan.undo(), 10);
    scan.now_.frame_s += 5;
    scan.now_.frames += 5;
    EXPECT_EQ(scan.undo(), 10);
    EXPECT_EQ(scan.lost_s_, 5) << "without the seconds that the first undo lost";
    scan.now_.frame_s += 1;
    scan.now_.frames += 1;
    EXPECT_EQ(scan.undo(), 0) << "that state is only a second old";
    EXPECT_EQ(scan.lost_s_, 11);
}

TEST(Checkpoints, InPlaceOfADamagedOneTheOneBeforeIsChosen) {
    Scan scan;
    scan.go_on_to(25);
    scan.checkpoints_.give_up(scan.now_);
    EXPECT_EQ(scan.undo(), 10);
    EXPECT_EQ(scan.lost_s_, 15);
}

TEST(Checkpoints, AYoungOneIsPassedOverUnlessItIsTheOnlyOne) {
    Scan scan;
    scan.go_on_to(2);
    scan.now_.frame_s = 1;
    EXPECT_EQ(scan.undo(), 0);
    Scan later;
    later.go_on_to(12);
    later.now_.frame_s = 11;
    EXPECT_EQ(later.undo(), 0);
}

TEST(Checkpoints, AnUndoneStateIsKeptAnewOnlyAfterItsTime) {
    Scan scan;
    scan.go_on_to(15);
    scan.undo();
    scan.kept_.clear();
    scan.go_on_to(40);
    EXPECT_EQ(scan.kept_, (std::vector<double>{25, 35}));
}

TEST(Checkpoints, AFileThatCouldNotBeWrittenIsGivenUp) {
    Checkpoints checkpoints;
    checkpoints.begin().set_text("second", "0");
    EXPECT_FALSE(checkpoints.can_go_back({50, 50}));
    MapFile& map = checkpoints.begin();
    EXPECT_FALSE(map.text("second"));
}

}  // namespace
}  // namespace patina::tools::checkpoints_test
