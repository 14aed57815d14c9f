#include "tools/synth/synth_hemi.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "engine/core/printable.h"
#include "tools/program/interrupt.h"
#include "tools/program/progress.h"
#include "tools/program/standard_streams.h"
#include "tools/synth/example_file.h"
#include "tools/synth/example_renderer.h"

namespace patina::tools {

namespace {

constexpr uint32_t kBatch = 64;  // scenes; part of what a seed gives

std::vector<scenes::ExampleScene> draw_batch(uint64_t seed, uint64_t first) {
    std::vector<scenes::ExampleScene> scenes;
    for (uint64_t i = 0; i < kBatch; ++i) scenes.push_back(scenes::draw_example_scene(seed, first + i));
    return scenes;
}

ExampleLabel label_of(const scenes::ExampleScene& scene) {
    const gpu::WardMaterial& material = scene.materials.front();
    const glm::vec3 kd(material.kd_weight), ks(material.ks_alpha);
    const Perceptual w = perceptual_of({glm::dvec3(kd), glm::dvec3(ks), double{material.ks_alpha.w}});
    ExampleLabel label;
    std::transform(w.begin(), w.end(), label.w, [](double value) { return static_cast<float>(value); });
    for (int c = 0; c < 3; ++c) {
        label.kd[c] = kd[c];
        label.ks[c] = ks[c];
    }
    label.alpha = material.ks_alpha.w;
    label.normal_error_degrees = scene.normal_error_degrees;
    label.windows = scene.scene.windows;
    return label;
}

/// Those that show anything, as many as the file still takes.
void write_batch(const std::vector<scenes::ExampleScene>& scenes, const RenderedExamples& rendered,
                 ExampleFileWriter& writer) {
    const std::vector<uint16_t> halves = rendered.halves.as<uint16_t>();
    const std::vector<uint32_t> drawn = rendered.drawn.as<uint32_t>();
    for (size_t i = 0; i < scenes.size() && !writer.is_full(); ++i) {
        if (drawn[i * gpu::kHemiSamples] == gpu::kNoRecord) continue;
        writer.write(label_of(scenes[i]), std::span(halves).subspan(i * gpu::kExampleHalves, gpu::kExampleHalves));
    }
}

}  // namespace

void synthesise_hemi_images(vulkan::Device& device, const SynthHemiOptions& options) {
    ExampleFileWriter writer(options.out, options.seed, options.examples, options.map);
    ExampleRenderer renderer(device, kBatch, options.map);
    Progress progress("Writing examples", options.examples, options.quiet);
    InterruptGuard interrupt;
    std::vector<scenes::ExampleScene> scenes = draw_batch(options.seed, 0);
    for (uint64_t first = kBatch; !writer.is_full(); first += kBatch) {
        const RenderedExamples rendered = renderer.submit(options.seed, first - kBatch, scenes);
        std::vector<scenes::ExampleScene> next = draw_batch(options.seed, first);  // while the device works
        renderer.wait();
        write_batch(scenes, rendered, writer);
        scenes = std::move(next);
        progress.update(writer.written(), options.out.filename().string());
        if (interrupt.requested()) {
            throw Interrupted("interrupted after ", writer.written(), " of ", options.examples,
                              " examples; nothing is left in '", options.out.string(), "'");
        }
    }
    writer.finish();
    if (!options.quiet)
        print_out("{} examples of seed {} in {}\n", options.examples, options.seed, printable(options.out.string()));
}

}  // namespace patina::tools
