// `patina bench record`: how fast raw frames of a Kinect v2 reach the disk. See docs/develop/benchmarks.md.
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <random>
#include <thread>

#include <CLI/CLI.hpp>

#include "engine/core/error.h"
#include "engine/vulkan/device.h"
#include "sensor/kinect2/raw_frame.h"
#include "sensor/recording/recorder.h"
#include "tools/bench/subjects.h"

namespace patina::bench {
namespace record_bench {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using sensor::Recorder;

// Of one frame: an infrared frame, and a colour picture as JPEG. Neither can be compressed.
using sensor::kinect2::kInfraredBytes;
constexpr size_t kColorBytes = 300000;
/// Different frames, so that no layer below finds the same bytes again.
constexpr size_t kPayloads = 8;

struct Options {
    std::string folder;
    double fps = 30;
};

struct Figures {
    double seconds = 0;
    sensor::RecorderCounts counts;
};

std::vector<uint8_t> noise(size_t bytes, uint32_t seed) {
    std::mt19937_64 random(seed);
    std::vector<uint8_t> noise(bytes);
    for (uint8_t& byte : noise) byte = static_cast<uint8_t>(random());
    return noise;
}

sensor::RecordedSequence sequence() {
    sensor::RecordedSequence sequence;
    sequence.streams = {{"infrared", "noise", 125e-6}, {"color", "noise", 125e-6}};
    return sequence;
}

/// Records frames at a rate, or as fast as they go where there is none.
Figures measure(const fs::path& folder, uint32_t frames, std::optional<double> fps) {
    std::vector<std::vector<uint8_t>> infrared, color;
    for (uint32_t i = 0; i < kPayloads; ++i) {
        infrared.push_back(noise(kInfraredBytes, 2 * i));
        color.push_back(noise(kColorBytes, 2 * i + 1));
    }
    const fs::path file = folder / ("patina-bench-" + std::to_string(std::random_device()()) + ".patina");
    struct Remove {
        ~Remove() {
            std::error_code ignored;
            fs::remove(file, ignored);
        }
        const fs::path& file;
    };
    const Remove after{file};
    Figures figures;
    const auto start = Clock::now();
    Recorder recorder(file, {.when_full = fps ? Recorder::WhenFull::kDrop : Recorder::WhenFull::kWait,
                             .most_queued_bytes = uint64_t{fps ? 512u : 32u} << 20});
    recorder.begin(sensor::SequenceRole::kMain, sequence());
    for (uint32_t i = 0; i < frames; ++i) {
        if (fps) std::this_thread::sleep_until(start + std::chrono::duration<double>(i / *fps));
        sensor::RecordedFrame frame;
        frame.index = i;
        frame.timestamp_s = i / fps.value_or(30);
        frame.payloads.push_back({0, i, i, "", infrared[i % kPayloads]});
        frame.payloads.push_back({1, i, i, "", color[i % kPayloads]});
        recorder.record(std::move(frame));
    }
    recorder.finish();
    figures.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    figures.counts = recorder.counts();
    return figures;
}

nlohmann::ordered_json figures_json(const Figures& figures) {
    return {{"seconds", figures.seconds},
            {"megabytes_per_second", static_cast<double>(figures.counts.bytes) / 1e6 / figures.seconds},
            {"dropped", figures.counts.dropped},
            {"most_queued_bytes", figures.counts.most_queued_bytes},
            {"slowest_commit_s", figures.counts.slowest_commit_s}};
}

void add(Report& report, const char* key, const std::string& name, const Figures& figures) {
    report.json[key] = figures_json(figures);
    report.print("{}: {:.1f} MB/s, {} frames dropped, at most {:.0f} MB waited, the slowest commit took {:.2f} s\n",
                 name, static_cast<double>(figures.counts.bytes) / 1e6 / figures.seconds, figures.counts.dropped,
                 static_cast<double>(figures.counts.most_queued_bytes) / 1e6, figures.counts.slowest_commit_s);
}

Report run(const Options& options, const Conditions& conditions) {
    vulkan::Device device(conditions.device);
    Report report(device.caps());
    const fs::path folder = options.folder.empty() ? fs::temp_directory_path() : fs::path(options.folder);
    report.print("{} frames of {:.2f} MB\n\n", conditions.frames, (kInfraredBytes + kColorBytes) / 1e6);
    add(report, "unpaced", "as fast as they go", measure(folder, conditions.frames, std::nullopt));
    add(report, "paced", fmt::format("{} frames a second", options.fps),
        measure(folder, conditions.frames, options.fps));
    return report;
}

}  // namespace
}  // namespace record_bench

Subject record_subject() {
    using namespace record_bench;
    return {
        "record", "How fast raw frames of a Kinect v2 reach the disk", {.frames = 300}, [](CLI::App& app) -> Measure {
            const auto options = std::make_shared<Options>();
            app.add_option("--folder", options->folder, "Where the recording is written, and removed again");
            app.add_option("--fps", options->fps, "Frames a second")->check(CLI::PositiveNumber)->capture_default_str();
            return [options](const Conditions& conditions) { return run(*options, conditions); };
        }};
}

}  // namespace patina::bench
