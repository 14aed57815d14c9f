// Shadows in a fused model: a box on a floor.

#include "tests/reference/reflectance/find_visibility.h"

#include <algorithm>

#include "tests/gpu/gpu_test.h"
#include "tests/gpu/observation/observation_rig.h"
#include "tests/gpu/reflectance/reflectance_rig.h"
#include "tests/gpu/reflectance/surroundings_inputs.h"
#include "tests/reference/reflectance/refine_albedo.h"
#include "tools/bench/filled_records.h"

namespace patina::find_visibility_test {
namespace {

const Intrinsics kCamera{{192, 144}, 160, 160, 95.5, 71.5, {}};
const glm::dvec3 kBoxCenter{0, -0.15, 0}, kBoxHalf{0.15, 0.15, 0.1};
const std::vector<Light> kLights = {{{0.8f, -1.0f, 0.1f}, {1.5f, 1.5f, 1.5f}}, {{-0.5f, -1.4f, -0.6f}, {1, 1, 1}}};

double scene(glm::dvec3 p) {
    return std::min(reference::box(kBoxCenter, kBoxHalf)(p), reference::half_space({0, -1, 0}, 0)(p));
}

/// The way from a point to another passes through the box.
bool box_between(glm::dvec3 from, glm::dvec3 to) {
    double enter = 0, leave = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double way = to[axis] - from[axis], center = kBoxCenter[axis] - from[axis];
        const double a = (center - kBoxHalf[axis]) / way, b = (center + kBoxHalf[axis]) / way;
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter < leave;
}

enum class Shade { kLit, kShadow, kBorder };

/// Of a point of the floor; `border_m`: how near to the shadow's edge it counts as that.
Shade floor_shade(glm::dvec3 point, glm::dvec3 light, double border_m) {
    const bool shadow = box_between(point, light);
    for (int i = 0; i < 16; ++i) {
        const double angle = i * 0.3927;
        if (box_between(point + border_m * glm::dvec3(std::cos(angle), 0, std::sin(angle)), light) != shadow)
            return Shade::kBorder;
    }
    return shadow ? Shade::kShadow : Shade::kLit;
}

/// Of the scene from above, from around.
RigFrame view(int i) {
    const double azimuth = i * 1.0472;
    RigFrame frame;
    frame.camera = kCamera;
    frame.world_from_camera =
        reference::look_at({1.1 * std::cos(azimuth), -1.1, 1.1 * std::sin(azimuth)}, {0, -0.1, 0});
    frame.depth_m = reference::render_depth(scene, kCamera, frame.world_from_camera, 4);
    frame.color = {kCamera, frame.world_from_camera, Image<glm::vec4>(kCamera.extent, glm::vec4(0.2f, 0.2f, 0.2f, 1))};
    return frame;
}

/// A floor with a box, fused and observed from six sides.
class FindVisibilityTest : public GpuTest {
  protected:
    static constexpr int kFrames = 6;

    struct Model {
        Model(vulkan::Device& device, graph::Runner& runner, float voxel_m = 0.02f)
            : observations(device, runner, {.voxel_m = voxel_m, .capacity_records = 131072}),
              reflectance(device, runner, observations.fusion().map(), observations.map()) {
            reflectance.lights.set(kLights);
        }
        ObservationRig observations;
        ReflectanceRig reflectance;
    };

    static const std::vector<RigFrame>& frames() {
        static const std::vector<RigFrame> all = [] {
            std::vector<RigFrame> made;
            for (int i = 0; i < kFrames; ++i) made.push_back(view(i));
            return made;
        }();
        return all;
    }

