#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "sensor/files/text_file.h"
#include "sensor/output/output_file.h"
#include "tools/bench/subjects.h"
#include "tools/commands/commands.h"
#include "tools/commands/parse.h"
#include "tools/program/standard_streams.h"

namespace patina::tools {

namespace {

constexpr const char* kStandardOutput = "-";

/// The options that all subjects share; empty where they were not given.
struct BenchArguments {
    DeviceArguments device;
    std::optional<uint32_t> warmup, frames;
    std::optional<std::string> extent;
    std::string json;

    void add_to(CLI::App& command) {
        device.add_to(command);
        command.add_option("--warmup", warmup, "How many frames to run before those that are measured");
        command.add_option("--frames", frames, "How many frames to measure")->check(at_least_one());
        command.add_option("--extent", extent, "Resample colour and depth to WIDTHxHEIGHT");
        command
            .add_option("--json", json, "Write the figures to this file; without FILE print them instead of the table")
            ->expected(0, 1)
            ->default_str(kStandardOutput)
            ->option_text("[FILE]");
    }

    /// With the subject's defaults. Throws CLI::ValidationError for an option that does not apply to it.
    bench::Conditions conditions(const bench::Subject& subject) const;
};

/// A subject as it was added to the command line.
struct AddedSubject {
    bench::Subject subject;
    bench::Measure measure;
};

/// Throws where an option was given that the subject has no use for.
void refuse(bool given, const char* option, const bench::Subject& subject) {
    if (given) throw CLI::ValidationError(option, text("does not apply to the subject '", subject.name, "'"));
}

bench::Conditions BenchArguments::conditions(const bench::Subject& subject) const {
    const bench::Defaults& defaults = subject.defaults;
    refuse(warmup && !defaults.warmup, "--warmup", subject);
    refuse(frames && !defaults.frames, "--frames", subject);
    refuse(extent && !defaults.extent, "--extent", subject);
    bench::Conditions conditions;
    conditions.device = device.options();
    conditions.warmup = warmup.value_or(defaults.warmup.value_or(0));
    conditions.frames = frames.value_or(defaults.frames.value_or(1));
    const std::string size = extent.value_or(defaults.extent.value_or(bench::kAsRecorded));
    if (size != bench::kAsRecorded) conditions.extent = parse_extent(size);
    return conditions;
}

/// What --help says of the shared options: their defaults where they apply to the subject.
std::string help_on_defaults(const bench::Defaults& defaults) {
    std::vector<std::string> list;
    if (defaults.warmup) list.push_back(text("--warmup ", *defaults.warmup));
    if (defaults.frames) list.push_back(text("--frames ", *defaults.frames));
    if (defaults.extent) list.push_back(text("--extent ", *defaults.extent));
    const std::string shared = "All subjects have --device, --validation, --memory and --json.";
    return list.empty() ? shared : shared + " Defaults here: " + CLI::detail::join(list, ", ") + ".";
}

/// Measures and prints. A file that cannot be written is an error before the work.
void measure(const AddedSubject& chosen, const BenchArguments& arguments) {
    const bench::Conditions conditions = arguments.conditions(chosen.subject);
    const bool to_file = !arguments.json.empty() && arguments.json != kStandardOutput;
    std::optional<sensor::OutputFile> out;
    if (to_file) out.emplace(arguments.json);
    const bench::Report report = chosen.measure(conditions);
    const std::string figures = report.json.dump(2) + '\n';
    print_out("{}", arguments.json == kStandardOutput ? figures : report.text);
    if (!out) return;
    sensor::write_bytes(out->partial_path(), figures);
    out->finish();
}

}  // namespace

void add_bench(CLI::App& app) {
    CLI::App* command = app.add_subcommand(
        "bench", "Measure how fast this device is: the whole pipeline on a built-in scene, or one subject");
    const auto arguments = std::make_shared<BenchArguments>();
    arguments->add_to(*command);
    const size_t shared = command->get_options().size();
    const auto chosen = std::make_shared<AddedSubject>();
    chosen->subject = bench::pipeline_subject();
    chosen->measure = chosen->subject.add_options(*command);
    command->footer("Without a subcommand: the whole pipeline, with all its stages on. " +
                    help_on_defaults(chosen->subject.defaults));
    const std::vector<CLI::Option*> options = command->get_options();
    const std::vector<CLI::Option*> of_pipeline(options.begin() + static_cast<ptrdiff_t>(shared), options.end());
    command->require_subcommand(0, 1);
    for (const bench::Subject& subject : bench::named_subjects()) {
        CLI::App* named = command->add_subcommand(subject.name, subject.sentence);
        named->fallthrough();
        named->footer(help_on_defaults(subject.defaults));
        const AddedSubject added{subject, subject.add_options(*named)};
        named->callback([added, chosen, of_pipeline] {
            for (const CLI::Option* option : of_pipeline)
                refuse(option->count() > 0, option->get_name().c_str(), added.subject);
            *chosen = added;
        });
    }
    command->callback([arguments, chosen] { measure(*chosen, *arguments); });
}

}  // namespace patina::tools
