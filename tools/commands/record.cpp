#include "tools/record/record.h"

#include <memory>

#include "engine/core/error.h"
#include "sensor/open.h"
#include "tools/commands/commands.h"
#include "tools/program/cameras.h"

namespace patina::tools {

void add_record(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("record", "Record a sequence, and one of low exposure, into one file");
    const auto options = std::make_shared<RecordOptions>();
    command
        ->add_option("source", options->source,
                     text("Camera (", kCameraNames, "), or recording of any format that is recorded anew"))
        ->required();
    command->add_option("--out", options->out, "File to create, such as room.patina")->required();
    command->add_option("--lighting", options->lighting,
                        "Source of the sequence of low exposure; by default the one that belongs to the source. With "
                        "a camera its name: it is recorded once more after the first sequence");
    command
        ->add_option("--low-exposure", options->low_exposure_ms,
                     "Exposure time of a camera's sequence of low exposure, in milliseconds")
        ->check(CLI::Range(0.01, 66.0))
        ->capture_default_str();
    command->add_option("--format", options->format, sensor::format_names() + ", instead of recognising it");
    command->add_flag("--simulate", options->simulate,
                      "The source plays by its clock, as a camera would; without it as fast as it can be read");
    command->add_flag("--decoded", options->decoded,
                      "Decode the raw frames of a Kinect v2, and record depth and colour; other cameras send these");
    command->add_option("--seconds", options->seconds, "End each sequence so many seconds after its first frame")
        ->check(CLI::PositiveNumber);
    command->add_flag("--quiet", options->quiet, "Print nothing but errors");
    command->callback([options, &exit_code] { exit_code = record(*options).exit_code(); });
}

}  // namespace patina::tools
