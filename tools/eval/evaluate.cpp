#include "tools/eval/evaluate.h"

#include <algorithm>
#include <deque>
#include <future>
#include <thread>

#include "engine/core/error.h"
#include "engine/core/expect_path.h"
#include "engine/core/input_file.h"
#include "sensor/truth.h"
#include "tools/eval/exr_planes.h"
#include "tools/eval/finished_run.h"
#include "tools/eval/frame_channels.h"
#include "tools/eval/intervals.h"
#include "tools/eval/lights.h"
#include "tools/eval/measure_frame.h"
#include "tools/eval/metrics.h"
#include "tools/eval/pixel_errors.h"
#include "tools/eval/seen_pixels.h"
#include "tools/eval/segmentation.h"
#include "tools/eval/trajectory.h"

namespace patina::eval {
namespace {

namespace fs = std::filesystem;

constexpr double kPoseLimit_s = 0.02;      // TUM's own limit for its trajectories
constexpr unsigned kMostFramesAtOnce = 8;  // each holds some 40 MB at 512 x 424

/// A frame's two files.
struct FrameFiles {
    uint32_t index = 0;
    fs::path truth;
    fs::path run;
};

std::string range_of(const std::map<uint32_t, fs::path>& frames) {
    return text(frames.size(), " from ", frames.begin()->first, " to ", frames.rbegin()->first);
}

/// Files of two folders that have the same numbers; at least one.
std::vector<FrameFiles> common_frames(const fs::path& truth_folder, const fs::path& run_folder) {
    const auto truth_frames = exr_frames(truth_folder), run_frames = exr_frames(run_folder);
    if (truth_frames.empty()) {
        throw Error(truth_folder.string(), " holds no frames: record the sequence with --truth-every N");
    }
    if (run_frames.empty()) throw Error(run_folder.string(), " holds no frames: run with --dump-every N");
    std::vector<FrameFiles> pairs;
    for (const auto& [index, file] : truth_frames) {
        if (const auto found = run_frames.find(index); found != run_frames.end()) {
            pairs.push_back({index, file, found->second});
        }
    }
    if (pairs.empty()) {
        throw Error(truth_folder.string(), " (", range_of(truth_frames), ") and ", run_folder.string(), " (",
                    range_of(run_frames), ") have no frame in common");
    }
    return pairs;
}

std::vector<uint32_t> indices_of(std::span<const FrameFiles> pairs) {
    std::vector<uint32_t> indices;
    for (const FrameFiles& pair : pairs) indices.push_back(pair.index);
    return indices;
}

std::map<uint32_t, fs::path> truth_files(std::span<const FrameFiles> pairs) {
    std::map<uint32_t, fs::path> files;
    for (const FrameFiles& pair : pairs) files.emplace(pair.index, pair.truth);
    return files;
}

/// The poses that sequence and run have in common, compared where they are enough; empty where one of them has none.
std::vector<PosePair> read_poses(const fs::path& sequence, const fs::path& run, Evaluation& result) {
    const fs::path truth_file = sequence / "truth" / "trajectory.txt", run_file = run / "trajectory.txt";
    if (!path_exists(truth_file) || !path_exists(run_file)) {
        result.no_trajectory = "truth and run do not both have one";
        return {};
    }
    const std::vector<sensor::StampedPose> truth = sensor::read_trajectory(truth_file);
    const std::vector<sensor::StampedPose> of_run = sensor::read_trajectory(run_file);
    std::vector<PosePair> pairs = pair_poses(truth, of_run, kPoseLimit_s);
    if (pairs.empty()) {
        throw Error(run_file.string(), " has no pose within ", kPoseLimit_s, " s of one of ", truth_file.string());
    }
    if (pairs.size() < kFewestPoses) {
        result.no_trajectory = text(run_file.string(), " and ", truth_file.string(), " have ", pairs.size(),
                                    " poses in common, and ", kFewestPoses, " are needed");
    } else {
        result.trajectory = trajectory_errors(pairs, truth.size(), of_run.size());
    }
    return pairs;
}

void measure_lights(const fs::path& sequence, const fs::path& run, const RigidTransform& truth_from_run,
                    double radius_m, Evaluation& result) {
    const fs::path truth_file = sequence / "truth" / "lights.json", run_file = run / "lights.json";
    if (!path_exists(truth_file) || !path_exists(run_file)) return;
    std::vector<Light> lights = sensor::read_lights(run_file);
    for (Light& light : lights) light = moved(light, truth_from_run);
    const std::vector<Light> truth = sensor::read_lights(truth_file);
    // Where the truth has lamps, it has no suns: what is far from all of them is one.
    std::erase_if(lights, [&](const Light& light) {
        return !truth.empty() && std::ranges::all_of(truth, [&](const Light& lamp) {
            return glm::distance(lamp.position_m, light.position_m) > kSunsFrom_m / 2;
        });
    });
    result.lights = compare_lights(truth, lights, radius_m);
}

/// Everything that all frames are measured with.
struct Reference {
    std::string run_id;  ///< of run.json; empty where it has none
    Extent2D extent;
    std::set<std::string> groups;
    std::string file;                               ///< the run's first frame, which the above come from
    std::map<uint32_t, glm::dmat3> truth_from_run;  ///< rotations of the frames that have poses
    std::optional<SeenPixels> seen;                 ///< empty where every pixel counts as seen
};

Reference reference_of(const FrameFiles& first, std::span<const PosePair> poses, std::string run_id) {
    const ExrPlanes frame = ExrPlanes::read(first.run);
    Reference reference{std::move(run_id), frame.extent(), groups_of(frame), frame.file(), {}, {}};
    if (!reference.groups.contains("valid")) throw Error(frame.file(), " has no channel valid");
    // truth/trajectory.txt has one line per frame of the sequence, so that a pose's index is its frame's.
    for (const PosePair& pair : poses) {
        reference.truth_from_run[static_cast<uint32_t>(pair.index)] =
            glm::dmat3(pair.truth) * glm::transpose(glm::dmat3(pair.run));
    }
    return reference;
}

/// Pictures of another run stay where a run was killed, or where files were copied together.
void expect_run(const ExrPlanes& frame, const std::string& run_id) {
    if (frame.run_id() == run_id) return;
    const auto named = [](const std::string& id) { return id.empty() ? "of a run without an id" : "of run " + id; };
    throw Error(frame.file(), " is ", named(frame.run_id()), ", but its run.json is ", named(run_id));
}

FrameMeasurement measure(const FrameFiles& pair, const Reference& reference) {
    const ExrPlanes truth = ExrPlanes::read(pair.truth), run = ExrPlanes::read(pair.run);
    for (const ExrPlanes* frame : {&truth, &run}) {
        if (frame->extent() == reference.extent) continue;
        throw Error(frame->file(), " is ", frame->extent(), " pixels, but ", reference.file, " is ", reference.extent);
    }
    expect_groups(run, reference.groups, reference.file);
    expect_run(run, reference.run_id);
    const auto rotation = reference.truth_from_run.find(pair.index);
    return measure_frame(pair.index, truth, run,
                         reference.seen ? reference.seen->mask(pair.index, truth) : Image<uint8_t>(),
                         rotation == reference.truth_from_run.end() ? glm::dmat3(1) : rotation->second);
}

/// Gathers what frames contribute; they must come in order, so that sums do not depend on threads.
class Totals {
  public:
    void add(FrameMeasurement frame) {
        for (auto& [id, object] : frame.objects) {
            ObjectResult& total = objects_[id];
            total.pixels += object.pixels;
            total.seen_pixels += object.seen_pixels;
            for (const Quantity quantity : kQuantities) {
                if (!object.points[quantity]) continue;
                if (!total.quantities[quantity]) total.quantities[quantity].emplace();
                total.quantities[quantity]->frames.push_back(*object.points[quantity]);
            }
        }
        overlap_.add(frame.overlap);
        truth_pixels_ += frame.truth_pixels;
        for (const float error : frame.depth_errors_mm) depth_mm_.add(error);
        for (const float error : frame.normal_errors_deg) normal_deg_.add(error);
    }

