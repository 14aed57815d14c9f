#include "tools/run/run.h"

#include <memory>

#include "tools/commands/commands.h"
#include "tools/commands/parse.h"

namespace patina::tools {

void add_run(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("run", "Reconstruct a sequence into a scene");
    struct Arguments {
        RunOptions run;
        SequenceArguments sequence;
    };
    const auto arguments = std::make_shared<Arguments>();
    RunOptions& run_options = arguments->run;
    arguments->sequence.add_to(*command, run_options);
    command->add_option("--out", run_options.out, "Folder for the results")->required();
    command->add_option("--dump-every", run_options.dump_every, "Write frames/NNNNNN.exr of every so many frames");
    command
        ->add_option("--gains", run_options.gains,
                     "Bring each frame's colours to the exposure and white balance of the first: auto (where the "
                     "recording does not tell the exposure), on, off")
        ->transform(one_of<Gains>({{"auto", Gains::kAuto}, {"on", Gains::kOn}, {"off", Gains::kOff}}))
        ->option_text("auto|on|off");
    command
        ->add_option("--poses", run_options.poses,
                     "The camera's poses: given by the sequence, tracked, or tracked from the given motion on (prior); "
                     "by default given where there are any")
        ->transform(one_of<Poses>({{"given", Poses::kGiven}, {"track", Poses::kTrack}, {"prior", Poses::kPrior}}))
        ->option_text("given|track|prior");
    command->add_option("--hold-out", run_options.hold_out,
                        "Keep the colours of every so many-th frame out of the model, and compare them in the end");
    command->add_option("--dump-graph", run_options.dump_graph,
                        "Write PATH.dot and PATH.json of the last frame's last graph");
    command->callback([arguments, &exit_code] {
        arguments->sequence.finish(arguments->run);
        arguments->run.hints.track = "--poses track";
        exit_code = run(arguments->run).exit_code();
    });
}

}  // namespace patina::tools
