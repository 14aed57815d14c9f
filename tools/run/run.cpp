#include "tools/run/run.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <functional>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "engine/core/expect_path.h"
#include "engine/core/input_file.h"
#include "engine/core/printable.h"
#include "engine/core/version.h"
#include "engine/graph/plan/plan.h"
#include "export/trajectory.h"
#include "reconstruction/api/access.h"
#include "reconstruction/session/kept_pictures.h"
#include "reconstruction/session/session_core.h"
#include "reconstruction/session/shortfalls.h"
#include "sensor/files/text_file.h"
#include "sensor/output/apart.h"
#include "sensor/output/output_file.h"
#include "tools/program/console.h"
#include "tools/program/inputs.h"
#include "tools/program/lights_text.h"
#include "tools/program/standard_streams.h"
#include "tools/report/report.h"
#include "tools/report/run_id.h"
#include "tools/report/run_summary.h"
#include "tools/report/verdict.h"
#include "tools/run/frame_dumps.h"
#include "tools/run/held_out.h"
#include "tools/run/scene_files.h"
#include "tools/run/summarise_run.h"

namespace patina::tools {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kFinestTexel_m = 0.0005;  // finer ones show the lens, not the surface

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

std::filesystem::path with_extension(const std::filesystem::path& dump_graph, const char* extension) {
    return dump_graph.string() + extension;
}

/// Reported before the work starts, although the graph is written at its end. It may go to the results' folder, which
/// need not exist yet, but not in place of a result.
void check_dump_graph(const RunOptions& options, const std::vector<std::filesystem::path>& inputs) {
    if (options.dump_graph.empty()) return;
    const std::filesystem::path out = sensor::resolved(options.out);
    for (const char* extension : {".dot", ".json"}) {
        const std::filesystem::path file = with_extension(options.dump_graph, extension);
        sensor::expect_apart(file, inputs);
        const std::filesystem::path place = sensor::resolved(file);
        const std::filesystem::path name = place.lexically_relative(out);
        if (is_result_name(ResultKind::kRun, name))
            throw Error("the graph cannot be written to '", file.string(), "': a result has that name");
        if (place.parent_path() != out) expect_place_for(file);
    }
}

void write_text(const std::filesystem::path& path, const std::string& content) {
    sensor::OutputFile file(path);
    sensor::write_bytes(file.partial_path(), content);
    file.finish();
}

vulkan::DeviceOptions device_options(const RunOptions& options, RunCompanion* companion) {
    vulkan::DeviceOptions device = Access::options(options.device);
    if (companion) companion->prepare(device);
    return device;
}

/// One run from source to folder. What fails after frames were fused costs itself alone: everything else is written
/// where it still can be, the most valuable first.
class Run {
  public:
    Run(const RunOptions& options, Console& console, OutputFolder& folder, RunCompanion* companion)
        : options_(options),
          console_(console),
          folder_(folder),
          companion_(companion),
          device_(Access::device(device_options(options, companion))),
          session_(Access::vulkan(device_), options, companion ? companion->source(Access::vulkan(device_)) : nullptr),
          pipeline_(session_.pipeline()),
          dumps_(folder, session_.info().frames, options.dump_every) {
        session_.bring_back([this](graph::StateVisitor& visitor, MapFile& map) {
            for (const std::string& name : map.files()) folder_.write(name, map.content_of_file(name));
            visit(visitor);
        });
    }

    /// Throws what stopped it before a frame was fused.
    void fuse_all() {
        try {
            while (session_.step()) {
                accompany();
                if (const Frame* frame = session_.fused()) after(*frame);
                if (const Frame* frame = session_.held_out()) held_out_.keep(*frame, pipeline_.frames() - 1);
                session_.checkpoint_if_due([this](auto& visitor, MapFile& map) { keep(visitor, map); });
            }
            if (companion_) companion_->end();
            session_.end();
            session_.checkpoint_if_due([this](auto& visitor, MapFile& map) { keep(visitor, map); });
        } catch (const Interrupted& interrupted) {
            if (session_.ledger().used() == 0) throw;
            console_.end();
            ended_ = interrupted.what();
            if (options_.checkpoint_every > 0 && options_.checkpoint_every != SessionOptions::kAtEnd) {
                attempt("the state, to go on from",
                        [&] { session_.checkpoint([this](auto& visitor, MapFile& map) { keep(visitor, map); }); });
            }
            if (!options_.quiet)
                print_error("{}: what was fused is being written; an interrupt after a second ends that too\n",
                            printable(ended_));
        } catch (const std::exception& error) {
            if (session_.ledger().used() == 0) throw;
            const std::string of = session_.info().frames ? fmt::format(" of {}", *session_.info().frames) : "";
            ended_ = fmt::format("failed after {}{} frames: {}", session_.ledger().read(), of, reason_of(error));
            failure_ = reason_of(error);
        }
        console_.end();
        times_s_.emplace_back("frames", seconds_since(start_));
    }

