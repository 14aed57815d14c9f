#include "reconstruction/api/statistics.h"

#include <algorithm>

namespace patina {

PassTime summarised(const graph::Timing& timing) {
    std::vector<float> sorted = timing.samples_ms;
    std::sort(sorted.begin(), sorted.end());
    return {timing.name, sorted.size(), sorted.front(), sorted[sorted.size() / 2], sorted.back()};
}

Statistics statistics_of(Pipeline& pipeline) {
    Statistics statistics;
    statistics.frames = pipeline.frames();
    const PipelineCounters counted = pipeline.counters();
    statistics.visible_blocks = counted.visible_blocks;
    statistics.segments = counted.segments.live;
    for (const PoolState& pool : counted.pools)
        statistics.pools.push_back({pool.name, pool.used, pool.capacity, pool.refused});
    for (const graph::Timing& timing : pipeline.runner().pass_timings())
        if (!timing.samples_ms.empty()) statistics.passes.push_back(summarised(timing));
    return statistics;
}

}  // namespace patina
