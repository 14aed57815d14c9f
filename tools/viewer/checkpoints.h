#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>

#include "reconstruction/store/map_file.h"

namespace patina::tools {

/// Where a run is: by its frames' own clock, and by how many are in its model.
struct RunMoment {
    double frame_s = 0;   ///< timestamp of the last frame that was fused
    uint32_t frames = 0;  ///< Pipeline::frames()
};

/// Earlier states of a model, to go back to. They lie in temporary files, compressed, and go with the process.
///
/// When: after the first frame that is fused, then every kEvery_s of the frames' own time. A state that took long to
/// keep delays the next one, so that keeping takes kShare of the time at most.
/// How many: kMost, and fewer where all would be more than kMostBytes; the oldest go.
class Checkpoints {
  public:
    static constexpr double kEvery_s = 10;
    static constexpr double kShare = 0.05;
    static constexpr size_t kMost = 6;
    static constexpr uint64_t kMostBytes = uint64_t{4} << 30;
    /// Who goes back wants to lose something: a state that is younger than this is passed over.
    static constexpr double kYoung_s = 2;

    /// Whether a state is to be kept. `now_s`: of a clock that always goes on.
    bool due(const RunMoment& moment, double now_s) const;

    /// The file for the next state; that of the oldest, where there are enough: only what changed is written then.
    /// Throws Error where none can be created.
    MapFile& begin();
    /// The state is in it. Without this call the file is given up by the next begin(). `took_s`: to keep it.
    void kept(const RunMoment& moment, double now_s, double took_s);

    /// Whether there is a state to go back to.
    bool can_go_back(const RunMoment& moment) const { return chosen(moment).has_value(); }
    /// The state to go back to: the newest that is not young, else the oldest. A state that the model still is, as it
    /// was gone back to and nothing was fused since, does not count. Null where there is none.
    MapFile* choose(const RunMoment& moment);
    /// The model is that of choose() now. Younger states are given up. `moment`: when it was asked for. Returns how
    /// many seconds were lost with that, without those that were lost before.
    double went_back(const RunMoment& moment);
    /// The file of choose() is damaged; there are only the others.
    void give_up(const RunMoment& moment);

    size_t size() const { return states_.size(); }
    uint64_t bytes() const;

  private:
    struct State {
        std::unique_ptr<MapFile> map;
        RunMoment moment;
        double since_s = 0;    ///< the frames' time when the model was last this
        double scanned_s = 0;  ///< when it was kept
        uint64_t bytes = 0;
    };
    std::optional<size_t> chosen(const RunMoment& moment) const;
    /// The frames' time without what was lost.
    double scanned_s(const RunMoment& moment) const { return moment.frame_s - lost_s_; }

    std::deque<State> states_;  ///< the oldest first
    std::unique_ptr<MapFile> next_;
    double not_before_s_ = 0;
    double lost_s_ = 0;  ///< by going back, in all
};

}  // namespace patina::tools
