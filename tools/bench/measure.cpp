#include "tools/bench/measure.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <unordered_map>

#include <sys/resource.h>

#include "engine/core/error.h"
#include "reconstruction/session/rgbd_frame.h"

namespace patina::bench {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kExtractions = 5;  // after one to warm up

float milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<float, std::milli>(Clock::now() - start).count();
}

bool is_transfer(const graph::Pass& pass) {
    return std::all_of(pass.accesses.begin(), pass.accesses.end(), [](const graph::Access& access) {
        return access.use == graph::Use::kTransferRead || access.use == graph::Use::kTransferWrite ||
               access.use == graph::Use::kTransferModify;
    });
}

uint64_t peak_resident_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

/// One run over a recording.
class Bench {
  public:
    Bench(const Recording& recording, const ReconstructionSettings& settings, const vulkan::DeviceOptions& options)
        : recording_(recording), device_(options), pipeline_(device_, settings) {
        const vulkan::DeviceCaps& caps = device_.caps();
        if (!caps.timestamps)
            throw Error("the device '", caps.name, "' has no timestamps, so its passes cannot be timed");
        result_.caps = caps;
    }

    Measurement run(uint32_t warmup) {
        for (uint32_t i = 0; i < warmup; ++i) fuse(recording_.frames[i]);
        forget_warmup();
        for (size_t i = warmup; i < recording_.frames.size(); ++i) {
            fuse(recording_.frames[i]);
            note_frame();
        }
        summarise_frames();
        extract_surfaces();
        note_memory();
        return result_;
    }

  private:
    void fuse(const Frame& frame) {
        const RgbdFrame rgbd = patina::to_rgbd(recording_.info, frame);
        const auto start = Clock::now();
        pipeline_.add(rgbd);
        add_ms_.push_back(milliseconds_since(start));
        // On a software device a frame in flight would compete with the host's work on the next one.
        pipeline_.wait();
        if (pipeline_.frames() == 1) result_.first_frame_s = milliseconds_since(start_) * 1e-3f;
    }

    void forget_warmup() {
        pipeline_.runner().clear_timings();
        add_ms_.clear();
        compilations_ = pipeline_.runner().compilations();
    }

    void note_frame() {
        visible_mvoxel_.push_back(static_cast<float>(pipeline_.counters().visible_blocks) * gpu::kBlockVoxels * 1e-6f);
        const graph::CompiledFrame& frame = pipeline_.runner().last_frame();
        uint32_t dispatches = 0;
        for (const uint32_t pass : frame.plan.order) {
            const graph::Pass& description = frame.description.passes[pass];
            compute_[description.name] = !is_transfer(description);
            dispatches += compute_[description.name];
        }
        if (dispatches < result_.dispatches) return;
        result_.dispatches = dispatches;
        result_.frame_passes = static_cast<uint32_t>(frame.plan.order.size());
    }

    const std::vector<float>& samples(const std::string& pass) {
        for (const graph::Timing& timing : pipeline_.runner().pass_timings()) {
            if (timing.name == pass && timing.samples_ms.size() == result_.frames) return timing.samples_ms;
        }
        throw Error("the pass '", pass, "' was not timed once in each of ", result_.frames, " frames");
    }

    void summarise_frames() {
        result_.frames = static_cast<uint32_t>(visible_mvoxel_.size());
        for (const graph::Timing& timing : pipeline_.runner().pass_timings()) {
            const Distribution ms = distribution(timing.samples_ms);
            result_.passes.push_back({timing.name, ms});
            if (ms.count < result_.frames) continue;
            (compute_[timing.name] ? result_.geometry_ms : result_.transfers_ms) += ms.median;
        }
        std::vector<float> integrate = samples("fusion.integrate");
        if (pipeline_.settings().fusion.color) {
            const std::vector<float>& color = samples("fusion.integrate_color");
            std::transform(integrate.begin(), integrate.end(), color.begin(), integrate.begin(), std::plus<>());
        }
        const std::vector<float>&touch = samples("fusion.touch_blocks"), &select = samples("fusion.select_blocks"),
              &assign = samples("fusion.assign_blocks");
        std::vector<float> mvoxel_s, allocate;
        for (uint32_t i = 0; i < result_.frames; ++i) {
            mvoxel_s.push_back(visible_mvoxel_[i] / (integrate[i] * 1e-3f));
            allocate.push_back(touch[i] + select[i] + assign[i]);
        }
        result_.integrate_ms = distribution(std::move(integrate));
        result_.integrate_mvoxel_s = distribution(std::move(mvoxel_s));
        result_.allocate_ms = distribution(std::move(allocate));
        result_.raycast_ms = distribution(samples("fusion.raycast"));
        result_.visible_mvoxel = distribution(visible_mvoxel_).median;
        result_.submit_ms = distribution(pipeline_.runner().host_timing().samples_ms);
        result_.add_ms = distribution(add_ms_);
        result_.late_compilations = pipeline_.runner().compilations() - compilations_;
    }

    void extract_surfaces() {
        const gpu::MapCounters counters = pipeline_.counters().map;
        const uint32_t used = counters.capacity - counters.free_blocks;
        result_.allocated_mvoxel = static_cast<float>(used) * gpu::kBlockVoxels * 1e-6f;
        result_.refused_blocks = counters.refused_blocks;
        std::vector<float> gpu_ms, wall_ms;
        std::vector<std::pair<std::string, std::vector<float>>> by_pass;
        for (int i = 0; i <= kExtractions; ++i) {
            pipeline_.runner().clear_timings();
            const auto start = Clock::now();
            result_.triangles = pipeline_.extract_surface().triangles.size();
            if (i == 0) continue;
            wall_ms.push_back(milliseconds_since(start));
            gpu_ms.push_back(add_extraction(by_pass));
        }
        for (auto& [name, ms] : by_pass) result_.surface_passes.push_back({name, distribution(std::move(ms))});
        result_.surface_ms = distribution(std::move(gpu_ms));
        result_.surface_wall_ms = distribution(std::move(wall_ms));
    }

    /// Adds each pass's sum over one extraction; returns the sum over all passes. Extractions have the same passes.
    float add_extraction(std::vector<std::pair<std::string, std::vector<float>>>& by_pass) {
        float total_ms = 0;
        const std::vector<graph::Timing>& timings = pipeline_.runner().pass_timings();
        by_pass.resize(timings.size());
        for (size_t i = 0; i < timings.size(); ++i) {
            float ms = 0;
            for (const float sample : timings[i].samples_ms) ms += sample;
            by_pass[i].first = timings[i].name;
            by_pass[i].second.push_back(ms);
            total_ms += ms;
        }
        return total_ms;
    }

    void note_memory() {
        result_.pools = pipeline_.map().memory();
        result_.transient_bytes = pipeline_.runner().transient_bytes();
        result_.recording_bytes = recording_.bytes();
        result_.peak_resident_bytes = peak_resident_bytes();
    }

    Clock::time_point start_ = Clock::now();  // first: before the device is opened
    const Recording& recording_;
    vulkan::Device device_;
    Pipeline pipeline_;
    Measurement result_;
    uint32_t compilations_ = 0;
    std::vector<float> visible_mvoxel_, add_ms_;
    std::unordered_map<std::string, bool> compute_;
};

}  // namespace

Measurement measure(const Recording& recording, uint32_t warmup, const ReconstructionSettings& settings,
                    const vulkan::DeviceOptions& options) {
    return Bench(recording, settings, options).run(warmup);
}

}  // namespace patina::bench
