#include "tools/render/render.h"

#include <deque>
#include <exception>
#include <vector>

#include <fmt/format.h>

#include "reconstruction/api/access.h"
#include "reconstruction/session/kept_pictures.h"
#include "reconstruction/session/session_core.h"
#include "reconstruction/session/shortfalls.h"
#include "sensor/files/picture_file.h"
#include "sensor/files/text_file.h"
#include "sensor/output/apart.h"
#include "sensor/output/new_folder.h"
#include "sensor/pose.h"
#include "tools/program/console.h"
#include "tools/program/inputs.h"
#include "tools/program/progress.h"
#include "tools/program/standard_streams.h"
#include "tools/render/orbit.h"
#include "tools/render/other_light.h"
#include "tools/report/drawing.h"
#include "tools/report/video.h"
#include "tools/run/frame_dumps.h"

namespace patina::tools {

namespace {

/// The colour camera for pictures of another extent: the vertical field of view stays.
Intrinsics resized(const Intrinsics& camera, Extent2D extent) {
    const double scale = static_cast<double>(extent.height) / camera.extent.height;
    const auto moved = [&](double center, uint32_t from, uint32_t to) {
        return (center + 0.5 - 0.5 * from) * scale + 0.5 * to - 0.5;
    };
    Intrinsics result = camera;
    result.extent = extent;
    result.fx *= scale;
    result.fy *= scale;
    result.cx = moved(camera.cx, camera.extent.width, extent.width);
    result.cy = moved(camera.cy, camera.extent.height, extent.height);
    return result;
}

Drawing draw_view(const ModelView& view, Show show, float exposure) {
    const FrameDump seen = to_dump(view);
    switch (show) {
        case Show::kKd: return draw(seen.shown_kd(), &seen.valid, color_pixel);
        case Show::kNormals: return draw(seen.normal, &seen.valid, normal_pixel);
        case Show::kLabels:
            return draw(seen.label, &seen.valid, [](float label) { return label_pixel(static_cast<uint32_t>(label)); });
        case Show::kRgb: break;
    }
    return draw(seen.shown_rgb(), &seen.valid, [exposure](glm::vec3 linear) { return color_pixel(exposure * linear); });
}

/// What can be told to be wrong before the work starts.
void check(const RenderOptions& options) {
    if (options.out.empty() && options.video.empty())
        throw Error("render needs a place to write to: give --out FOLDER or --video FILE");
    if (options.show == Show::kLabels && options.labels == Labels::kOff)
        throw Error("--show labels needs segments, but --labels is off");
}

/// Where finished pictures go.
class PictureSink {
  public:
    /// A folder that cannot be written to is told at once; a video needs to know its pictures first.
    explicit PictureSink(const RenderOptions& options) : inputs_(inputs_of(options)) {
        if (!options.poses.empty()) inputs_.push_back(options.poses);
        inputs_.insert(inputs_.end(), options.relight.begin(), options.relight.end());
        if (!options.video.empty()) sensor::expect_apart(options.video, inputs_);
        if (!options.out.empty()) folder_.emplace(options.out, inputs_);
    }

    void open_video(const std::filesystem::path& file, Extent2D extent, double fps) {
        video_.emplace(file, extent, fps, inputs_);
    }

    void write(const Drawing& picture) {
        if (folder_) {
            const std::string name = sensor::picture_stem(count_) + ".png";
            sensor::write_bytes(folder_->partial_path() / name, png_of(picture));
        }
        if (video_) video_->write(picture);
        ++count_;
    }

    /// A folder that cannot be put in place costs no video, and a video that is not whole no picture.
    void finish() {
        std::exception_ptr failure;
        try {
            if (folder_) folder_->finish();
        } catch (const std::exception&) {
            failure = std::current_exception();
        }
        if (video_) video_->finish();
        if (failure) std::rethrow_exception(failure);
    }