    Outcome write_results() {
        if (companion_) companion_->end();
        if (ended_.empty()) check_validation();
        // All of this is on the host.
        attempt("trajectory.txt", [&] { folder_.write("trajectory.txt", trajectory_text(session_.world_poses())); });
        if (session_.settings().gains) attempt("gains.txt", [&] { folder_.write("gains.txt", session_.gains_text()); });
        write_scene();
        if (scene_) attempt("the last pictures", [&] { dumps_.finish(); });
        if (options_.hold_out > 0 && ended_.empty()) {
            if (console_.interrupt().requested()) {
                problems_.push_back("held-out pictures were not compared: interrupted");
            } else {
                attempt("the comparison with held-out pictures", [&] { compare_held_out(); });
            }
        }
        try {
            write_summary();
        } catch (const std::exception& error) {
            keep_without_summary(reason_of(error));
        }
        place_ = folder_.path();
        if (ended_.empty()) {
            folder_.commit();
        } else {
            place_ = folder_.commit_unfinished();
        }
        // It may go to the results' folder.
        if (!options_.dump_graph.empty()) attempt("the graph", [&] { write_graph(); });
        const Outcome outcome = outcome_of_run();
        print_outcome(outcome);
        if (failure_.empty()) return outcome;
        throw Error(failure_, "; '", place_.string(), "' holds what could still be written");
    }

  private:
    /// What later frames, and the results, depend on besides the session.
    void visit(graph::StateVisitor& visitor) {
        dumps_.visit(visitor);
        held_out_.visit(visitor);
        pictures_.visit(visitor);
    }

