#include "sensor/kinect2/settings.h"

#include <bit>
#include <cmath>
#include <string>
#include <thread>

#include <gmock/gmock.h>

#include "tests/kinect2/rig.h"

namespace patina::sensor::kinect2::testing::settings_test {
namespace {

using ::testing::HasSubstr;

float setting(const Rig& rig, uint32_t id) {
    return std::bit_cast<float>(rig.simulated->color_setting(id).value_or(0));
}

TEST(Kinect2Device, ExposureIsSetWhileRunningAndKeptByTheNextStart) {
    Rig rig(small_and_quick());
    rig.device->set_exposure(ManualExposure{5, 2});  // before the first start
    EXPECT_FALSE(rig.simulated->color_setting(0));
    rig.device->start();
    EXPECT_EQ(rig.simulated->color_setting(25), 0u);
    EXPECT_EQ(rig.simulated->color_setting(0), 4u);
    EXPECT_EQ(setting(rig, 1), 5);
    EXPECT_EQ(setting(rig, 21), 2);
    rig.device->set_exposure(SemiAutomaticExposure{100});
    EXPECT_EQ(rig.simulated->color_setting(0), 3u);
    EXPECT_EQ(setting(rig, 17), 100);
    rig.device->set_exposure(AutomaticExposure{-1.5f});
    EXPECT_EQ(rig.simulated->color_setting(0), 0u);
    EXPECT_EQ(setting(rig, 23), -1.5f);
    EXPECT_TRUE(rig.next()) << "the stream goes on";
}

TEST(Kinect2Device, SettingsFromAnotherThreadWaitWhileItStartsAnew) {
    SimulatedDeviceOptions options = small_and_quick();
    options.commands.failing = 0x2B;  // the first start ends in a reset
    options.commands.times = 1;
    Rig rig(options);
    std::string failure;
    std::jthread hand([&](const std::stop_token& stop) {
        failure = failure_of([&] {
            for (int i = 0; !stop.stop_requested(); ++i)
                rig.device->set_exposure(ManualExposure{1.0f + static_cast<float>(i % 5), 1});
        });
    });
    for (int run = 0; run < 30; ++run) rig.device->start();
    hand = {};
    EXPECT_EQ(failure, "none");
    EXPECT_EQ(rig.simulated->complaint(), "") << "no command reached a device that sleeps";
}

TEST(Kinect2Device, WhiteBalanceCanBeFixedAsItIs) {
    Rig rig(small_and_quick());
    rig.device->start();
    const WhiteBalanceGains gains = rig.device->white_balance();
    EXPECT_EQ(gains.red, 1.5f);
    rig.device->set_white_balance(WhiteBalanceGains{gains.red, 2, 3});
    EXPECT_EQ(rig.simulated->color_setting(10), 3u);
    EXPECT_EQ(setting(rig, 11), 1.5f);
    EXPECT_EQ(setting(rig, 12), 2);
    EXPECT_EQ(setting(rig, 13), 3);
    EXPECT_EQ(rig.device->white_balance().blue, 3);
    rig.device->set_white_balance(std::nullopt);
    EXPECT_EQ(rig.simulated->color_setting(10), 1u);
}

TEST(Kinect2Device, SettingsOutOfRangeAreRefusedBeforeTheDeviceSeesThem) {
    Rig rig(small_and_quick());
    for (const ExposureControl& wrong :
         {ExposureControl(AutomaticExposure{3}), ExposureControl(SemiAutomaticExposure{641}),
          ExposureControl(ManualExposure{67, 1}), ExposureControl(ManualExposure{-1, 1}),
          ExposureControl(ManualExposure{5, 0.5f}), ExposureControl(ManualExposure{NAN, 1})}) {
        EXPECT_THAT(failure_of([&] { rig.device->set_exposure(wrong); }), HasSubstr("must be within"));
    }
    EXPECT_THAT(failure_of([&] {
                    rig.device->set_white_balance(WhiteBalanceGains{1, 0, 1});
                }),
                HasSubstr("is 0, must be positive"));
    rig.device->start();
    EXPECT_FALSE(rig.simulated->color_setting(0));
}

}  // namespace
}  // namespace patina::sensor::kinect2::testing::settings_test
