#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "engine/core/expect_path.h"
#include "engine/core/input_file.h"
#include "engine/core/printable.h"
#include "sensor/output/apart.h"
#include "tools/commands/run_arguments.h"
#include "tools/eval/eval_json.h"
#include "tools/eval/eval_report.h"
#include "tools/eval/eval_text.h"
#include "tools/eval/evaluate.h"
#include "tools/program/progress.h"
#include "tools/render/finished_views.h"
#include "tools/report/output_folder.h"

namespace patina::tools {

namespace {

struct EvalArguments {
    std::filesystem::path sequence, run, out;
    eval::Settings settings;
    DeviceArguments device;
    bool finished = false;
    bool quiet = false;
};

eval::Evaluation evaluate_with_progress(const EvalArguments& arguments) {
    std::optional<Progress> progress;
    eval::Settings settings = arguments.settings;
    settings.on_frame = [&](size_t done, size_t total) {
        if (!progress) progress.emplace("Measuring", static_cast<uint32_t>(total), arguments.quiet);
        progress->update(static_cast<uint32_t>(done), "compared");
    };
    return eval::evaluate(arguments.sequence, arguments.run, settings);
}

/// An evaluation may go to a folder of its own in the run's, but not to one of the run's results.
std::vector<std::filesystem::path> inputs_of(const EvalArguments& arguments, const std::filesystem::path& folder) {
    const std::filesystem::path run = sensor::resolved(arguments.run);
    const std::filesystem::path part = sensor::resolved(folder).lexically_relative(run);
    const bool in_run = !part.empty() && part != "." && *part.begin() != "..";
    if (!in_run) return {arguments.sequence, arguments.run};
    return {arguments.sequence, run / "frames", run / "previews", run / "held_out"};
}

/// What a run came to: the finished model where truth has recorded views, where the run never was, and under other
/// lamps.
void evaluate_finished(const EvalArguments& arguments, OutputFolder& out, eval::Evaluation& evaluation) {
    const std::filesystem::path sequence = std::filesystem::absolute(arguments.sequence),
                                run = std::filesystem::absolute(arguments.run), truth = sequence / "truth";
    FinishedViews views{.sequence = sequence, .recorded = {}, .never_recorded = path_exists(truth / "novel")};
    if (arguments.finished) views.recorded = evaluation.frames;
    if (views.recorded.empty() && !views.never_recorded) return;
    if (!path_exists(map_in(run))) {
        evaluation.no_views =
            fmt::format("{} not compared: the run kept no map (--no-map).",
                        arguments.finished ? "The finished model was" : "Views that were never recorded were");
        return;
    }
    const RigidTransform truth_from_run = eval::world_of_run(sequence, run);
    const auto kept = kept_arguments(map_in(run));
    kept->sequence.finish(kept->run);
    kept->run.map = map_in(run);
    kept->run.resume = true;
    kept->run.checkpoint_every = 0;
    kept->run.device = arguments.device.choice();
    std::optional<Progress> progress;
    render_finished_views(kept->run, views, truth_from_run, out, [&](uint32_t done, uint32_t total) {
        if (!progress) progress.emplace("Rendering", total, arguments.quiet);
        progress->update(done, "views of the finished model");
    });
    progress.reset();
    const glm::dmat3 rotation(truth_from_run);
    const auto measure = [&](const std::filesystem::path& of, const char* pictures) {
        return eval::evaluate_views(of, out.published(fmt::format("{}/000000.exr", pictures)).parent_path(), rotation);
    };
    if (!views.recorded.empty()) evaluation.finished = measure(sequence, "finished");
    if (!views.never_recorded) return;
    evaluation.novel = measure(truth / "novel", "novel");
    evaluation.relit = measure(truth / "relit", "relit");
}

void write_files(const eval::Evaluation& evaluation, const std::vector<eval::ErrorFigure>& figures, OutputFolder& out) {
    out.write("report.html", eval_report_html(evaluation, figures));
    out.write("eval.json", eval::eval_json(evaluation));
    out.commit();
}

void run_eval(const EvalArguments& arguments) {
    const std::filesystem::path folder = arguments.out.empty() ? arguments.run / "eval" : arguments.out;
    expect_folder(arguments.run);
    // Absolute, as what a run was given is looked for in the folder that it was started in.
    OutputFolder out(std::filesystem::absolute(folder), inputs_of(arguments, folder), ResultKind::kEvaluation);
    eval::Evaluation evaluation = evaluate_with_progress(arguments);
    // Before the folder that the run was started in is entered, where relative paths are others.
    const std::vector<eval::ErrorFigure> figures = eval::error_figures(evaluation);
    evaluate_finished(arguments, out, evaluation);
    write_files(evaluation, figures, out);
    if (arguments.quiet) return;
    std::fputs(eval::eval_text(evaluation).c_str(), stdout);
    std::printf("\n%s and eval.json\n", printable((folder / "report.html").string()).c_str());
}

}  // namespace

void add_eval(CLI::App& app) {
    CLI::App* command = app.add_subcommand("eval", "Compare a run with the truth of its synthetic sequence");
    const auto arguments = std::make_shared<EvalArguments>();
    command->add_option("sequence", arguments->sequence, "Folder of a sequence with truth/frames")->required();
    command->add_option("run", arguments->run, "Folder of a run with frames, see run --dump-every")->required();
    command->add_option("--out", arguments->out, "Folder for eval.json and report.html, instead of RUN/eval");
    command
        ->add_option("--light-radius", arguments->settings.light_radius_m,
                     "A light of the run farther than this from a true one, in metres, does not stand for it")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command
        ->add_option("--seen", arguments->settings.seen_frames,
                     "Score materials and colours, besides everywhere, where the surface was seen in at least so many "
                     "frames of the sequence")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command->add_flag("--finished", arguments->finished,
                      "Also score the finished model in the recorded views, as scene.glb has it; from the run's map");
    command->add_flag("--quiet", arguments->quiet, "Print nothing but errors");
    arguments->device.add_to(*command);
    command->callback([arguments] { run_eval(*arguments); });
}

}  // namespace patina::tools
