#include "reconstruction/session/detail.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reconstruction/api/access.h"
#include "reconstruction/session/choose_settings.h"

namespace patina::detail_test {
namespace {

using ::testing::HasSubstr;

SequenceInfo camera(double fx) {
    SequenceInfo info;
    info.depth.fx = fx;
    return info;
}

Detail level_at(double median_m, double p95_m, double fx) {
    return choose_detail({}, camera(fx), sensor::DepthStatistics{1, median_m / 2, median_m, p95_m}).level;
}

TEST(Detail, IsFineForWhatLiesOnATableAndCoarseForHalls) {
    EXPECT_EQ(level_at(0.55, 0.64, 610), Detail::kFine);
    EXPECT_EQ(level_at(0.55, 3.0, 610), Detail::kNormal) << "what is behind the table would be lost";
    EXPECT_EQ(level_at(0.55, 0.64, 300), Detail::kNormal) << "a pixel covers 1.8 mm";
    for (const double room_m : {0.9, 1.9, 3.0, 4.0}) EXPECT_EQ(level_at(room_m, 2 * room_m, 365), Detail::kNormal);
    EXPECT_EQ(level_at(5, 9, 365), Detail::kCoarse);
    EXPECT_EQ(level_at(5, 9, 1500), Detail::kNormal) << "a pixel covers 3.3 mm";
    EXPECT_EQ(level_at(1112, 2000, 365), Detail::kNormal) << "millimetres taken for metres";
}

TEST(Detail, ReasonsAreTold) {
    const DetailChoice fine = choose_detail({}, camera(610), sensor::DepthStatistics{1, 0.4, 0.55, 0.64});
    EXPECT_EQ(fine.because, "the median depth is 0.55 m, where a pixel covers 0.9 mm");
    EXPECT_THAT(sentence_of(fine, {}, 6.93),
                HasSubstr("detail: fine, voxels of 5 mm, depth up to 6.93 m, since the median"));
    EXPECT_THAT(choose_detail({}, camera(610), std::nullopt).because, HasSubstr("not looked at"));
    EXPECT_EQ(choose_detail({}, camera(610), sensor::DepthStatistics{}).level, Detail::kNormal) << "no reading";
}

TEST(Detail, WhatIsAskedForGoesBeforeWhatIsSeen) {
    SessionOptions options;
    options.detail = Detail::kCoarse;
    EXPECT_EQ(choose_detail(options, camera(610), sensor::DepthStatistics{1, 0.4, 0.55, 0.64}).level, Detail::kCoarse);
}

TEST(Detail, NormalChangesNothing) {
    Settings settings;
    const ReconstructionSettings before = Access::values(settings);
    set_detail(settings, Detail::kNormal);
    EXPECT_EQ(Access::values(settings).map.voxel_m, before.map.voxel_m);
    EXPECT_EQ(Access::values(settings).fusion.truncation_m, before.fusion.truncation_m);
    EXPECT_EQ(Access::values(settings).fusion.max_depth_m, before.fusion.max_depth_m);
    EXPECT_EQ(values_of(Detail::kNormal).record_m, ReflectanceStageSettings().voxel_m);
    EXPECT_EQ(values_of(Detail::kNormal).observe_m, ReflectanceStageSettings().observe.max_distance_m);
}

TEST(Detail, SettingsThatAreGivenStay) {
    Settings settings;
    settings.set("fusion.max_depth_m", "8");  // the default, but asked for
    Access::assign(settings, "fusion.truncation_m=0.015", "--set");
    set_detail(settings, Detail::kFine);
    EXPECT_EQ(Access::values(settings).map.voxel_m, 0.0025f);
    EXPECT_EQ(Access::values(settings).fusion.max_depth_m, 8.0f);
    EXPECT_EQ(Access::values(settings).fusion.truncation_m, 0.015f);
}

TEST(Detail, ShadowsReachAsFarAsDepth) {
    const auto around_m = [](Detail level, const char* given = nullptr) {
        Settings settings;
        if (given) settings.set("map.around_m", given);
        set_detail(settings, level);
        return Access::values(settings).around_m;
    };
    EXPECT_EQ(around_m(Detail::kFine), 5.0f) << "a room throws shadows that the camera is too near to see";
    EXPECT_EQ(around_m(Detail::kNormal), 8.0f);
    EXPECT_EQ(around_m(Detail::kCoarse), 12.0f);
    EXPECT_EQ(around_m(Detail::kCoarse, "6"), 6.0f);
    EXPECT_EQ(ReconstructionSettings().around_m, around_m(Detail::kNormal));
}

/// The band is 16 voxels wide at most, wherever a reading is.
TEST(Detail, BandAndReachFollowTheVoxelThatWasGiven) {
    for (const char* voxel_m : {"0.001", "0.0025", "0.005", "0.02"}) {
        for (const Detail level : {Detail::kFine, Detail::kNormal, Detail::kCoarse}) {
            Settings settings;
            settings.set("map.voxel_m", voxel_m);
            set_detail(settings, level);
            const ReconstructionSettings& values = Access::values(settings);
            EXPECT_EQ(values.map.voxel_m, std::stof(voxel_m));
            const float band_m = least_truncation_m(values.fusion, values.map.voxel_m) +
                                 values.fusion.truncation_slope * values.fusion.max_depth_m;
            EXPECT_LE(band_m, 16.001f * values.map.voxel_m);
        }
    }
}

TEST(Detail, RecordsFollowTheLevel) {
    Illumination light;
    light.ambient = glm::dvec3(1);
    const auto record_m = [&](const SessionOptions& options) {
        return choose_settings(options, camera(365), light, std::nullopt).reflectance.value().voxel_m;
    };
    SessionOptions options;
    options.materials = Materials::kOff;
    options.detail = Detail::kCoarse;
    EXPECT_EQ(record_m(options), 0.04f);
    options.settings.set("reflectance.voxel_m", "0.02");
    EXPECT_EQ(record_m(options), 0.02f);
}

}  // namespace
}  // namespace patina::detail_test