  private:
    std::vector<std::filesystem::path> inputs_;
    std::optional<sensor::NewFolder> folder_;
    std::optional<VideoWriter> video_;
    uint32_t count_ = 0;
};

/// Of the colour camera, world_from_camera.
std::vector<RigidTransform> colour_camera_poses(const SequenceInfo& info,
                                                const std::vector<RigidTransform>& depth_camera_poses) {
    std::vector<RigidTransform> poses;
    for (const RigidTransform& pose : depth_camera_poses) poses.push_back(pose * rigid_inverse(info.color_from_depth));
    return poses;
}

std::vector<RigidTransform> view_poses(const RenderOptions& options, SessionCore& session,
                                       const std::vector<RigidTransform>& given) {
    if (!given.empty()) return colour_camera_poses(session.info(), given);
    std::vector<RigidTransform> recorded;
    for (const TimedPose& pose : session.poses()) recorded.push_back(pose.world_from_camera);
    recorded = colour_camera_poses(session.info(), recorded);
    if (options.orbit == 0) return recorded;
    const Mesh mesh = session.pipeline().extract_surface();
    if (mesh.positions_m.empty()) throw Error("an orbit needs a surface to go around, but none was reconstructed");
    return orbit_poses(recorded, median_point(mesh.positions_m), options.orbit);
}

void render_views(const RenderOptions& options, SessionCore& session, const Intrinsics& camera,
                  const std::vector<RigidTransform>& poses, PictureSink& sink) {
    Pipeline& pipeline = session.pipeline();
    Progress progress("Rendering", static_cast<uint32_t>(poses.size()), options.quiet);
    std::deque<ViewReadback> owed;
    uint32_t done = 0;
    const auto write_first = [&] {
        sink.write(draw_view(owed.front().get(), options.show, options.exposure));
        owed.pop_front();
        progress.update(++done, "views");
    };
    for (const RigidTransform& pose : poses) {
        session.stop_if_interrupted();
        owed.push_back(pipeline.view(camera, pose));
        while (!owed.empty() && owed.front().ready()) write_first();
    }
    pipeline.wait();
    while (!owed.empty()) write_first();
}

}  // namespace

Outcome render(const RenderOptions& given_options) {
    Console console(given_options.quiet);
    RenderOptions options = given_options;
    options.callbacks = console.callbacks();
    check(options);
    PictureSink sink(options);
    std::vector<RigidTransform> given;
    if (!options.poses.empty()) {
        for (const sensor::StampedPose& pose : sensor::read_trajectory(options.poses))
            given.push_back(pose.world_from_camera);
    }
    const OtherLight other = read_other_light(options.relight, options.relight_turn_deg);
    Device device(options.device);
    SessionCore session(Access::vulkan(device), options);
    for (RigidTransform& pose : given) pose[3] -= glm::dvec4(session.world_offset_m(), 0);
    const Intrinsics& recorded = session.info().color;
    const Intrinsics camera = options.extent ? resized(recorded, *options.extent) : recorded;
    const double fps = options.orbit_seconds > 0 ? options.orbit / options.orbit_seconds : session.info().fps;
    if (!options.video.empty()) sink.open_video(options.video, camera.extent, fps);
    KeptPictures pictures;
    const bool detailed = options.show == Show::kRgb || options.show == Show::kKd;
    while (session.step()) {
        if (const Frame* frame = session.fused(); frame && detailed)
            pictures.add(session.info(), *frame, session.pipeline().frames() - 1);
    }
    session.end();
    console.end();
    const std::vector<RigidTransform> poses = view_poses(options, session, given);
    pictures.show_in(session.pipeline(), session.info());
    if (options.relight.empty())
        session.pipeline().refine_all();
    else
        session.pipeline().relight(relighting_of(other, session));
    render_views(options, session, camera, poses, sink);
    sink.finish();
    Outcome outcome;
    for (std::string& shortfall : shortfalls_of(session)) outcome.fall_short(std::move(shortfall));
    outcome.print(options.quiet);
    if (!options.quiet) print_out("{} views\n", poses.size());
    return outcome;
}

}  // namespace patina::tools
