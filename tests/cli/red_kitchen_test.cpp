#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "reconstruction/session/rgbd_frame.h"
#include "sensor/open.h"
#include "sensor/prefetch.h"
#include "tests/data_folder.h"

// A real recording: what the model looks like from the depth camera, against what that camera measured.

namespace patina::testing::red_kitchen_test {
namespace {

constexpr uint32_t kViewEvery = 10;

uint32_t frames_to_use() {
    const char* variable = std::getenv("PATINA_TEST_KITCHEN_FRAMES");
    return variable ? static_cast<uint32_t>(std::stoul(variable)) : PATINA_KITCHEN_FRAMES;
}

vulkan::DeviceOptions device_options() {
    const char* selector = std::getenv("PATINA_DEVICE");
    vulkan::DeviceOptions options;
    options.selector = selector ? selector : "";
    return options;
}

/// Differences between the model and the readings that were fused, over all views.
struct Comparison {
    std::vector<float> errors_m;
    size_t readings = 0;

    void add(const ModelView& view, const Image<uint16_t>& depth_mm, float max_depth_m) {
        for (size_t i = 0; i < depth_mm.pixels().size(); ++i) {
            const float reading_m = static_cast<float>(depth_mm.pixels()[i]) * 0.001f;
            if (reading_m == 0 || reading_m > max_depth_m) continue;
            ++readings;
            const float model_m = view.position_m.pixels()[i].w;
            if (model_m > 0) errors_m.push_back(std::abs(model_m - reading_m));
        }
    }

    float quantile(double share) {
        const auto at = errors_m.begin() + static_cast<ptrdiff_t>(share * static_cast<double>(errors_m.size() - 1));
        std::nth_element(errors_m.begin(), at, errors_m.end());
        return *at;
    }
};

TEST(RedKitchen, ModelIsWhereTheDepthCameraSawIt) {
    const auto folder = data_folder("rgbd-redkitchen");
    if (!folder) GTEST_SKIP() << kNoData;
    sensor::PrefetchSource source(sensor::open_sequence(*folder));
    const SequenceInfo& info = source.info();
    ASSERT_EQ(info.metres_per_unit, 0.001);

    vulkan::Device device(device_options());
    Pipeline pipeline(device, {});
    Comparison comparison;
    const uint32_t count = std::min(*info.frames, frames_to_use());
    for (uint32_t i = 0; i < count; ++i) {
        const auto frame = std::get<Frame>(source.next().value());
        pipeline.add(patina::to_rgbd(info, frame));
        if (i % kViewEvery != kViewEvery - 1) continue;
        const ViewReadback view = pipeline.view(info.depth, *frame.world_from_camera);
        pipeline.wait();
        comparison.add(view.get(), std::get<Image<uint16_t>>(frame.depth), pipeline.settings().fusion.max_depth_m);
    }
    ASSERT_FALSE(comparison.errors_m.empty());
    const double seen = static_cast<double>(comparison.errors_m.size()) / static_cast<double>(comparison.readings);
    RecordProperty("median_mm", std::to_string(1000 * comparison.quantile(0.5)));
    RecordProperty("percentile_90_mm", std::to_string(1000 * comparison.quantile(0.9)));
    RecordProperty("seen_percent", std::to_string(100 * seen));
    EXPECT_LE(comparison.quantile(0.5), 0.008f);
    EXPECT_LE(comparison.quantile(0.9), 0.02f);
    EXPECT_GT(seen, 0.9) << "share of the readings whose pixel shows the model";
    EXPECT_EQ(pipeline.counters().map.refused_blocks, 0u);
}

}  // namespace
}  // namespace patina::testing::red_kitchen_test