    /// Moves what was gathered into the result.
    void finish(bool has_labels, Evaluation& result) {
        result.depth_mm = depth_mm_.spread(truth_pixels_);
        result.normal_deg = normal_deg_.spread(truth_pixels_);
        std::vector<ObjectSegmentation> segmentations;
        PerQuantity<std::vector<Averages>> means;
        uint64_t pixels = 0, seen = 0;
        for (auto& [id, object] : objects_) {
            pixels += object.pixels;
            seen += object.seen_pixels;
            object.id = id;
            object.name = text("object ", id);
            if (has_labels) segmentations.push_back(*(object.segmentation = overlap_.segmentation_of(id)));
            for (const Quantity quantity : kQuantities) {
                auto& series = object.quantities[quantity];
                if (!series) continue;
                static_cast<Averages&>(*series) = averages_of(series->frames);
                means[quantity].push_back(*series);
            }
            result.objects.push_back(std::move(object));
        }
        if (pixels > 0) result.seen_share = static_cast<double>(seen) / static_cast<double>(pixels);
        if (!segmentations.empty()) result.segmentation = mean_of(segmentations);
        for (const Quantity quantity : kQuantities) {
            if (!means[quantity].empty()) result.object_means[quantity] = mean_of(means[quantity]);
        }
    }

