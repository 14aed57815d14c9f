// What a live session builds before its camera begins.

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <gmock/gmock.h>

#include "engine/vulkan/context.h"
#include "patina/session.h"
#include "reconstruction/api/access.h"
#include "reconstruction/session/session_core.h"
#include "tests/gpu/scenes/small_office.h"

namespace patina::warm_up_test {
namespace {

using ::testing::IsEmpty;

/// A camera without an end that shows the office, in metres and in units by turns: cameras send either.
class OfficeCamera : public Source {
  public:
    explicit OfficeCamera(const SmallOffice& office)
        : frames_(office, from_to(0, static_cast<uint32_t>(office.frames.size()) - 1), false), info_(frames_.info()) {
        info_.frames.reset();
    }
    const SequenceInfo& info() const override { return info_; }
    std::optional<Reading> next() override {
        std::optional<Reading> reading = frames_.next();
        if (!reading) return reading;
        auto& frame = std::get<Frame>(*reading);
        const auto* metres = std::get_if<Image<float>>(&frame.depth);
        if (!metres || frame.index % 2 == 0) return reading;
        Image<uint16_t> units(metres->extent());
        std::ranges::transform(metres->pixels(), units.pixels().begin(), [&](float depth_m) {
            return static_cast<uint16_t>(std::round(depth_m / info_.metres_per_unit));
        });
        frame.depth = std::move(units);
        return reading;
    }

  private:
    ChosenFrames frames_;
    SequenceInfo info_;
};

/// A pipeline takes up to a second to build: the camera would have moved on meanwhile.
TEST(WarmUp, TheFirstFramesOfALiveSourceFindTheirPipelinesBuilt) {
    Device device;  // nothing is built on it yet
    const vulkan::Context& context = Access::vulkan(device).context();
    ASSERT_THAT(context.built_pipelines(), IsEmpty());
    const SmallOffice office(Access::vulkan(device), 6);
    SessionOptions options;
    options.lighting = Lighting{.lights = {{{0, -1, 0.5}, glm::dvec3(4)}}};
    options.materials = Materials::kFit;
    for (const auto& [key, value] :
         {std::pair{"map.voxel_m", "0.02"}, {"fusion.truncation_m", "0.06"}, {"tracking.finest", "0"}})
        options.settings.set(key, value);
    Session session(device, std::make_unique<OfficeCamera>(office), options);
    std::vector<std::string> before = context.built_pipelines();
    SessionCore& core = Access::core(session);
    const Intrinsics picture = scaled_to(core.info().depth, {80, 66});
    for (size_t frame = 0; session.step(); ++frame) {
        EXPECT_TRUE(session.last()->fused) << session.last()->reason;
        core.pipeline().view(picture, core.fused()->world_from_camera.value());
        core.pipeline().wait();
        std::vector<std::string> now = context.built_pipelines(), added;
        std::ranges::set_difference(now, before, std::back_inserter(added));
        // Segments are joined when two of them turn out to be one: any time, or never.
        std::erase(added, "segmentation.relabel_records");
        EXPECT_THAT(added, IsEmpty()) << "in frame " << frame;
        before = std::move(now);
    }
}

}  // namespace
}  // namespace patina::warm_up_test
