#include "reconstruction/stages/tracking_stage.h"

#include <algorithm>

#include <glm/gtc/quaternion.hpp>

#include "engine/core/error.h"
#include "shared/tracking/tracking.h"

namespace patina {

namespace {

/// A rotation about the middle of the view by a small angle moves its pixels by about so much of their depth.
constexpr float kLeverShare = 0.4f;

const TrackingSettings& checked(const TrackingSettings& settings) {
    const auto check_range = [](const char* name, double value, double least, double most) {
        if (!(value >= least && value <= most))
            throw Error("tracking.", name, " is ", value, ", it must be ", least, " to ", most);
    };
    check_range("levels", settings.levels, 1, 6);
    check_range("finest", settings.finest, 0, settings.levels - 1);
    check_range("iterations", settings.iterations, 1, 50);
    check_range("finest_iterations", settings.finest_iterations, 1, 50);
    check_range("damping", settings.damping, 0, 1);
    return settings;
}

gpu::TrackState initial_state(const RigidTransform& reference_from_frame, float mean_depth_m, float gain) {
    const glm::dquat q = glm::normalize(glm::quat_cast(glm::dmat3(reference_from_frame)));
    gpu::TrackState state{};
    state.rotation = glm::vec4(q.x, q.y, q.z, q.w);
    state.translation_m = glm::vec4(glm::dvec3(reference_from_frame[3]), 0);
    state.gain = gain;
    state.center_m = mean_depth_m;
    state.lever_m = kLeverShare * mean_depth_m;
    return state;
}

}  // namespace

TrackingStage::TrackingStage(vulkan::Device& device, const TrackingSettings& settings)
    : device_(device), settings_(checked(settings)), pictures_(device), motion_(settings.damping) {}

void TrackingStage::make_reference(const Intrinsics& camera) {
    Intrinsics level = first_level() > 0 ? halved(camera) : camera;
    level.distortion = {};
    if (!reference_.empty() && reference_.front().camera.extent == level.extent) return;
    reference_.clear();
    for (uint32_t i = first_level(); i < settings_.levels; ++i, level = halved(level)) {
        if (level.extent.area() == 0) {
            throw Error("tracking.levels is ", settings_.levels, ", a depth picture of ", camera.extent,
                        " pixels has only ", i);
        }
        reference_.push_back(
            {device_.create_image(
                 {.name = text("tracking reference ", i), .extent = level.extent, .format = vulkan::Format::kRgba32u}),
             level});
    }
    reference_camera_ = camera;
}

void TrackingStage::add_reference(graph::FrameGraph& graph, const RaycastImages& surface,
                                  std::optional<graph::ImageId> color_linear, const PosedCamera& camera) {
    make_reference(camera.intrinsics);
    world_from_reference_ = camera.world_from_camera;
    const TrackModelInputs inputs{surface, color_linear, camera.gpu};
    graph::ImageId pixels = add_pack_model(graph, inputs, graph.import(reference_.front().pixels));
    for (size_t i = 1; i < reference_.size(); ++i) {
        if (first_level() + i > settings_.finest) graph.keep(pixels);
        pixels = add_halve_model(graph, pixels, graph.import(reference_[i].pixels));
    }
    graph.keep(pixels);
}

std::vector<TrackLevel> TrackingStage::add_pyramid(graph::FrameGraph& graph, graph::ImageId depth_m,
                                                   const Intrinsics& camera, const std::optional<TrackColor>& color,
                                                   float max_depth_m) const {
    std::vector<TrackLevel> levels{add_pack_frame(graph, depth_m, camera, color, max_depth_m, first_level() > 0)};
    while (first_level() + levels.size() < settings_.levels) levels.push_back(add_halve_frame(graph, levels.back()));
    return levels;
}

TrackingStage::Search TrackingStage::add_search(graph::FrameGraph& graph, const std::vector<TrackLevel>& pyramid,
                                                const RigidTransform& start) const {
    PATINA_ASSERT(pyramid.size() == reference_.size(), pyramid.size(), reference_.size());
    const gpu::TrackState initial =
        initial_state(rigid_inverse(world_from_reference_) * start, last_.mean_depth_m, last_.gain);
    graph::BufferId state = graph.upload<gpu::TrackState>("tracking.state", std::span(&initial, 1));
    TrackErrors errors = settings_.errors;
    if (!settings_.photometric) errors.shade_sigma = 0;
    for (uint32_t level = settings_.levels; level-- > settings_.finest;) {
        const size_t i = level - first_level();
        const uint32_t coarser = level - settings_.finest;
        const TrackLevel model{graph.import(reference_[i].pixels), reference_[i].camera};
        // Coarser levels have fewer pixels; that all of them have enough is judged in the end.
        const float least_pairs = static_cast<float>(settings_.bounds.least_pairs >> (2 * coarser));
        const uint32_t iterations = coarser == 0 ? settings_.finest_iterations : settings_.iterations;
        for (uint32_t step = 0; step < iterations; ++step) {
            const NormalEquations equations = add_normal_equations(graph, pyramid[i], model, state, errors, coarser);
            state = add_solve_motion(graph, equations, state, settings_.bounds.held_share, least_pairs);
        }
    }
    return {start, world_from_reference_, graph.read_back(state)};
}

TrackingReport TrackingStage::report_of(const Search& search) const {
    const auto state = search.state.as<gpu::TrackState>().front();
    const RigidTransform predicted = rigid_inverse(search.world_from_reference) * search.start;
    TrackingReport report = judge_motion(state, predicted, settings_.bounds);
    report.world_from_depth = report.state == TrackingState::kLost
                                  ? search.start
                                  : orthonormalised(search.world_from_reference * reference_from_frame(state));
    return report;
}

void TrackingStage::accept(const TrackingReport& report, const FrameTime& time, bool jumped) {
    if (report.state == TrackingState::kLost) {
        motion_.note_loss();
        // What searches start with stays.
        const float mean_depth_m = last_.mean_depth_m, gain = last_.gain;
        last_ = report;
        last_.mean_depth_m = mean_depth_m;
        last_.gain = gain;
        return;
    }
    if (jumped || !has_reference()) {
        motion_.jump_to(report.world_from_depth, time);
    } else {
        motion_.note(report.world_from_depth, time);
    }
    last_ = report;
}

std::vector<VoxelMap::PoolBytes> TrackingStage::memory() const {
    uint64_t bytes = 0;
    for (const ReferenceLevel& level : reference_)
        bytes += level.camera.extent.area() * bytes_per_pixel(vulkan::Format::kRgba32u);
    return {{"tracking reference", bytes}, {"tracked frame", pictures_.bytes()}};
}

void TrackingStage::visit(graph::StateVisitor& visitor) {
    visitor.value("tracking.reference_camera", reference_camera_);
    if (reference_camera_ && !has_reference()) make_reference(*reference_camera_);
    for (ReferenceLevel& level : reference_) visitor.image(level.pixels);
    visitor.value("tracking.world_from_reference", world_from_reference_);
    visitor.value("tracking.motion", motion_);
    visitor.value<TrackingFigures>("tracking.last", last_);
    visitor.text("tracking.last_reason", last_.reason);
}

}  // namespace patina
