#include "patina/session.h"

#include <utility>

#include "reconstruction/api/access.h"
#include "reconstruction/api/statistics.h"
#include "reconstruction/frame_context.h"
#include "reconstruction/session/session_core.h"
#include "reconstruction/session/shortfalls.h"

namespace patina {

struct Session::State {
    SessionCore core;
};

Session::Session(Device& device, const SessionOptions& options)
    : state_(new State{SessionCore(Access::vulkan(device), options)}) {}

Session::Session(Device& device, std::unique_ptr<Source> source, const SessionOptions& options)
    : state_(new State{SessionCore(Access::vulkan(device), options, std::move(source))}) {}

Session::~Session() = default;

bool Session::step() {
    const bool more = state_->core.step();
    state_->core.checkpoint_if_due();
    return more;
}

void Session::checkpoint() { state_->core.checkpoint(); }
const std::optional<FrameResult>& Session::last() const { return state_->core.last(); }
const SequenceInfo& Session::info() const { return state_->core.info(); }

Lighting Session::lighting() const { return state_->core.lighting(); }

PendingView Session::view(const Intrinsics& camera, const RigidTransform& world_from_camera) {
    check_view(camera, world_from_camera);
    return Access::pending(state_->core.pipeline().view(camera, world_from_camera));
}

void Session::wait() { state_->core.pipeline().wait(); }
Statistics Session::statistics() { return statistics_of(state_->core.pipeline()); }
std::vector<std::string> Session::shortfalls() { return shortfalls_of(state_->core); }

Scene Session::finish() {
    state_->core.expect_frames();
    state_->core.look_for_last_light();
    return state_->core.scene();
}

SessionCore& Access::core(Session& session) { return session.state_->core; }

}  // namespace patina
