#pragma once

#include <span>
#include <vector>

#include "engine/graph/runner.h"
#include "passes/specular/perceptual.h"
#include "passes/state/lights.h"
#include "passes/state/observation_map.h"
#include "passes/state/segment_samples.h"
#include "passes/state/ward_fits.h"
#include "tools/synth/example_renderer.h"

namespace patina {

/// What became of examples' scenes.
struct ExampleBatch {
    std::vector<scenes::ExampleScene> scenes;
    std::vector<uint16_t> halves;  ///< as tools::RenderedExamples, and so on
    std::vector<uint32_t> drawn;
    std::vector<gpu::ExampleReading> readings;
    std::vector<float> exposures;

    /// Voxels were seen often enough for a HemiImage.
    bool is_example(size_t scene) const { return drawn[scene * gpu::kHemiSamples] != gpu::kNoRecord; }
    bool is_lit_by_lamps(size_t scene) const { return scenes[scene].scene.windows == 0; }
};

/// Renders scenes with a renderer that keeps readings, and waits for them.
ExampleBatch render_examples(tools::ExampleRenderer& renderer, uint64_t seed, uint64_t first,
                             std::vector<scenes::ExampleScene> scenes);

/// The Ward fit on those of a batch's scenes that lamps alone light. It is told where these are, how strong, and which
/// reach a voxel, and is given of each voxel at most gpu::kMaxObservations readings, evenly among those that there are.
/// Of voxels of an example that share one of the map's, the first counts, as the map holds one surface in each. Voxels
/// stand apart: their highlights are not taken for blurred, as readings are of points.
class ExampleFit {
  public:
    /// For batches of `capacity` scenes.
    ExampleFit(vulkan::Device& device, uint32_t capacity);

    /// By scene, after so many fits; those of other scenes are zero. `network` tells alpha's prior, by scene, where it
    /// is not empty.
    std::vector<gpu::WardFit> fit(const ExampleBatch& batch, std::span<const WardParameters> network, uint32_t fits);

  private:
    void fill(const ExampleBatch& batch);
    std::vector<gpu::WardFit> fit_once(const ExampleBatch& batch, const std::vector<gpu::WardMaterial>& said);

    uint32_t capacity_;
    ObservationMap map_;
    SegmentSamples samples_;
    WardFits table_;
    graph::Runner runner_;
    std::vector<Lights> lights_;             ///< by scene
    std::vector<gpu::RecordStatus> status_;  ///< by record: marched, with its scene's lights
};

}  // namespace patina