    std::unique_ptr<Model> make_model(float voxel_m = 0.02f) {
        auto model = std::make_unique<Model>(device(), runner(), voxel_m);
        for (const RigFrame& frame : frames()) {
            model->observations.fuse(frame);
            model->observations.collect(frame);
        }
        return model;
    }
};

bool on_floor(const RefinedRecord& record) {
    const glm::dvec3 apart = glm::abs(record.point_m - kBoxCenter) - kBoxHalf;
    return record.observations > 0 && record.normal.y < -0.99 && std::abs(record.point_m.y) < 0.01 &&
           std::max(apart.x, apart.z) > 0.04;
}

TEST_F(FindVisibilityTest, WhatLiesOutsideTheBallThrowsNoShadow) {
    const auto model = make_model();
    const auto shadows_within = [&](float radius_m) {
        // Around a place on the floor beside the box, away from the first light: the box is 0.2 m off at least.
        const glm::vec3 place(-0.45f, 0, 0);
        model->reflectance.part.ball_m = glm::vec4(place, radius_m);
        model->reflectance.lights.set(kLights);  // so that all are marched anew
        model->reflectance.update_all({});
        uint32_t shadows = 0;
        for (const RefinedRecord& record : model->reflectance.records()) {
            if (!on_floor(record) || glm::distance(record.point_m, glm::dvec3(place)) > 0.15) continue;
            shadows += (record.visible & 1) == 0 ? 1 : 0;
        }
        return shadows;
    };
    EXPECT_GT(shadows_within(RefinedPart::kEverywhere_m), 40u);
    EXPECT_GT(shadows_within(1), 40u);
    EXPECT_EQ(shadows_within(0.18f), 0u) << "the box is not looked at";
}

TEST_F(FindVisibilityTest, RecordsOutsideTheCubeHaveNoTurn) {
    const auto model = make_model();
    const glm::dvec3 center(0.3, 0, 0.1);
    constexpr double kHalf_m = 0.2, kBlock_m = 0.04;
    model->reflectance.part.cube_m = glm::vec4(glm::vec3(center), static_cast<float>(kHalf_m));
    model->reflectance.update_all({});
    uint32_t inside = 0, outside = 0;
    for (const RefinedRecord& record : model->reflectance.records()) {
        if (record.observations == 0) continue;
        const glm::dvec3 block = (glm::floor(record.point_m / kBlock_m) + 0.5) * kBlock_m;
        const glm::dvec3 apart = glm::abs(block - center) - kHalf_m;
        const double beyond_m = std::max({apart.x, apart.y, apart.z});
        if (std::abs(beyond_m) < kBlock_m) continue;  // a surface beside a block may be its record's
        if (beyond_m < 0) {
            inside += record.visible != 0 ? 1 : 0;
        } else {
            EXPECT_EQ(record.visible, 0u) << "its lights were not looked for";
            ++outside;
        }
    }
    EXPECT_GT(inside, 100u);
    EXPECT_GT(outside, 1000u);
}

TEST_F(FindVisibilityTest, BitsAreTheShadowsOfTheBox) {
    const auto model = make_model();
    model->reflectance.update_all({});
    for (size_t light = 0; light < kLights.size(); ++light) {
        const glm::dvec3 position(kLights[light].position_m);
        uint32_t lit = 0, shadow = 0, border = 0, border_uncertain = 0, far_uncertain = 0;
        for (const RefinedRecord& record : model->reflectance.records()) {
            if (!on_floor(record)) continue;
            const bool reached = record.visible >> light & 1, uncertain = record.uncertain >> light & 1;
            const Shade shade = floor_shade(record.point_m, position, 0.015);
            if (shade == Shade::kBorder) {
                ++border;
                border_uncertain += uncertain;
                continue;
            }
            EXPECT_EQ(reached, shade == Shade::kLit) << light << " at " << record.point_m.x << ' ' << record.point_m.z;
            (shade == Shade::kLit ? lit : shadow) += 1;
            far_uncertain += uncertain && floor_shade(record.point_m, position, 0.05) != Shade::kBorder;
        }
        EXPECT_GT(lit, 1000u);
        EXPECT_GT(shadow, 50u);
        EXPECT_GT(border_uncertain, 0.55 * border);
        // Rays that graze a face of the box.
        EXPECT_LT(far_uncertain, 0.02 * (lit + shadow));
    }
}

// Half of the ceiling shows the sky, the other is a ceiling.
TEST_F(FindVisibilityTest, ASunShinesInWhereTheSkyWasSeen) {
    constexpr double kEdge_m = 0.6;
    const auto model = make_model();
    const glm::dvec3 to_sun = glm::normalize(glm::dvec3(0.4, -1, 0.2));
    model->reflectance.lights.set(std::vector<Light>{{1e4 * to_sun, {1e8, 1e8, 1e8}}});
    const auto lit_and_not = [&](const std::function<bool(glm::dvec3)>& open) {
        model->reflectance.update_all({});
        uint32_t lit = 0, dark = 0;
        for (const RefinedRecord& record : model->reflectance.records()) {
            if (!on_floor(record) || std::max(std::abs(record.point_m.x), std::abs(record.point_m.z)) > 0.6) continue;
            const glm::dvec3 above = record.point_m + to_sun * (kCeiling_m / to_sun.y);
            const Shade shade = floor_shade(record.point_m, record.point_m + 3.0 * to_sun, 0.015);
            if (shade == Shade::kBorder || std::abs(above.x - kEdge_m) < 0.08) continue;
            const bool expected = shade == Shade::kLit && open(above);
            EXPECT_EQ(record.visible & 1, expected ? 1u : 0u) << record.point_m.x << ' ' << record.point_m.z;
            ++(expected ? lit : dark);
        }
        return std::pair(lit, dark);
    };
    const auto [everywhere, shadow] = lit_and_not([](glm::dvec3) { return true; });
    EXPECT_GT(everywhere, 1000u) << "nothing is known of what is around";
    EXPECT_GT(shadow, 20u);
    model->reflectance.change([&](graph::FrameGraph& frame, ReflectanceStateIds& state) {
        add_ceiling(frame, state, [](double x, double) { return x > kEdge_m ? 0.9f : 0.3f; });
    });
    const auto [lit, dark] = lit_and_not([](glm::dvec3 above) { return above.x > kEdge_m; });
    EXPECT_GT(lit, 500u);
    EXPECT_GT(dark, shadow + 300u);
}

// The ceiling and the floor at low exposure: a patch of sun on the floor.
TEST_F(FindVisibilityTest, RecordsTellWhatLowExposureShowedOfThemWhereItIsBright) {
    const auto model = make_model();
    model->reflectance.change([&](graph::FrameGraph& frame, ReflectanceStateIds& state) {
        const RigFrame seen = view(0);
        Image<glm::vec4> color(kCamera.extent, glm::vec4(0, 0, 0, 1));
        for (uint32_t y = 0; y < kCamera.extent.height; ++y) {
            for (uint32_t x = 0; x < kCamera.extent.width; ++x) {
                const glm::dvec3 way((x - kCamera.cx) / kCamera.fx, (y - kCamera.cy) / kCamera.fy, 1);
                const glm::dvec3 at(seen.world_from_camera * glm::dvec4(way * double{seen.depth_m.at(x, y)}, 1));
                color.at(x, y) = at.z > 0 ? glm::vec4(0.5f, 0.4f, 0.3f, 1) : glm::vec4(0.1f, 0.1f, 0.1f, 1);
            }
        }
        SurroundingsInputs inputs = upload_surroundings(frame, kCamera, seen.world_from_camera, seen.depth_m, color);
        inputs.radiance_scale = 4;
        inputs.lamp_luminance = 1;
        for (inputs.frame_index = 0; inputs.frame_index < 16; ++inputs.frame_index)
            add_collect_surroundings(frame, state, inputs);
    });
    model->reflectance.part.cube_m = glm::vec4(0.425f, 0, 0, 0.45f);  // rays of all others would take most of the time
    model->reflectance.update_all({.gathered_rays = 4});
    uint32_t bright = 0, dull = 0;
    for (const RefinedRecord& record : model->reflectance.records()) {
        const bool looked_at = record.point_m.x > 0.25 && record.point_m.x < 0.6 && std::abs(record.point_m.z) < 0.4;
        if (!on_floor(record) || !looked_at || std::abs(record.point_m.z) < 0.06) continue;
        const bool sunny = record.point_m.z > 0;
        EXPECT_LT(glm::distance(record.bright, sunny ? glm::dvec3(2, 1.6, 1.2) : glm::dvec3(0)), 0.02);
        ++(sunny ? bright : dull);
    }
    EXPECT_GT(bright, 100u);
    EXPECT_GT(dull, 100u);
}

TEST_F(FindVisibilityTest, BitsAgreeWithTheReferenceOnEverySurface) {
    const auto model = make_model();
    model->reflectance.update_all({});
    const reference::Volume volume = model->observations.fusion().volume();
    uint32_t compared = 0;
    for (const RefinedRecord& record : model->reflectance.records()) {
        for (size_t light = 0; light < kLights.size(); ++light) {
            const glm::dvec3 offset = glm::dvec3(kLights[light].position_m) - record.point_m;
            const glm::dvec3 direction = glm::normalize(offset);
            const double cosine = glm::dot(direction, record.normal);
            if (record.observations == 0 || cosine < 0.4) continue;
            const double least_m = reference::least_distance_m(volume, record.point_m + direction * (0.0125 / cosine),
                                                               record.point_m + offset - 0.165 * direction);
            if (std::abs(least_m) < 0.0025 || (record.uncertain >> light & 1)) continue;
            EXPECT_EQ(record.visible >> light & 1, least_m > 0 ? 1u : 0u);
            ++compared;
        }
    }
    EXPECT_GT(compared, 5000u);
}

TEST_F(FindVisibilityTest, WithoutShadowsEveryLightReachesEveryRecord) {
    for (const float voxel_m : {0.01f, 0.02f}) {
        const auto model = make_model(voxel_m);
        ReflectanceSettings settings;
        settings.shadows = false;
        const auto counts = model->reflectance.update_all(settings);
        uint32_t observed = 0;
        for (const RefinedRecord& record : model->reflectance.records()) {
            if (record.observations == 0) continue;
            ++observed;
            EXPECT_EQ(record.visible, UINT64_MAX);
            EXPECT_EQ(record.uncertain, 0u);
        }
        EXPECT_EQ(counts.marched, observed);
        EXPECT_EQ(counts.refined, observed);
    }
}

TEST_F(FindVisibilityTest, TheMapIsReadAlikeThroughAllDescriptors) {
    const auto model = make_model();
    model->reflectance.update_all({});
    const auto records = model->reflectance.records();
    if (model->reflectance.access.voxels == MapAccess::kStorage)
        GTEST_SKIP() << "texel buffers are too small, or slower";
    model->reflectance.access = {};
    model->reflectance.update_all({});
    const auto again = model->reflectance.records();
    for (size_t i = 0; i < records.size(); ++i) EXPECT_EQ(records[i].visible, again[i].visible);
}

TEST_F(FindVisibilityTest, WorkFollowsChange) {
    const auto model = make_model();
    ReflectanceRig& rig = model->reflectance;
    ReflectanceSettings settings;
    settings.refreshed_records = 2000;
    uint32_t refined = 0, most_marched = 0;
    const auto go_around = [&] {
        refined = 0;
        for (int i = 0; i < 20; ++i) {
            const auto counts = rig.update(settings);
            refined += counts.refined;
            most_marched = std::max(most_marched, counts.marched);
        }
    };
    // All records have had their turn, once; then nothing is left to do.
    go_around();
    const auto records = rig.records();
    const auto observed = static_cast<uint32_t>(
        std::count_if(records.begin(), records.end(), [](const auto& record) { return record.observations > 0; }));
    EXPECT_GT(observed, 2000u);
    EXPECT_EQ(refined, observed);
    EXPECT_LT(most_marched, 2600u);
    go_around();
    EXPECT_EQ(refined, 0u);
    rig.update_all(settings);
    const auto again = rig.records();
    for (size_t i = 0; i < records.size(); ++i) {
        EXPECT_EQ(records[i].albedo, again[i].albedo);
        EXPECT_EQ(records[i].visible, again[i].visible);
    }

    // A brighter light: albedos change, in turn.
    auto lights = kLights;
    lights[0].intensity *= 2;
    rig.lights.set(lights);
    go_around();
    EXPECT_EQ(refined, observed);
    // A light that moved.
    lights[0].position_m.x += 0.2f;
    rig.lights.set(lights);
    go_around();
    EXPECT_EQ(refined, observed);
    // A material that no record has.
    rig.materials.set(7, glm::vec3(0.1f), 0.2f);
    go_around();
    EXPECT_EQ(refined, 0u);
}

TEST_F(FindVisibilityTest, WhereLittleChangesLittleIsMarchedAgain) {
    const auto model = make_model();
    ReflectanceRig& rig = model->reflectance;
    ReflectanceSettings settings;
    rig.update_all(settings);
    const auto count = static_cast<uint32_t>(rig.records().size());
    ASSERT_GT(count, gpu::kBusyChanges);
    settings.refreshed_records = 2000;
    const auto all = [&](graph::FrameGraph& frame, ObservationMapIds&) { return add_list_records(frame, count); };
    const auto mean_marched = [&](const auto& update) {
        uint32_t marched = 0;
        for (int i = 0; i < 20; ++i) marched += update().marched;
        return marched / 20.0;
    };
    const double resting = mean_marched([&] { return rig.update(settings); }),
                 moving = mean_marched([&] { return rig.update(settings, all); });
    EXPECT_GT(moving, 1000);
    EXPECT_NEAR(resting / moving, double{gpu::kLeastRefreshed}, 0.4 * double{gpu::kLeastRefreshed});
}

TEST_F(FindVisibilityTest, WhatWasNeverMarchedHasABudgetOfItsOwn) {
    const auto model = make_model();
    ReflectanceRig& rig = model->reflectance;
    const auto count = static_cast<uint32_t>(rig.records().size());
    const auto all = [&](graph::FrameGraph& frame, ObservationMapIds&) { return add_list_records(frame, count); };
    ReflectanceSettings settings;
    settings.refreshed_records = settings.marched_records = 1;
    settings.first_marched_records = count / 3;
    for (int update = 0; update < 4; ++update) {
        const uint32_t marched = rig.update(settings, all).marched;
        EXPECT_LT(marched, 0.4 * count);
        if (update < 3) {
            EXPECT_GT(marched, update == 0 ? 0.25 * count : 0.0);
        }
    }
    // Now that all were marched, what a light's move makes of them waits for the same budget.
    EXPECT_LT(rig.update(settings, all).marched, 0.01 * count);
    auto lights = kLights;
    lights[0].position_m.x += 0.2f;
    rig.lights.set(lights);
    EXPECT_GT(rig.update(settings, all).marched, 0.25 * count);
}

TEST_F(FindVisibilityTest, SameInputSameBytes) {
    std::vector<std::vector<RefinedRecord>> runs;
    for (int i = 0; i < 2; ++i) {
        const auto model = make_model();
        ReflectanceSettings settings;
        settings.refreshed_records = 2000;
        // Some have had their turn, others not: which is the same in both runs.
        for (int update = 0; update < 5; ++update) model->reflectance.update(settings);
        runs.push_back(model->reflectance.records());
    }
    ASSERT_EQ(runs[0].size(), runs[1].size());
    uint32_t known = 0;
    for (size_t i = 0; i < runs[0].size(); ++i) {
        EXPECT_EQ(runs[0][i].albedo, runs[1][i].albedo);
        EXPECT_EQ(runs[0][i].visible, runs[1][i].visible);
        EXPECT_EQ(runs[0][i].uncertain, runs[1][i].uncertain);
        known += runs[0][i].albedo.x != 0;
    }
    EXPECT_GT(known, 500u);
    EXPECT_LT(known, runs[0].size());
}

/// The scene in a colour camera, with the box's shadows.
void paint(RigFrame& frame, const reference::Ward& material) {
    for (uint32_t y = 0; y < kCamera.extent.height; ++y) {
        for (uint32_t x = 0; x < kCamera.extent.width; ++x) {
            const double depth = double{frame.depth_m.at(x, y)};
            if (depth <= 0) continue;
            const glm::dvec4 in_camera((x - kCamera.cx) / kCamera.fx * depth, (y - kCamera.cy) / kCamera.fy * depth,
                                       depth, 1);
            const glm::dvec3 point(frame.world_from_camera * in_camera);
            const glm::dvec3 normal = reference::normal_at(scene, point);
            std::vector<reference::ReceivedLight> lights;
            for (const Light& light : kLights) {
                lights.push_back({glm::dvec3(light.position_m), glm::dvec3(light.intensity),
                                  !box_between(point + 1e-4 * normal, glm::dvec3(light.position_m))});
            }
            const glm::dvec3 to_viewer = glm::normalize(glm::dvec3(frame.world_from_camera[3]) - point);
            frame.color.linear.at(x, y) =
                glm::vec4(reference::shade(material, {point, normal}, lights, glm::dvec3(0.05), to_viewer), 1);
        }
    }
}

TEST_F(FindVisibilityTest, KdOfAGlossySceneWithShadowsIsFoundThroughTheWholePipeline) {
    const reference::Ward material{{0.5, 0.4, 0.3}, glm::dvec3(0.08), 0.25};
    Model model(device(), runner());
    model.reflectance.lights.set(kLights, glm::dvec3(0.05f));
    model.reflectance.materials.set(1, glm::vec3(material.ks), static_cast<float>(material.alpha));
    for (RigFrame frame : frames()) {
        paint(frame, material);
        frame.labels = Image<uint32_t>(kCamera.extent, 1u);
        model.observations.fuse(frame);
        model.observations.collect(frame);
    }
    model.reflectance.update_all({});
    std::vector<double> errors;
    for (const RefinedRecord& record : model.reflectance.records()) {
        if (!on_floor(record) || record.certainty.g < 0.3) continue;
        errors.push_back(std::abs(record.kd.g - material.kd.g));
    }
    ASSERT_GT(errors.size(), 1500u);
    std::sort(errors.begin(), errors.end());
    EXPECT_LT(errors[errors.size() / 2], 0.005);
    EXPECT_LT(errors[errors.size() * 95 / 100], 0.02);
    RecordProperty("median", std::to_string(errors[errors.size() / 2]));
    RecordProperty("p95", std::to_string(errors[errors.size() * 95 / 100]));
}

}  // namespace
}  // namespace patina::find_visibility_test
