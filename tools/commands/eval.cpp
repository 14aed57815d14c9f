#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "tools/commands/commands.h"
#include "tools/eval/eval_json.h"
#include "tools/eval/eval_report.h"
#include "tools/eval/eval_text.h"
#include "tools/eval/evaluate.h"
#include "tools/export/output_folder.h"
#include "tools/progress.h"

namespace patina::tools {

namespace {

struct EvalArguments {
    std::filesystem::path sequence, run, out;
    eval::Settings settings;
    bool quiet = false;
};

eval::Evaluation evaluate_with_progress(const EvalArguments& arguments) {
    std::optional<Progress> progress;
    eval::Settings settings = arguments.settings;
    settings.on_frame = [&](size_t done, size_t total) {
        if (!progress) progress.emplace(static_cast<uint32_t>(total), arguments.quiet);
        progress->update(static_cast<uint32_t>(done), "compared");
    };
    return eval::evaluate(arguments.sequence, arguments.run, settings);
}

/// eval.json is written last: its presence says that the evaluation finished.
void write_files(const eval::Evaluation& evaluation, const std::filesystem::path& folder) {
    const std::string report = eval_report_html(evaluation, eval::error_figures(evaluation));
    OutputFolder out(folder, "eval.json");
    out.write("report.html", report);
    out.write("eval.json", eval::eval_json(evaluation));
}

void run_eval(const EvalArguments& arguments) {
    const std::filesystem::path folder = arguments.out.empty() ? arguments.run / "eval" : arguments.out;
    const eval::Evaluation evaluation = evaluate_with_progress(arguments);
    write_files(evaluation, folder);
    if (arguments.quiet) return;
    std::fputs(eval::eval_text(evaluation).c_str(), stdout);
    std::printf("\n%s and eval.json\n", (folder / "report.html").c_str());
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
                     "Score materials and colours where the surface was seen in at least so many frames of the "
                     "sequence; 1 takes every pixel that has truth")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    command->add_flag("--quiet", arguments->quiet, "Print nothing but errors");
    command->callback([arguments] { run_eval(*arguments); });
}

}  // namespace patina::tools