    void keep(graph::StateVisitor& visitor, MapFile& map) {
        using Json = nlohmann::json;
        map.set_text("arguments", Json(options_.arguments).dump(-1, ' ', false, Json::error_handler_t::replace));
        map.set_text("started_in", options_.started_in.string());
        visit(visitor);
        const std::vector<std::string> known = map.files();
        for (const std::string& name : folder_.files()) {
            if (std::binary_search(known.begin(), known.end(), name)) continue;
            const std::vector<uint8_t> bytes = read_file(folder_.published(name), UINT64_MAX);
            map.set_file(name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        }
    }

    /// The user may have gone back to an earlier model.
    void accompany() {
        if (!companion_) return;
        companion_->after_step(session_);
        pictures_.keep_first(pipeline_.frames());
        held_out_.keep_first(session_.held_out_frames());
    }

    void after(const Frame& frame) {
        if (!options_.dump_graph.empty()) {
            const graph::CompiledFrame& compiled = pipeline_.runner().last_frame();
            graph_dot_ = graph::to_dot(compiled.description, compiled.plan);
            graph_json_ = graph::to_json(compiled.description, compiled.plan);
        }
        dumps_.after(pipeline_, session_.info(), frame);
        if (options_.texture) pictures_.add(session_.info(), frame, pipeline_.frames() - 1);
        if (session_.ledger().used() == 1) {
            pipeline_.wait();
            times_s_.emplace_back("first_fused_frame", seconds_since(start_));
        }
    }

    /// Does a part of the results; its failure is one of the run's shortfalls.
    void attempt(const char* what, const std::function<void()>& work) {
        try {
            work();
        } catch (const std::exception& error) {
            problems_.push_back(fmt::format("{} could not be written: {}", what, reason_of(error)));
            folder_.discard_staged();
        }
    }

    /// The mesh; without it the run has failed, though what else there is is written.
    void write_scene() {
        const auto start = Clock::now();
        console_.stage("Writing the scene");
        try {
            Scene scene = session_.scene_without_surface();
            attempt("what the surface reflects", [&] { session_.add_segments(scene); });
            attempt("light from afar", [&] { scene.far_field = pipeline_.far_field(); });
            attempt("windows",
                    [&] { scene.lighting.windows = pipeline_.windows(scene.trajectory, scene.lighting.lights); });
            scene_.emplace(std::move(scene), options_.files);
            attempt("materials.json and lights.json", [&] { scene_->write_lists(folder_); });
            write_surface();
            times_s_.emplace_back("scene", seconds_since(start));
        } catch (const std::exception& error) {
            scene_.reset();
            folder_.discard_staged();
            if (ended_.empty()) ended_ = fmt::format("failed after the last frame: {}", reason_of(error));
            if (failure_.empty()) failure_ = reason_of(error);
        }
    }

    /// Throws what kept scene.glb from being written, where there are no tiles in its place.
    void write_surface() {
        try {
            write_glb();
        } catch (const std::exception& error) {
            folder_.discard_staged();
            if (!options_.tiles) throw;
            glb_ = write_tiles();
            problems_.push_back(fmt::format("scene.glb could not be written: {}", reason_of(error)));
            return;
        }
        if (options_.tiles) attempt("tiles/", [&] { write_tiles(); });
    }

    /// All of them, or none.
    GlbSummary write_tiles() {
        try {
            return scene_->write_tiles(folder_, surface(scene_->segments()), kVersion);
        } catch (...) {
            folder_.discard_staged();
            folder_.withdraw("tiles/");
            throw;
        }
    }

    /// Without a texture where that fails, and without what it reflects where that does.
    void write_glb() {
        if (options_.texture && pictures_.size() > 0) {
            scene_->set_texture(texture_options());
            try {
                return write_glb(scene_->segments());
            } catch (const std::exception& error) {
                scene_->set_texture(std::nullopt);
                folder_.discard_staged();
                problems_.push_back(fmt::format("scene.glb has no texture: {}", reason_of(error)));
            }
        }
        try {
            write_glb(scene_->segments());
        } catch (const std::exception& error) {
            if (scene_->segments().empty()) throw;
            folder_.discard_staged();
            write_glb({});
            problems_.push_back(fmt::format("what the surface reflects could not be written: {}", reason_of(error)));
        }
    }

    void write_glb(const std::vector<SegmentReflectance>& segments) {
        glb_ = scene_->write_glb(folder_, surface(segments), kVersion,
                                 [this](const TextureLayout& layout) { return bake(layout); });
    }

    TextureOptions texture_options() const {
        TextureOptions texture;
        const double finest_m = pictures_.finest_pixel_m();
        if (options_.texel_m > 0) {
            texture.texel_m = options_.texel_m;
        } else if (finest_m > 0) {
            texture.texel_m = std::clamp(finest_m, kFinestTexel_m, texture.texel_m);
        }
        return texture;
    }

    std::vector<TexturePage> bake(const TextureLayout& layout) {
        const auto start = Clock::now();
        console_.stage("Baking the texture");
        const auto pages = pipeline_.bake_texture(layout, [this](const Pipeline::TakePicture& take) {
            pictures_.give(session_.info(), pipeline_.gains(), take);
        });
        times_s_.emplace_back("texture", seconds_since(start));
        return pages;
    }

    /// The surface in pieces, with what it reflects where there are segments.
    GivePieces surface(const std::vector<SegmentReflectance>& segments) {
        return [this, segments](const TakePiece& take) { pipeline_.give_surface(segments, take); };
    }

    void write_graph() const {
        write_text(with_extension(options_.dump_graph, ".dot"), graph_dot_);
        write_text(with_extension(options_.dump_graph, ".json"), graph_json_);
    }

    void compare_held_out() {
        const auto start = Clock::now();
        console_.stage("Comparing with held-out pictures");
        pipeline_.refine_all();
        pictures_.show_in(pipeline_, session_.info());
        held_out_summary_ = held_out_.compare(pipeline_, session_.info(), folder_);
        times_s_.emplace_back("held_out", seconds_since(start));
    }

    void check_validation() {
        if (const auto messages = device_.validation_messages(); !messages.empty()) {
            throw Error("the validation layer reported ", messages.size(), " messages, the first: ", messages.front());
        }
    }

    Outcome outcome_of_run() {
        Outcome outcome;
        for (std::string& shortfall : shortfalls_of(session_)) outcome.fall_short(std::move(shortfall));
        if (!ended_.empty()) outcome.fall_short(ended_);
        if (scene_ && glb_ && glb_->triangles == 0)
            outcome.fall_short("the surface is empty: from none of the frames a triangle was reconstructed");
        if (!dumps_.problem().empty()) outcome.fall_short(dumps_.problem());
        if (companion_) {
            for (std::string& shortfall : companion_->shortfalls()) outcome.fall_short(std::move(shortfall));
        }
        for (const std::string& problem : problems_) outcome.fall_short(problem);
        return outcome;
    }

    /// report.html and run.json, which comes last.
    void write_summary() {
        RunSummary summary = summarise(options_, session_, glb_.value_or(GlbSummary{}));
        attempt("the count of keyframes", [&] { add_keyframes(summary, session_); });
        summary.finished = ended_.empty();
        summary.ended = ended_;
        summary.held_out = held_out_summary_;
        if (companion_) companion_->add_to(summary);
        if (scene_) scene_->add_to(summary);
        times_s_.emplace_back("total", seconds_since(start_));
        summary.times_s = times_s_;
        summary.shortfalls = outcome_of_run().shortfalls();
        attempt("report.html", [&] { write_report(summary); });
        summary.files = folder_.files();
        summary.files.push_back("run.json");
        summary.id = run_id(summary, folder_.digest());
        attempt("the run's id in its pictures", [&] { dumps_.stamp(summary.id); });
        summary.shortfalls = outcome_of_run().shortfalls();
        folder_.write("run.json", run_json(summary));
        verdict_ = verdict_of(summary);
        warnings_ = std::move(summary.warnings);
    }

    void write_report(const RunSummary& summary) {
        std::optional<ReportScene> scene;
        if (scene_) attempt("the scene in report.html", [&] { scene = scene_->report_scene(folder_); });
        folder_.write("report.html",
                      report_html(summary, dumps_.previews(), scene ? &*scene : nullptr, dumps_.pairs()));
    }

    /// Results without run.json cannot be put in place: they stay under another name.
    [[noreturn]] void keep_without_summary(const std::string& reason) {
        const std::string why = failure_.empty() ? reason : failure_ + "; " + reason;
        const std::optional<std::filesystem::path> kept = folder_.keep();
        if (!kept) throw Error(why);
        throw Error(why, "; '", kept->string(), "' holds what could still be written");
    }

    /// For the user; the first lines are what the results fall short of.
    void print_outcome(const Outcome& outcome) const {
        if (failure_.empty()) outcome.print(options_.quiet);
        if (options_.quiet || !failure_.empty()) return;
        const std::vector<std::string> other = other_frames();
        print_out("{} of {} frames{}, {} triangles in {}\n", session_.ledger().used(),
                  session_.info().frames.value_or(session_.ledger().read()),
                  other.empty() ? "" : fmt::format(" ({})", fmt::join(other, ", ")),
                  glb_.value_or(GlbSummary{}).triangles, printable(place_.string()));
        const std::string& found_by = session_.illumination().found_by;
        if (found_by != "file" && found_by != "none") print_lights(session_.illumination());
        for (const std::string& sentence : verdict_.good) print_out("known: {}\n", printable(sentence));
        for (const std::string& sentence : verdict_.unknown) print_out("not known: {}\n", printable(sentence));
        for (const std::string& warning : warnings_) print_out("warning: {}\n", printable(warning));
        print_places();
    }

    /// Those that were not used, and not for a lack of theirs.
    std::vector<std::string> other_frames() const {
        const sensor::Ledger& ledger = session_.ledger();
        std::vector<std::string> list;
        if (ledger.repeated() > 0) list.push_back(fmt::format("{} repeat the one before", ledger.repeated()));
        if (ledger.undone() > 0) list.push_back(fmt::format("{} undone", ledger.undone()));
        return list;
    }

    void print_places() const {
        const std::filesystem::path report = place_ / "report.html", scene = place_ / "scene.glb";
        std::error_code failure;
        if (std::filesystem::exists(report, failure))
            print_out("open with a browser: {}\n", printable(report.string()));
        if (std::filesystem::exists(scene, failure))
            print_out("open with Blender or a glTF viewer: {}\n", printable(scene.string()));
    }

    const RunOptions& options_;
    Console& console_;
    OutputFolder& folder_;
    RunCompanion* companion_;
    Clock::time_point start_ = Clock::now();
    Device device_;
    SessionCore session_;
    Pipeline& pipeline_;
    FrameDumps dumps_;
    std::optional<SceneFiles> scene_;  ///< empty where the surface could not be extracted or written
    std::optional<GlbSummary> glb_;    ///< of scene.glb, or of tiles/ in its place; empty where there is neither
    HeldOut held_out_;
    KeptPictures pictures_;
    std::optional<HeldOutSummary> held_out_summary_;
    std::vector<std::pair<std::string, double>> times_s_;
    std::string graph_dot_, graph_json_;
    std::string ended_;            ///< why the run ended before its time; empty where it did not
    std::string failure_;          ///< the error that did it; empty where the user did
    std::filesystem::path place_;  ///< where the results went
    std::vector<std::string> problems_, warnings_;
    Verdict verdict_;
};

}  // namespace

Outcome run(const RunOptions& given, RunCompanion* companion) {
    Console console(given.quiet);  // from the first file to the last, so that none is left half-written
    RunOptions options = given;
    options.callbacks = console.callbacks();
    if (companion) companion->adjust(options.callbacks);
    const std::vector<std::filesystem::path> inputs = inputs_of(options);
    OutputFolder folder(options.out, inputs);
    check_dump_graph(options, inputs);
    Run job(options, console, folder, companion);
    job.fuse_all();
    return job.write_results();
}

}  // namespace patina::tools
