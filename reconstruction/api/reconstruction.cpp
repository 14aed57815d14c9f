#include "patina/reconstruction.h"

#include <algorithm>
#include <utility>

#include "reconstruction/api/access.h"
#include "reconstruction/api/statistics.h"
#include "reconstruction/frame_context.h"
#include "reconstruction/pipeline.h"
#include "reconstruction/session/choose_settings.h"

namespace patina {

struct PendingView::State {
    ViewReadback view;
};

PendingView::PendingView(std::unique_ptr<State> state) : state_(std::move(state)) {}
PendingView::PendingView(PendingView&&) noexcept = default;
PendingView& PendingView::operator=(PendingView&&) noexcept = default;
PendingView::~PendingView() = default;

bool PendingView::ready() const { return state_->view.ready(); }
ModelView PendingView::get() const { return state_->view.get(); }

PendingView Access::pending(ViewReadback view) {
    return PendingView(std::make_unique<PendingView::State>(PendingView::State{std::move(view)}));
}

struct Reconstruction::State {
    Pipeline pipeline;
    Lighting lighting;
    std::vector<TimedPose> trajectory;
};

Reconstruction::Reconstruction(Device& device, const ReconstructionOptions& options)
    : state_(new State{Pipeline(Access::vulkan(device), choose_settings(options)), options.lighting, {}}) {
    state_->pipeline.set_lights(options.lighting.lights, options.lighting.ambient);
}

Reconstruction::~Reconstruction() = default;

bool Reconstruction::tracks() const { return state_->pipeline.tracking_report() != nullptr; }

FrameResult Reconstruction::add(const RgbdFrame& frame) {
    FrameResult result{.fused = state_->pipeline.add(frame), .reason = "", .world_from_depth = frame.world_from_depth};
    if (const TrackingReport* report = state_->pipeline.tracking_report()) {
        result.state = report->state;
        result.reason = report->reason;
        result.world_from_depth = report->world_from_depth;
    }
    if (result.fused) state_->trajectory.push_back({frame.time.timestamp_s, result.world_from_depth});
    return result;
}

PendingView Reconstruction::view(const Intrinsics& camera, const RigidTransform& world_from_camera) {
    check_view(camera, world_from_camera);
    return Access::pending(state_->pipeline.view(camera, world_from_camera));
}

void Reconstruction::wait() { state_->pipeline.wait(); }
Statistics Reconstruction::statistics() { return statistics_of(state_->pipeline); }

Scene Reconstruction::finish() {
    Scene scene;
    scene.mesh = state_->pipeline.extract_surface();
    scene.reflectance = state_->pipeline.sample_reflectance(scene.mesh);
    scene.far_field = state_->pipeline.far_field();
    scene.lighting = state_->lighting;
    scene.trajectory = state_->trajectory;
    scene.lighting.windows = state_->pipeline.windows(scene.trajectory, scene.lighting.lights);
    return scene;
}

Pipeline& Access::pipeline(Reconstruction& reconstruction) { return reconstruction.state_->pipeline; }

}  // namespace patina
