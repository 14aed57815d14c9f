#include "tools/convert/export_native.h"

#include <algorithm>
#include <deque>
#include <mutex>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cameras/open_sequence.h"
#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "reconstruction/api/access.h"
#include "sensor/files/picture_file.h"
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

/// The infrared pictures of a camera, between the thread that decodes and the one that writes: one for each frame, in
/// the frames' order.
class InfraredPictures {
  public:
    void put(Image<float> picture) {
        const std::lock_guard lock(mutex_);
        pictures_.push_back(std::move(picture));
    }

    /// That of the next frame; empty where the sequence has none.
    std::optional<Image<float>> take() {
        const std::lock_guard lock(mutex_);
        if (pictures_.empty()) return std::nullopt;
        Image<float> picture = std::move(pictures_.front());
        pictures_.pop_front();
        return picture;
    }

  private:
    std::mutex mutex_;
    std::deque<Image<float>> pictures_;
};

/// Writes infrared/NNNNNN.png: 16 bits a pixel, of the depth camera.
void write_infrared(sensor::SequenceWriter& writer, uint32_t index, const Image<float>& picture) {
    const std::filesystem::path folder = writer.partial_folder() / "infrared";
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    if (failure) throw Error("'", folder.string(), "' cannot be created: ", failure.message());
    Image<uint16_t> codes(picture.extent());
    std::ranges::transform(picture.pixels(), codes.pixels().begin(),
                           [](float light) { return static_cast<uint16_t>(std::clamp(light, 0.0f, 65535.0f)); });
    writer.background().start([file = folder / (sensor::picture_stem(index) + ".png"), codes = std::move(codes)] {
        sensor::write_png(file, codes);
    });
}

/// What became of the frames of one sequence.
struct Written {
    uint32_t frames = 0;
    std::vector<Skipped> skipped;
};

Written write_all(Source& source, sensor::SequenceWriter& writer, InfraredPictures& infrared,
                  const InterruptGuard& interrupt, bool quiet) {
    Written written;
    Progress progress("Writing", source.info().frames, quiet);
    while (std::optional<Reading> reading = source.next()) {
        if (interrupt.requested()) throw Interrupted("interrupted after ", written.frames, " frames; nothing is left");
        if (auto* skipped = std::get_if<Skipped>(&*reading)) {
            written.skipped.push_back(std::move(*skipped));
            continue;
        }
        Frame frame = std::get<Frame>(*std::move(reading));
        if (const auto picture = infrared.take()) write_infrared(writer, written.frames, *picture);
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
    InfraredPictures infrared;
    const auto decoders = cameras::payload_decoders(
        [&]() -> vulkan::Device& { return Access::vulkan(device ? *device : device.emplace()); },
        [&](Image<float> picture) { infrared.put(std::move(picture)); });
    sensor::PrefetchSource main(sensor::open_sequence(options.sequence, options.format, decoders));
    sensor::SequenceWriter writer(options.out, main.info(), sensor::LinearColor::kExr);
    const Written written = write_all(main, writer, infrared, interrupt, options.quiet);
    Outcome outcome;
    report(outcome, written, "main");
    if (const auto lighting = sensor::lighting_of(options.sequence); !lighting.empty()) {
        sensor::PrefetchSource dark(sensor::open_sequence(lighting, "", decoders));
        sensor::SequenceWriter dark_writer(writer.partial_folder() / "lighting", dark.info(),
                                           sensor::LinearColor::kExr);
        report(outcome, write_all(dark, dark_writer, infrared, interrupt, options.quiet), "lighting");
        dark_writer.finish();
    }
    writer.finish();
    outcome.print(options.quiet);
    if (!options.quiet) print_out("{} frames in {}\n", written.frames, printable(options.out.string()));
    return outcome;
}

}  // namespace patina::tools
