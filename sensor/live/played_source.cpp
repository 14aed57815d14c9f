#include "sensor/live/played_source.h"

#include <utility>

#include "sensor/prefetch.h"

namespace patina::sensor {

namespace {

/// Decoded ahead, so that one frame that takes longer to decode does not come late.
constexpr size_t kDecodedAhead = 8;

}  // namespace

PlayedSource::PlayedSource(std::unique_ptr<Source> recording, ReadingTap tap)
    : recording_(std::make_unique<PrefetchSource>(std::move(recording), kDecodedAhead)),
      info_(recording_->info()),
      player_([this] { return recording_->next(); }) {
    info_.frames.reset();
    player_.set_tap(std::move(tap));
}

}  // namespace patina::sensor
