#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "patina/error.h"
#include "reconstruction/setting_table.h"

namespace patina::settings_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// All parts on.
ReconstructionSettings all_on() {
    ReconstructionSettings settings;
    for (const SettingDescriptor& setting : setting_descriptors())
        set_setting(settings, setting.key, setting.default_value, "test");
    return settings;
}

std::string digits(double number) {
    std::ostringstream out;
    out.precision(17);
    out << number;
    return out.str();
}

/// The number before or after `number` that a setting of this type can tell apart.
std::string beyond(const SettingDescriptor& setting, double number, double towards) {
    if (setting.type == SettingType::kWhole) return digits(number + (towards > number ? 1 : -1));
    return digits(double{std::nextafter(static_cast<float>(number), static_cast<float>(towards))});
}

bool is_number(const SettingDescriptor& setting) {
    return setting.type == SettingType::kNumber || setting.type == SettingType::kWhole;
}

/// A value that is allowed and not the default.
std::string other_value(const SettingDescriptor& setting) {
    if (setting.type == SettingType::kFlag) return setting.default_value == "true" ? "false" : "true";
    if (setting.type == SettingType::kWord)
        return setting.default_value == setting.words[0] ? setting.words[1] : setting.words[0];
    return digits(setting.min) == setting.default_value ? digits(setting.max) : digits(setting.min);
}

TEST(Settings, EveryKeyIsSetAndReadBackAndNoOtherChanges) {
    ASSERT_GT(setting_descriptors().size(), 100u);
    for (const SettingDescriptor& setting : setting_descriptors()) {
        SCOPED_TRACE(setting.key);
        ReconstructionSettings settings = all_on();
        const nlohmann::ordered_json before = settings_json(settings);
        set_setting(settings, setting.key, other_value(setting), "test");
        EXPECT_NE(get_setting(settings, setting.key), setting.default_value);
        const nlohmann::ordered_json after = settings_json(settings);
        for (const auto& [key, value] : before.items()) EXPECT_EQ(value != after[key], key == setting.key) << key;
        set_setting(settings, setting.key, setting.default_value, "test");
        EXPECT_EQ(get_setting(settings, setting.key), setting.default_value);
    }
}

TEST(Settings, KeysAreUniqueAndDescribed) {
    std::set<std::string> keys;
    for (const SettingDescriptor& setting : setting_descriptors()) {
        SCOPED_TRACE(setting.key);
        EXPECT_TRUE(keys.insert(setting.key).second);
        EXPECT_EQ(std::count(setting.key.begin(), setting.key.end(), '.'), 1);
        EXPECT_THAT(setting.sentence, ::testing::EndsWith("."));
    }
}

TEST(Settings, BothEndsOfTheRangeAreAcceptedAndOneStepBeyondIsRefused) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (const SettingDescriptor& setting : setting_descriptors()) {
        if (!is_number(setting)) continue;
        SCOPED_TRACE(setting.key);
        ReconstructionSettings settings;
        for (const double end : {setting.min, setting.max}) {
            EXPECT_NO_THROW(set_setting(settings, setting.key, digits(end), "test"));
            const double stored = std::stod(*get_setting(settings, setting.key));
            EXPECT_EQ(static_cast<float>(stored), static_cast<float>(end));
        }
        const auto set = [&](const std::string& value) { set_setting(settings, setting.key, value, "test"); };
        const auto refused = ThrowsMessage<Error>(HasSubstr(", it must be " + allowed_values(setting)));
        EXPECT_THAT([&] { set(beyond(setting, setting.min, -kInfinity)); }, refused);
        EXPECT_THAT([&] { set(beyond(setting, setting.max, kInfinity)); }, refused);
        EXPECT_THAT([&] { set("nan"); }, refused);
        EXPECT_THAT([&] { set(""); }, refused);
    }
}

TEST(Settings, DefaultsLieInTheirRanges) {
    ReconstructionSettings settings;
    for (const SettingDescriptor& setting : setting_descriptors())
        EXPECT_NO_THROW(set_setting(settings, setting.key, setting.default_value, "test"));
}

TEST(Settings, APartThatIsOffHasNoValues) {
    ReconstructionSettings settings;
    EXPECT_EQ(get_setting(settings, "tracking.levels"), std::nullopt);
    EXPECT_EQ(get_setting(settings, "map.voxel_m"), "0.005");
    EXPECT_FALSE(settings_json(settings).contains("tracking.levels"));
    EXPECT_THROW(set_setting(settings, "tracking.levels", "9", "test"), Error);
    EXPECT_FALSE(settings.tracking) << "what is refused turns nothing on";
    set_setting(settings, "tracking.levels", "4", "test");
    EXPECT_EQ(get_setting(settings, "tracking.levels"), "4");
    EXPECT_EQ(settings_json(settings)["tracking.iterations"], 4);
}

