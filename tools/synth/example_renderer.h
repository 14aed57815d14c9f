#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/graph/runner.h"
#include "passes/state/network.h"
#include "passes/state/observation_map.h"
#include "passes/state/segment_samples.h"
#include "scenes/description/example_scene.h"

namespace patina::tools {

/// HemiImages of a batch of scenes, on their way from the device.
struct RenderedExamples {
    graph::Readback halves;  ///< u16[scene][gpu::kExampleHalves]: fp16, [sample][y][x][channel], then one of padding
    graph::Readback drawn;   ///< u32[scene][gpu::kHemiSamples]; gpu::kNoRecord where no voxel was seen often enough
    // For tests, empty unless asked for:
    graph::Readback readings{};   ///< gpu::ExampleReading[view][scene][voxel]
    graph::Readback exposures{};  ///< float[scene]: linear pixel value per radiance
};

/// Renders example scenes through the pipeline's own passes: readings become observations by the insertion of
/// observation/insert_observation.glsl, view by view, and these HemiImages by add_hemi_images().
class ExampleRenderer {
  public:
    /// Throws Error when `capacity`, the scenes of a batch, is 0 or memory runs out.
    ExampleRenderer(vulkan::Device& device, uint32_t capacity, HemisphereMap map, bool keep_readings = false);

    /// Submits scenes `first`, ... of a seed; at most `capacity`. Ready after wait().
    RenderedExamples submit(uint64_t seed, uint64_t first, std::span<const scenes::ExampleScene> scenes);
    void wait() { runner_.wait(); }
    graph::Runner& runner() { return runner_; }

  private:
    struct Inputs;
    struct Shaded;
    void keep_all_voxels();
    Shaded add_shade(graph::FrameGraph& frame, const Inputs& inputs, const gpu::ExampleParams& params,
                     ObservationMapIds& ids);
    void add_insert(graph::FrameGraph& frame, graph::BufferId readings, uint32_t scenes, uint32_t view,
                    ObservationMapIds& ids);

    uint32_t capacity_;
    HemisphereMap hemisphere_map_;
    bool keep_readings_;
    ObservationMap map_;
    SegmentSamples samples_;
    graph::Runner runner_;
};

}  // namespace patina::tools
