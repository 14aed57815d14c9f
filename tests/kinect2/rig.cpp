#include "tests/kinect2/rig.h"

#include <thread>
#include <utility>

namespace patina::sensor::kinect2::testing {

Rig::Rig(SimulatedDeviceOptions options, DeviceOptions driver)
    : simulated(std::make_shared<SimulatedDevice>(std::move(options))) {
    auto over = std::make_unique<SimulatedTransport>(simulated);
    transport = over.get();
    device = std::make_unique<Device>(std::move(over), driver);
}

Rig::~Rig() {
    device.reset();
    EXPECT_EQ(simulated->complaint(), "");
}

DeviceOptions Rig::quick() {
    DeviceOptions options;
    options.silence = 200ms;
    options.readiness.interval = 0ms;
    return options;
}

void Rig::pass_frame_time() {
    transport->pass(kIntervalsPerFrame);
    while (device->statistics().transfers < transport->exchanges()) std::this_thread::sleep_for(100us);
}

std::optional<RawFrame> Rig::next(int most) {
    const uint64_t before = device->statistics().frames;
    for (int i = 0; i < most; ++i) {
        pass_frame_time();
        if (device->statistics().frames == before) continue;
        RawFrame frame;
        EXPECT_TRUE(device->next(frame));
        return frame;
    }
    return std::nullopt;
}

SimulatedDeviceOptions small_and_quick() {
    SimulatedDeviceOptions options;
    const auto frame = patterned_frame(1);
    options.infrared_images = [frame](uint32_t) { return frame; };
    options.pictures = [](uint32_t n) {
        SentPicture picture;
        picture.jpeg = {0xFF, 0xD8, static_cast<uint8_t>(n), 0, 0xFF, 0xD9};
        return picture;
    };
    return options;
}

}  // namespace patina::sensor::kinect2::testing