TEST(Settings, MessagesNameWhereKeyValueAndRange) {
    const auto complaint = [](const std::string& assignment) {
        try {
            ReconstructionSettings settings;
            apply_setting(settings, assignment, "here");
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    EXPECT_EQ(complaint("map.voxel_m=2"), "here: map.voxel_m is 2, it must be a number from 0.0001 to 1 m");
    EXPECT_EQ(complaint("map.voxel_m=thick"), "here: map.voxel_m is 'thick', it must be a number from 0.0001 to 1 m");
    EXPECT_EQ(complaint("observe.stride_px=1.5"),
              "here: observe.stride_px is 1.5, it must be a whole number from 1 to 64 px");
    EXPECT_EQ(complaint("fusion.color=2"), "here: fusion.color is 2, it must be true or false");
    EXPECT_EQ(complaint("keyframes.tests=color"), "here: keyframes.tests is 'color', it must be all or depth");
    EXPECT_EQ(complaint("map.voxel=1"), "here: there is no setting 'map.voxel'; did you mean 'map.voxel_m'?");
    EXPECT_THAT(complaint("colour=1"), HasSubstr("there is no setting 'colour'; known are map.voxel_m, "));
    EXPECT_EQ(complaint("map.voxel_m"), "here: 'map.voxel_m' has no '=' between key and value");
}

class SettingsFile : public ::testing::Test {
  protected:
    ReconstructionSettings loaded(const std::string& content) const {
        std::ofstream(file_) << content;
        ReconstructionSettings settings;
        load_settings(settings, file_);
        return settings;
    }

    std::string complaint(const std::string& content) const {
        try {
            loaded(content);
        } catch (const Error& error) {
            return error.what();
        }
        return "no error";
    }

    void TearDown() override { std::filesystem::remove(file_); }

    const std::filesystem::path file_ =
        std::filesystem::path(::testing::TempDir()) /
        (std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) + ".toml");
};

TEST_F(SettingsFile, ValuesOfEveryTypeAreRead) {
    const ReconstructionSettings settings = loaded(
        "[map]\nvoxel_m = 0.02\ncapacity_blocks = 0x10\n[fusion]\ncolor = false\nmax_depth_m = 3\n"
        "[keyframes]\ntests = \"depth\"\n");
    EXPECT_EQ(settings.map.voxel_m, 0.02f);
    EXPECT_EQ(settings.map.limit_blocks, 16u);
    EXPECT_FALSE(settings.fusion.color);
    EXPECT_EQ(settings.fusion.max_depth_m, 3.0f);
    ASSERT_TRUE(settings.keyframes);
    EXPECT_EQ(settings.keyframes->tests, KeyframeTests::kDepth);
}

TEST_F(SettingsFile, AllSettingsOfARunAreReadAgain) {
    std::string content;
    for (const SettingDescriptor& setting : setting_descriptors()) {
        const std::string value = other_value(setting);
        content += setting.key + " = " + (setting.type == SettingType::kWord ? '"' + value + '"' : value) + '\n';
    }
    // Dotted keys make the same tables.
    const ReconstructionSettings settings = loaded(content);
    for (const SettingDescriptor& setting : setting_descriptors())
        EXPECT_NE(get_setting(settings, setting.key), setting.default_value) << setting.key;
}

TEST_F(SettingsFile, MessagesNameTheFile) {
    EXPECT_THAT(complaint("[map]\nvoxel_m = 2\n"),
                HasSubstr(file_.string() + ": map.voxel_m is 2, it must be a number from 0.0001 to 1 m"));
    EXPECT_THAT(complaint("[map]\nvoxel_m = \"0.02\"\n"), HasSubstr("map.voxel_m is '\"0.02\"', it must be"));
    EXPECT_THAT(complaint("[map]\nvoxel_m = true\n"), HasSubstr("map.voxel_m is 'true', it must be"));
    EXPECT_THAT(complaint("[map]\nvoxel_m = inf\n"), HasSubstr("map.voxel_m is 'inf', it must be"));
    EXPECT_THAT(complaint("[map]\nvoxels = 3\n"), HasSubstr("there is no setting 'map.voxels'; did you mean"));
    EXPECT_THAT(complaint("voxel_m = 3\n"), HasSubstr("'voxel_m' is not a table of settings"));
}

TEST(Settings, ThePageOfTheDocumentsIsTheTable) {
    std::ifstream stream(PATINA_SOURCE_DIR "/docs/settings.md", std::ios::binary);
    const std::string page{std::istreambuf_iterator<char>(stream), {}};
    EXPECT_EQ(page, settings_page()) << "patina settings --markdown > docs/settings.md";
}

}  // namespace
}  // namespace patina::settings_test
