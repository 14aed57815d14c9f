#include "tools/report/run_summary.h"

#include <limits>

#include <gmock/gmock.h>

#include "tests/export/full_summary.h"

namespace patina::run_summary_test {
namespace {

using nlohmann::ordered_json;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> keys(const ordered_json& object) {
    std::vector<std::string> names;
    for (const auto& [key, value] : object.items()) names.push_back(key);
    return names;
}

TEST(RunSummary, KeysKeepTheirOrder) {
    const ordered_json run = ordered_json::parse(run_json(test::full_summary()));
    EXPECT_THAT(keys(run), ElementsAre("format", "version", "id", "finished", "device", "driver", "seed", "settings",
                                       "lights", "sequence", "frames", "voxel_pool", "memory", "totals", "shortfalls",
                                       "warnings", "passes", "times", "files"));
    EXPECT_THAT(keys(run["settings"]), ElementsAre("voxel_mm", "truncation_vox", "note"));
    EXPECT_THAT(keys(run["passes"]), ElementsAre("input.filter_depth", "fusion.integrate", "fusion.raycast"));
    EXPECT_THAT(keys(ordered_json::parse(run_json({}))), keys(run));
}

TEST(RunSummary, TheIdIsOfAllButDurations) {
    RunSummary summary = test::full_summary();
    const std::string id = run_id(summary, 7);
    EXPECT_EQ(id.size(), 16u);
    summary.id = id;
    summary.times_s.emplace_back("more", 3);
    summary.passes.clear();
    EXPECT_EQ(run_id(summary, 7), id);
    EXPECT_NE(run_id(summary, 8), id);
    summary.seed += 1;
    EXPECT_NE(run_id(summary, 7), id);
}

TEST(RunSummary, EveryFieldArrives) {
    const ordered_json run = ordered_json::parse(run_json(test::full_summary()));
    EXPECT_EQ(run["format"], "patina-run");
    EXPECT_EQ(run["version"], "0.1.0");
    EXPECT_EQ(
        run["device"],
        ordered_json({{"name", "llvmpipe (LLVM 15.0.6, 256 bits)"}, {"type", "software"}, {"vulkan", "1.3.230"}}));
    EXPECT_EQ(run["driver"], "Mesa 22.3.6");
    EXPECT_EQ(run["seed"], 42);
    EXPECT_EQ(run["settings"]["note"], "a < b & \"c\"");
    EXPECT_EQ(run["sequence"]["name"], "red <kitchen>");
    EXPECT_EQ(run["sequence"]["frames"], 300);
    EXPECT_EQ(run["sequence"]["color"]["width"], 640);
    EXPECT_EQ(run["sequence"]["has_poses"], true);
    EXPECT_EQ(run["frames"]["read"], 299);
    EXPECT_EQ(run["frames"]["used"], 298);
    EXPECT_EQ(run["frames"]["skipped"][1], ordered_json({{"index", 20}, {"reason", "its pose is <NaN>"}}));
    EXPECT_EQ(run["voxel_pool"],
              ordered_json({{"blocks_used", 18342}, {"blocks_capacity", 65536}, {"blocks_refused", 12}}));
    EXPECT_EQ(run["memory"].at("transient images"), ordered_json({{"bytes", 31457280}, {"used", 5}, {"capacity", 8}}));
    EXPECT_EQ(run["totals"]["triangles"], 1234567);
    EXPECT_EQ(run["warnings"].size(), 1u);
    EXPECT_EQ(run["passes"].at("fusion.integrate"),
              ordered_json({{"count", 298}, {"min_ms", 3.2}, {"median_ms", 4.75}, {"max_ms", 61.0}}));
    EXPECT_EQ(run["times"], ordered_json({{"total_s", 61.25}, {"reading_s", 3.5}}));
}

TEST(RunSummary, ThePoolOfObservationsIsReportedWhereThereIsOne) {
    RunSummary summary = test::full_summary();
    summary.observation_pool = {900, 1000, 7, 3};
    EXPECT_EQ(ordered_json::parse(run_json(summary))["observation_pool"],
              ordered_json(
                  {{"records_used", 900}, {"records_capacity", 1000}, {"records_refused", 7}, {"blocks_refused", 3}}));
}

TEST(RunSummary, HowARunFellShortIsReportedWhereItDid) {
    RunSummary summary = test::full_summary();
    ordered_json run = ordered_json::parse(run_json(summary));
    for (const char* key : {"ended", "world_offset_m", "materials_missing"}) EXPECT_FALSE(run.contains(key)) << key;
    EXPECT_TRUE(run["shortfalls"].empty());
    summary.finished = false;
    summary.ended = "interrupted after 12 of 60 frames";
    summary.world_offset_m = {3e6, 0, -1};
    summary.materials_missing = "no lights";
    summary.shortfalls = {"a full pool"};
    run = ordered_json::parse(run_json(summary));
    EXPECT_EQ(run["ended"], "interrupted after 12 of 60 frames");
    EXPECT_EQ(run["world_offset_m"], ordered_json({3e6, 0, -1}));
    EXPECT_EQ(run["materials_missing"], "no lights");
    EXPECT_EQ(run["shortfalls"], ordered_json({"a full pool"}));
}

TEST(RunSummary, GainsAndHeldOutPicturesAreReportedWhereThereAreAny) {
    RunSummary summary = test::full_summary();
    summary.color_gains = {{0.5, 1, 2}, {0.25, 1, 1.5}, {0.75, 1, 4}};
    summary.held_out = {30,
                        {0.9, 20, 22},
                        PictureScore{0.8, 24, 26},
                        {0.9, 21, 23},
                        PictureScore{0.8, 25, 27},
                        PictureScore{0.8, 19, 18}};
    ordered_json run = ordered_json::parse(run_json(summary));
    EXPECT_EQ(run["color_gains"]["green"], ordered_json({{"min", 0.25}, {"median", 1.0}, {"max", 1.5}}));
    EXPECT_EQ(run["color_gains"]["blue"]["max"], 4.0);
    EXPECT_EQ(run["held_out"]["pictures"], 30);
    EXPECT_EQ(run["held_out"]["mean_color"]["psnr_srgb_db"], 22.0);
    EXPECT_EQ(run["held_out"]["reflectance"]["coverage"], 0.8);
    EXPECT_EQ(run["held_out"]["mean_color_own_gain"]["psnr_srgb_db"], 23.0);
    EXPECT_EQ(run["held_out"]["reflectance_own_gain"]["psnr_linear_db"], 25.0);
    EXPECT_EQ(run["held_out"]["records"]["psnr_srgb_db"], 18.0);
    summary.held_out->reflectance.reset();
    EXPECT_TRUE(ordered_json::parse(run_json(summary))["held_out"]["reflectance"].is_null());
}

std::string without_times(const std::string& text) {
    ordered_json run = ordered_json::parse(text);
    run.erase("times");
    run.erase("passes");
    return run.dump();
}

TEST(RunSummary, TwoRunsDifferInTimesAndPassesOnly) {
    RunSummary other = test::full_summary();
    for (PassTime& pass : other.passes)
        pass = {pass.name, pass.count, pass.min_ms * 2, pass.median_ms * 2, pass.max_ms * 2};
    for (auto& [name, seconds] : other.times_s) seconds *= 2;
    const std::string first = run_json(test::full_summary()), second = run_json(other);
    EXPECT_EQ(first, run_json(test::full_summary()));
    EXPECT_NE(first, second);
    EXPECT_EQ(without_times(first), without_times(second));
}

TEST(RunSummary, StaysJsonWhateverItHolds) {
    RunSummary summary;
    summary.warnings = {"not UTF-8: \xff\xfe", "a\nline\tand \"quotes\""};
    summary.times_s = {{"total", std::numeric_limits<double>::quiet_NaN()}};
    const std::string text = run_json(summary);
    const ordered_json run = ordered_json::parse(text);
    EXPECT_TRUE(run["times"]["total_s"].is_null());
    EXPECT_THAT(run["warnings"][0].get<std::string>(), HasSubstr("not UTF-8: \xef\xbf\xbd"));
    EXPECT_EQ(run["warnings"][1], "a\nline\tand \"quotes\"");
    EXPECT_EQ(text.back(), '\n');
}

}  // namespace
}  // namespace patina::run_summary_test