  private:
    std::map<uint32_t, ObjectResult> objects_;
    LabelOverlap overlap_;
    uint64_t truth_pixels_ = 0;
    PixelErrorSum depth_mm_;
    PixelErrorSum normal_deg_;
};

void measure_frames(std::span<const FrameFiles> pairs, const Reference& reference, const Settings& settings,
                    Totals& totals) {
    const size_t at_once = std::clamp(std::thread::hardware_concurrency(), 1u, kMostFramesAtOnce);
    std::deque<std::future<FrameMeasurement>> pending;
    size_t started = 0;
    for (size_t done = 0; done < pairs.size(); ++done) {
        for (; started < std::min(pairs.size(), done + at_once); ++started) {
            pending.push_back(std::async(std::launch::async, measure, std::cref(pairs[started]), std::cref(reference)));
        }
        totals.add(pending.front().get());
        pending.pop_front();
        if (settings.on_frame) settings.on_frame(done + 1, pairs.size());
    }
}

void name_objects(const fs::path& materials_file, std::vector<ObjectResult>& objects) {
    if (!path_exists(materials_file)) return;
    for (const sensor::Material& material : sensor::read_materials(materials_file)) {
        const auto object = std::find_if(objects.begin(), objects.end(),
                                         [&](const ObjectResult& each) { return each.id == material.id; });
        if (object != objects.end()) object->name = material.name;
    }
}

}  // namespace

Views evaluate_views(const fs::path& sequence, const fs::path& pictures, const glm::dmat3& truth_from_run) {
    const std::vector<FrameFiles> pairs = common_frames(sequence / "truth" / "frames", pictures);
    const ExrPlanes first = ExrPlanes::read(pairs.front().run);
    Reference reference = reference_of(pairs.front(), {}, first.run_id());
    for (const FrameFiles& pair : pairs) reference.truth_from_run[pair.index] = truth_from_run;
    Totals totals;
    measure_frames(pairs, reference, {}, totals);
    Evaluation result;
    totals.finish(reference.groups.contains("label"), result);
    name_objects(sequence / "truth" / "materials.json", result.objects);
    return {indices_of(pairs), std::move(result.objects), result.object_means, result.depth_mm, result.normal_deg};
}

RigidTransform world_of_run(const fs::path& sequence, const fs::path& run) {
    Evaluation unused;
    const std::vector<PosePair> poses = read_poses(sequence, run, unused);
    return poses.empty() ? RigidTransform(1.0) : align_worlds(poses);
}

Evaluation evaluate(const fs::path& sequence, const fs::path& run, const Settings& settings) {
    expect_folder(sequence);
    expect_folder(run);
    Evaluation result;
    result.sequence = sequence.string();
    result.run = run.string();
    const fs::path truth_folder = sequence / "truth" / "frames", run_folder = run / "frames";
    const std::vector<FrameFiles> pairs = common_frames(truth_folder, run_folder);
    result.frames = indices_of(pairs);
    result.truth_frames = exr_frames(truth_folder).size();
    result.run_frames = exr_frames(run_folder).size();
    const std::string run_id = id_of_finished_run(run);
    const std::vector<PosePair> poses = read_poses(sequence, run, result);
    result.states = read_frame_states(run);
    measure_lights(sequence, run, poses.empty() ? RigidTransform(1.0) : align_worlds(poses), settings.light_radius_m,
                   result);
    Reference reference = reference_of(pairs.front(), poses, run_id);
    result.extent = reference.extent;
    result.seen_frames = settings.seen_frames;
    if (settings.seen_frames > 1) reference.seen.emplace(sequence, truth_files(pairs), settings.seen_frames);
    Totals totals;
    measure_frames(pairs, reference, settings, totals);
    totals.finish(reference.groups.contains("label"), result);
    name_objects(sequence / "truth" / "materials.json", result.objects);
    compare_intervals(sequence, run, result.objects);
    result.intervals = count_intervals(result.objects);
    return result;
}

}  // namespace patina::eval
