#include "tools/render/finished_views.h"

#include <deque>
#include <vector>

#include <fmt/format.h>

#include "engine/core/error.h"
#include "export/write_exr.h"
#include "reconstruction/api/access.h"
#include "reconstruction/session/kept_pictures.h"
#include "reconstruction/session/session_core.h"
#include "reconstruction/session/session_lights.h"
#include "sensor/truth.h"
#include "tools/run/frame_dumps.h"

namespace patina::tools {

namespace {

namespace fs = std::filesystem;

struct View {
    uint32_t number;
    RigidTransform world_from_color;  ///< in the session's world
};

/// Of all poses that are known of a sequence.
std::vector<View> views_of(const fs::path& sequence, const RigidTransform& session_from_truth,
                           const SequenceInfo& info) {
    std::vector<View> views;
    for (const sensor::StampedPose& pose : sensor::read_trajectory(sequence / "truth" / "trajectory.txt"))
        views.push_back({static_cast<uint32_t>(views.size()),
                         session_from_truth * pose.world_from_camera * rigid_inverse(info.color_from_depth)});
    return views;
}

std::vector<View> views_of_frames(const std::vector<uint32_t>& frames, const fs::path& sequence,
                                  const RigidTransform& session_from_truth, const SequenceInfo& info) {
    if (frames.empty()) return {};
    const std::vector<View> all = views_of(sequence, session_from_truth, info);
    std::vector<View> views;
    for (const uint32_t frame : frames) {
        if (frame >= all.size())
            throw Error("'", (sequence / "truth" / "trajectory.txt").string(), "' has ", all.size(),
                        " poses, none for frame ", frame);
        views.push_back(all[frame]);
    }
    return views;
}

void write_views(SessionCore& session, const std::vector<View>& views, const std::string& folder, OutputFolder& out,
                 const std::function<void()>& on_view) {
    std::deque<ViewReadback> owed;
    size_t done = 0;
    const auto write_first = [&] {
        const std::string name = fmt::format("{}/{:06}.exr", folder, views[done++].number);
        write_exr(out.stage(name), channels_of(to_dump(owed.front().get())));
        out.publish(name);
        owed.pop_front();
        on_view();
    };
    for (const View& view : views) {
        session.stop_if_interrupted();
        owed.push_back(session.pipeline().view(session.info().color, view.world_from_color));
        while (!owed.empty() && owed.front().ready()) write_first();
    }
    session.pipeline().wait();
    while (!owed.empty()) write_first();
}

}  // namespace

void render_finished_views(const SequenceOptions& run, const FinishedViews& views, const RigidTransform& truth_from_run,
                           OutputFolder& out, const std::function<void(uint32_t done, uint32_t total)>& on_view) {
    Device device(run.device);
    SessionCore session(Access::vulkan(device), run);
    if (session.step())
        throw Error("'", run.map.string(), "' holds a run that has not come to its end, after ",
                    session.ledger().read() - 1, " frames");
    session.end();
    KeptPictures pictures;
    session.bring_back([&](graph::StateVisitor& visitor, MapFile&) { pictures.visit(visitor); });
    RigidTransform session_from_truth = rigid_inverse(truth_from_run);
    session_from_truth[3] -= glm::dvec4(session.world_offset_m(), 0);
    pictures.show_in(session.pipeline(), session.info());
    session.pipeline().refine_all();
    const fs::path truth = views.sequence / "truth";
    const std::vector<View> recorded =
        views_of_frames(views.recorded, views.sequence, session_from_truth, session.info());
    std::vector<View> novel, relit;
    if (views.never_recorded) novel = views_of(truth / "novel", session_from_truth, session.info());
    if (views.never_recorded) relit = views_of(truth / "relit", session_from_truth, session.info());
    uint32_t done = 0;
    const auto total = static_cast<uint32_t>(recorded.size() + novel.size() + relit.size());
    const auto count = [&] { on_view(++done, total); };
    write_views(session, recorded, "finished", out, count);
    write_views(session, novel, "novel", out, count);
    if (relit.empty()) return;

    std::vector<Light> lights = sensor::read_lights(truth / "relit" / "truth" / "lights.json");
    for (Light& light : lights) light = moved(light, session_from_truth);
    session.pipeline().relight({.lights = lights, .far_field = {}});
    write_views(session, relit, "relit", out, count);
}

}  // namespace patina::tools
