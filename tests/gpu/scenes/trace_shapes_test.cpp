// Every shape of a synthetic scene, seen by the tracer.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/gpu/scenes/trace_rig.h"

namespace patina::trace_shapes_test {
namespace {

using scenes::SyntheticScene;

class TraceShapesTest : public TraceTest {};

/// Two lights and one object.
SyntheticScene scene_of(const char* name, scenes::SceneObject object) {
    SyntheticScene scene;
    scene.name = name;
    scene.objects.push_back(std::move(object));
    scene.lights = {{{1.5, -2.5, -2.0}, {4, 5, 6}}, {{-0.3, 0.2, -0.1}, {0.6, 0.6, 0.9}}};
    return scene;
}

/// Every shape, turned and in the same place.
std::vector<std::pair<const char*, scenes::Shape>> all_shapes() {
    scenes::TriangleMesh facets = icosphere(1);
    facets.normals.clear();
    return {{"rectangle", scenes::RectangleShape{{0.9, 0.6}}},
            {"box", scenes::BoxShape{{0.5, 0.3, 0.7}}},
            {"sphere", scenes::SphereShape{0.8}},
            {"cylinder", scenes::CylinderShape{0.5, 0.6}},
            {"smooth mesh", shape_of(icosphere(2))},
            {"facets", shape_of(facets)}};
}

const RigidTransform kFront = scenes::placed({0.1, -0.2, -2.6}, {0, 1, 0}, 0.02);

TEST_F(TraceShapesTest, EachShapeMatchesTheReferenceFromOutsideWithATexture) {
    for (const auto& [name, shape] : all_shapes()) {
        for (const double angle_rad : {0.0, 1.1, 2.5}) {
            SCOPED_TRACE(angle_rad);
            SyntheticScene scene = scene_of(name, glossy(3, {part_at(shape, {0.1, 0.05, 0.2}, {1, 2, 3}, angle_rad)}));
            scene.objects[0].texture = smooth_texture({7, 5}, {1.3, 0.9});
            expect_reference(scene, camera_of({161, 133}), kFront, 2e-3);
        }
    }
}

TEST_F(TraceShapesTest, ClosedShapesMatchTheReferenceFromInside) {
    const RigidTransform inside = scenes::placed({0.1, -0.05, 0.05}, {1, 1, 0}, 0.7);
    const Intrinsics wide{{101, 83}, 30, 30, 50, 41, {}};
    for (const auto& [name, shape] : all_shapes()) {
        if (std::holds_alternative<scenes::RectangleShape>(shape)) continue;
        SyntheticScene scene = scene_of(name, glossy(3, {part_at(shape, {0, 0, 0}, {3, 1, 2}, 0.8)}));
        scene.lights = {{{0.15, 0.1, 0}, {0.5, 0.6, 0.7}}, {{-0.1, 0.05, 0.1}, {0.3, 0.3, 0.3}}};
        scene.objects[0].texture = smooth_texture({6, 9}, {0.8, 1.1});
        expect_reference(scene, wide, inside, 1e-3);
        const Traced got = trace(scene, wide, inside);
        EXPECT_THAT(got.object_id.pixels(), ::testing::Each(3u)) << name;
    }
}

/// Objects of several parts, of all kinds, that hide and shadow one another.
TEST_F(TraceShapesTest, PartsOfAllKindsMatchTheReference) {
    SyntheticScene scene =
        scene_of("parts", glossy(1, {part_at(scenes::RectangleShape{{3, 3}}, {0, 0.8, 0}, {1, 0, 0}, 1.57)}));
    scenes::SceneObject table = glossy(2, {part_at(scenes::BoxShape{{0.6, 0.03, 0.4}}, {0.5, 0.1, 0.3})});
    for (const double x : {0.0, 1.0})
        for (const double z : {0.0, 0.6})
            table.parts.push_back(part_at(scenes::CylinderShape{0.04, 0.35}, {x, 0.45, z}));
    scene.objects.push_back(table);
    scene.objects.push_back(glossy(
        3, {part_at(shape_of(icosphere(2)), {-1.2, -0.2, 0.7}), part_at(scenes::SphereShape{0.25}, {0.5, -0.18, 0.3}),
            part_at(shape_of(cube_mesh(2)), {0.3, -0.1, 3}, {1, 1, 1}, 1)}));
    expect_reference(scene, camera_of({201, 167}), scenes::placed({0, -1.2, -2.8}, {1, 0, 0}, -0.35), 2e-3);
}

// Gtest's matchers would take seconds for so many pixels.
auto count_holes(const auto& traced) { return std::ranges::count(traced.object_id.pixels(), 0u); }

/// Rays through edges and corners of closed meshes must not pass between the triangles.
TEST_F(TraceShapesTest, ClosedMeshesLetNoRayThrough) {
    for (const auto& [name, mesh] : {std::pair{"icosphere", icosphere(3)}, {"cube", cube_mesh(8)}}) {
        for (const double angle_rad : {0.0, 0.5, std::numbers::pi / 4, 2.0}) {
            SCOPED_TRACE(std::string(name) + " turned by " + std::to_string(angle_rad));
            const SyntheticScene scene =
                scene_of(name, glossy(7, {part_at(shape_of(mesh), {0, 0, 0}, {1, 2, 0.5}, angle_rad)}));
            // Pixels meet the cube's lattice exactly: from its centre the wall is one focal length away.
            const Intrinsics inside{{257, 257}, 128, 128, 128, 128, {}};
            const Intrinsics outside{{257, 257}, 768, 768, 128, 128, {}};
            for (const RigidTransform& turn : {RigidTransform(1.0), scenes::placed({0, 0, 0}, {0, 1, 0}, 1.3)}) {
                const Traced from_inside = trace(scene, inside, turn);
                EXPECT_EQ(count_holes(from_inside), 0);
                RigidTransform away = turn;
                away[3] = glm::dvec4(glm::dvec3(turn[2]) * -3.0, 1);
                const Traced from_outside = trace(scene, outside, away);
                EXPECT_EQ(count_holes(from_outside), 0);
                // The near side, not the far side through a hole.
                EXPECT_LT(*std::max_element(from_outside.depth_m.pixels().begin(), from_outside.depth_m.pixels().end()),
                          3.0f);
            }
        }
    }
}

/// A convex object has no shadow on itself but where the light is below the horizon, where there is no light anyway.
TEST_F(TraceShapesTest, ConvexShapesDoNotShadowThemselves) {
    for (const auto& [name, shape] : all_shapes()) {
        for (const double distance_m : {0.0, 30.0}) {
            SyntheticScene scene = scene_of(name, glossy(3, {part_at(shape, {0, 0, distance_m}, {1, 2, 3}, 0.5)}));
            scene.lights = {{{2, -2, distance_m - 2}, {5, 5, 5}}};
            const RigidTransform pose = scenes::placed({0, 0, distance_m - 3}, {0, 1, 0}, 0);
            const Traced open = trace(scene, camera_of({128, 106}), pose, {.shadows = false});
            const Traced shadowed = trace(scene, camera_of({128, 106}), pose, {.shadows = true});
            size_t darker = 0, seen = 0;
            for (size_t i = 0; i < open.radiance.pixels().size(); ++i) {
                seen += open.hit(i);
                darker += shadowed.radiance.pixels()[i] != open.radiance.pixels()[i];
            }
            EXPECT_GT(seen, 1000u) << name;
            // A mesh's smooth normals see the light a little longer than its facets do.
            const bool smooth = std::string(name) == "smooth mesh";
            EXPECT_LE(darker, smooth ? seen / 100 : 0) << name << " at " << distance_m << " m, of " << seen;
        }
    }
}

/// Normals tilted so far that from the right side of the quad they face away from the camera.
TEST_F(TraceShapesTest, NormalsBelowTheViewersHorizonGiveWayToTheTriangles) {
    const double tilt_rad = 1.2;
    const glm::vec3 tilted(std::sin(tilt_rad), 0, -std::cos(tilt_rad));
    scenes::TriangleMesh mesh;
    mesh.positions_m = {{-3, -2, 1}, {3, -2, 1}, {3, 2, 1}, {-3, 2, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    for (const float side : {1.0f, -1.0f}) {  // normals that point away from the viewer's side are turned round
        mesh.normals.assign(4, side * tilted);
        const SyntheticScene scene = scene_of("tilted", glossy(1, {part_at(shape_of(mesh), {0, 0, 0})}));
        const Intrinsics camera{{101, 33}, 50, 50, 50, 16, {}};
        const Traced got = trace(scene, camera, RigidTransform(1.0));
        EXPECT_LT(glm::distance(got.normal(20, 16), tilted), 1e-6f);
        EXPECT_EQ(got.normal(90, 16), glm::vec3(0, 0, -1));
        expect_reference(scene, camera, RigidTransform(1.0), 1e-3);
    }
}

TEST_F(TraceShapesTest, LampsAreSeenButReflectNothingAndCastNoShadow) {
    SyntheticScene scene = scene_of("lamps", glossy(1, {part_at(scenes::RectangleShape{{3, 3}}, {0, 0, 2})}));
    scene.lights = {{{0.3, -0.2, 1.2}, {0.5, 0.4, 0.3}, 0.15},
                    {{-0.2, 0.1, 0.8}, {0.2, 0.2, 0.6}, 0.1, {0, 0.6, -0.8}},
                    {{-0.15, 0.1, -0.5}, {1, 1, 1}},
                    {{0.4, 0.4, 2.5}, {3, 3, 3}, 0.3}};
    expect_reference(scene, camera_of({161, 133}), RigidTransform(1.0), 1e-3);
    const Intrinsics camera{{1, 1}, 100, 100, 0, 0, {}};
    const Traced got = trace(scene, camera, scenes::placed({0.3, -0.2, 0}, {0, 1, 0}, 0), {.shadows = true});
    EXPECT_EQ(got.object_id.at(0, 0), 0u);
    EXPECT_NEAR(got.depth_m.at(0, 0), 1.05, 1e-6);
    EXPECT_EQ(got.kd.at(0, 0), glm::vec4(0));
    EXPECT_EQ(got.ks_alpha.at(0, 0), glm::vec4(0));
    EXPECT_EQ(got.normal(0, 0), glm::vec3(0, 0, -1));
    const glm::dvec3 emitted = scene.lights[0].intensity / (std::numbers::pi * 0.15 * 0.15);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got.radiance.at(0, 0)[c], emitted[c], 1e-5);
}

TEST_F(TraceShapesTest, TexelsAreWhereTheTextureSaysAndRepeat) {
    SyntheticScene scene = scene_of("poster", glossy(1, {part_at(scenes::RectangleShape{{2, 2}}, {0, 0, 1})}));
    const scenes::Texture texture = smooth_texture({4, 3}, {0.4, 0.6});  // texels of 0.1 m by 0.2 m
    scene.objects[0].texture = texture;
    // One pixel per texel, each at a texel's centre: pixel (x, y) looks at ((x - 8 + 0.5) / 10, (y - 6 + 0.5) / 5).
    const Intrinsics camera{{16, 12}, 10, 5, 7.5, 5.5, {}};
    const Traced got = trace(scene, camera, RigidTransform(1.0));
    for (uint32_t y = 0; y < 12; ++y) {
        for (uint32_t x = 0; x < 16; ++x) {
            const glm::vec3 expected = texture.kd->at(x % 4, y % 3);
            EXPECT_LT(glm::distance(glm::vec3(got.kd.at(x, y)), expected), 1e-5f) << x << ", " << y;
        }
    }
}

/// GLSL's own arc tangent may be off by 2e-4; texels of 2 cm show it. Seen frontally, where fp32 places points best.
TEST_F(TraceShapesTest, TexturesAroundSpheresAndCylindersLieWhereTheAnglesSay) {
    const Intrinsics narrow{{41, 33}, 150, 150, 20, 16, {}};
    for (const scenes::Shape& shape : {scenes::Shape(scenes::SphereShape{0.8}), {scenes::CylinderShape{0.8, 2}}}) {
        for (int step = 0; step < 16; ++step) {
            SCOPED_TRACE(step);
            SyntheticScene scene = scene_of("round", glossy(3, {part_at(shape, {0, 0, 0}, {0, 1, 0}, 0.4 * step)}));
            scene.objects[0].texture = smooth_texture({40, 30}, {0.8, 0.6});
            const Traced got = trace(scene, narrow, scenes::placed({0, 0, -2.4}, {0, 1, 0}, 0));
            compare(got, reference::trace_scene(scene, narrow, scenes::placed({0, 0, -2.4}, {0, 1, 0}, 0)), scene);
        }
    }
}

TEST_F(TraceShapesTest, KdWithoutATextureIsExact) {
    const SyntheticScene scene = scene_of("sphere", glossy(1, {part_at(scenes::SphereShape{1}, {0, 0, 3})}));
    const Traced got = trace(scene, camera_of({64, 53}), RigidTransform(1.0));
    for (size_t i = 0; i < got.kd.pixels().size(); ++i)
        EXPECT_EQ(got.kd.pixels()[i], got.hit(i) ? glm::vec4(0.3f, 0.2f, 0.1f, 0) : glm::vec4(0));
}

TEST_F(TraceShapesTest, TrianglesWithoutAreaAreNotSeen) {
    scenes::TriangleMesh mesh;
    mesh.positions_m = {{0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {0, 0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {1, 1, 1}};
    const SyntheticScene scene = scene_of("needles", glossy(1, {part_at(shape_of(mesh), {0, 0, 0})}));
    const Traced got = trace(scene, camera_of({65, 33}), RigidTransform(1.0), {.shadows = true});
    EXPECT_THAT(got.object_id.pixels(), ::testing::Each(0u));
    EXPECT_THAT(got.radiance.pixels(), ::testing::Each(glm::vec4(0)));
}

}  // namespace
}  // namespace patina::trace_shapes_test
