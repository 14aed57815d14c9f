#include "tools/convert/export_native.h"

#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cameras/open_sequence.h"
#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "reconstruction/api/access.h"
#include "sensor/open.h"
#include "sensor/output/apart.h"
#include "sensor/prefetch.h"
#include "sensor/write_sequence.h"
#include "tools/program/inputs.h"
#include "tools/program/interrupt.h"
#include "tools/program/progress.h"
#include "tools/program/standard_streams.h"

namespace patina::tools {

namespace {

/// What became of the frames of one sequence.
struct Written {
    uint32_t frames = 0;
    std::vector<Skipped> skipped;
};

Written write_all(Source& source, sensor::SequenceWriter& writer, const InterruptGuard& interrupt, bool quiet) {
    Written written;
    Progress progress("Writing", source.info().frames, quiet);
    while (std::optional<Reading> reading = source.next()) {
        if (interrupt.requested()) throw Interrupted("interrupted after ", written.frames, " frames; nothing is left");
        if (auto* skipped = std::get_if<Skipped>(&*reading)) {
            written.skipped.push_back(std::move(*skipped));
            continue;
        }
        Frame frame = std::get<Frame>(*std::move(reading));
        frame.index = written.frames++;
        writer.write(std::move(frame));
        progress.update(written.frames, source.info().name);
    }
    if (written.frames == 0)
        throw Error(
            "no frame of '", source.info().name, "' can be read",
            written.skipped.empty() ? "" : "; the first is left out because: " + written.skipped.front().reason);
    return written;
}

void report(Outcome& outcome, const Written& written, const char* which) {
    if (written.skipped.empty()) return;
    outcome.fall_short(fmt::format("{} of {} frames of the {} sequence are left out; the first because: {}",
                                   written.skipped.size(), written.frames + written.skipped.size(), which,
                                   written.skipped.front().reason));
}

}  // namespace

Outcome export_native(const ExportNativeOptions& options) {
    const InterruptGuard interrupt;
    sensor::expect_apart(options.out, sequence_inputs(options.sequence));
    std::optional<Device> device;  // for raw recordings alone; one sequence is read after the other
    const auto decoders = cameras::payload_decoders(
        [&]() -> vulkan::Device& { return Access::vulkan(device ? *device : device.emplace()); });
    sensor::PrefetchSource main(sensor::open_sequence(options.sequence, options.format, decoders));
    sensor::SequenceWriter writer(options.out, main.info(), sensor::LinearColor::kExr);
    const Written written = write_all(main, writer, interrupt, options.quiet);
    Outcome outcome;
    report(outcome, written, "main");
    if (const auto lighting = sensor::lighting_of(options.sequence); !lighting.empty()) {
        sensor::PrefetchSource dark(sensor::open_sequence(lighting, "", decoders));
        sensor::SequenceWriter dark_writer(writer.partial_folder() / "lighting", dark.info(),
                                           sensor::LinearColor::kExr);
        report(outcome, write_all(dark, dark_writer, interrupt, options.quiet), "lighting");
        dark_writer.finish();
    }
    writer.finish();
    outcome.print(options.quiet);
    if (!options.quiet) print_out("{} frames in {}\n", written.frames, printable(options.out.string()));
    return outcome;
}

}  // namespace patina::tools
