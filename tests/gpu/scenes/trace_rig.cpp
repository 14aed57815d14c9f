#include "tests/gpu/scenes/trace_rig.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace patina {

using scenes::SyntheticScene;

TraceTest::Traced TraceTest::trace(const SyntheticScene& scene, const Intrinsics& camera,
                                   const RigidTransform& world_from_camera, const scenes::RenderSettings& settings) {
    const scenes::SceneModel model(runner(), scene);
    graph::FrameGraph frame = runner().begin();
    const auto images = scenes::add_render(frame, model, camera, world_from_camera, settings);
    const auto radiance = frame.read_back(images.radiance), depth_m = frame.read_back(images.depth_m);
    const auto object_id = frame.read_back(images.object_id), normal = frame.read_back(images.normal);
    const auto kd = frame.read_back(images.kd), ks_alpha = frame.read_back(images.ks_alpha);
    run(std::move(frame));
    return {radiance.image<glm::vec4>(), depth_m.image<float>(), object_id.image<uint32_t>(),
            normal.image<glm::vec4>(),   kd.image<glm::vec4>(),  ks_alpha.image<glm::vec4>()};
}

namespace {

/// The largest error of a channel, relative to it. Half a step of an 8-bit linear code would be 2e-3: below 1e-3,
/// errors relative to it are no errors.
double relative_error(glm::vec3 got, glm::dvec3 expected) {
    double worst = 0;
    for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(got[c] - expected[c]) / std::max(expected[c], 1e-3));
    return worst;
}

glm::vec4 ks_alpha_of(const SyntheticScene& scene, uint32_t id) {
    for (const auto& object : scene.objects)
        if (object.material.id == id) return {glm::vec3(object.material.ks), static_cast<float>(object.material.alpha)};
    return glm::vec4(0);
}

}  // namespace

TraceTest::Differences TraceTest::compare(const Traced& got, const Image<reference::TracedPixel>& expected,
                                          const SyntheticScene& scene, bool shadows) {
    constexpr double kShadowStep = 1e-2;  // what another light, or none, changes at least; rarely less
    Differences differences;
    double worst_depth = 0, worst_normal = 0, worst_kd = 0, worst_radiance = 0;
    for (size_t i = 0; i < expected.pixels().size(); ++i) {
        const reference::TracedPixel& e = expected.pixels()[i];
        const double normal_error = glm::distance(glm::dvec3(glm::vec3(got.normals.pixels()[i])), e.normal);
        if (got.hit(i) != e.seen || got.object_id.pixels()[i] != e.object_id || normal_error > 1e-3) {
            ++differences.surface;
            continue;
        }
        EXPECT_EQ(got.ks_alpha.pixels()[i], ks_alpha_of(scene, e.object_id));
        // Towards edge-on views fp32's depth is off by its rounding over the cosine, and so is what depends on it:
        // below 3 degrees the bounds grow likewise.
        const double edge_on = std::min(1.0, e.facing / 0.05);
        const double depth_error = std::abs(got.depth_m.pixels()[i] - e.depth_m) / std::max(e.depth_m, 1.0);
        worst_normal = std::max(worst_normal, edge_on * normal_error);
        worst_depth = std::max(worst_depth, edge_on * depth_error);
        worst_kd = std::max(worst_kd, relative_error(glm::vec3(got.kd.pixels()[i]), e.kd));
        const double radiance = relative_error(glm::vec3(got.radiance.pixels()[i]), e.radiance);
        if (shadows && radiance > kShadowStep)
            ++differences.shadow;
        else
            worst_radiance = std::max(worst_radiance, edge_on * radiance);
    }
    EXPECT_LT(worst_depth, 1e-5);
    EXPECT_LT(worst_normal, 2e-5);
    // A texture is steep where its texel coordinates are off by a GPU's sine.
    EXPECT_LT(worst_kd, device().caps().software() ? 1e-4 : 2e-4);
    EXPECT_LT(worst_radiance, 1e-4);
    return differences;
}

void TraceTest::expect_reference(const SyntheticScene& scene, const Intrinsics& camera,
                                 const RigidTransform& world_from_camera, double edge_share) {
    for (const bool shadows : {false, true}) {
        SCOPED_TRACE(scene.name + (shadows ? ", shadows" : ""));
        const Traced got = trace(scene, camera, world_from_camera, {.shadows = shadows});
        const auto expected = reference::trace_scene(scene, camera, world_from_camera, shadows);
        const Differences differences = compare(got, expected, scene, shadows);
        EXPECT_LE(differences.surface + differences.shadow, edge_share * static_cast<double>(camera.extent.area()))
            << differences.surface << " surfaces, " << differences.shadow << " shadows";
    }
}

Intrinsics camera_of(Extent2D extent) { return scaled_to(SyntheticScene{}.camera, extent); }

scenes::Part part_at(scenes::Shape shape, glm::dvec3 position_m, glm::dvec3 axis, double angle_rad) {
    return {std::move(shape), scenes::placed(position_m, axis, angle_rad)};
}

scenes::SceneObject glossy(uint32_t id, std::vector<scenes::Part> parts) {
    return {std::move(parts), {id, "", glm::dvec3(0.3, 0.2, 0.1), glm::dvec3(0.1, 0.2, 0.3), 0.15}};
}

scenes::Texture smooth_texture(Extent2D extent, glm::dvec2 repeat) {
    Image<glm::vec3> kd(extent);
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x)
            kd.at(x, y) =
                glm::vec3(0.4f) + 0.2f * glm::vec3(std::sin(2.0f * x), std::cos(1.5f * y), std::sin(x + 2.0f * y));
    }
    return {std::make_shared<const Image<glm::vec3>>(std::move(kd)), repeat};
}

scenes::TriangleMesh icosphere(int levels) {
    scenes::TriangleMesh mesh;
    const float g = (1 + std::sqrt(5.0f)) / 2;
    for (int i = 0; i < 12; ++i) {
        const float one = (i & 1) ? 1.0f : -1.0f, golden = (i & 2) ? g : -g;
        const glm::vec3 corner(0, one, golden);
        const int turn = i / 4;
        mesh.positions_m.push_back(
            glm::normalize(glm::vec3(corner[turn % 3], corner[(turn + 1) % 3], corner[(turn + 2) % 3])));
    }
    // The icosahedron's triangles: all triples of corners at the least distance from one another.
    const float edge = 2 / std::sqrt(1 + g * g);
    const auto joined = [&](uint32_t a, uint32_t b) {
        return glm::distance(mesh.positions_m[a], mesh.positions_m[b]) < 1.1f * edge;
    };
    for (uint32_t a = 0; a < 12; ++a)
        for (uint32_t b = a + 1; b < 12; ++b)
            for (uint32_t c = b + 1; c < 12; ++c)
                if (joined(a, b) && joined(b, c) && joined(c, a)) mesh.triangles.emplace_back(a, b, c);
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
        const auto middle = [&](uint32_t a, uint32_t b) {
            const auto [found, fresh] = middles.try_emplace(std::minmax(a, b), mesh.positions_m.size());
            if (fresh) mesh.positions_m.push_back(glm::normalize(mesh.positions_m[a] + mesh.positions_m[b]));
            return found->second;
        };
        std::vector<glm::uvec3> finer;
        for (const glm::uvec3& t : mesh.triangles) {
            const uint32_t ab = middle(t.x, t.y), bc = middle(t.y, t.z), ca = middle(t.z, t.x);
            for (const glm::uvec3& part : {glm::uvec3(t.x, ab, ca), {ab, t.y, bc}, {ca, bc, t.z}, {ab, bc, ca}})
                finer.push_back(part);
        }
        mesh.triangles = finer;
    }
    mesh.normals = mesh.positions_m;
    for (const glm::vec3& p : mesh.positions_m) mesh.texture_coordinates.emplace_back(p.x + 0.3f * p.z, p.y);
    return mesh;
}

scenes::TriangleMesh cube_mesh(int cells) {
    scenes::TriangleMesh mesh;
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        const auto first = static_cast<uint32_t>(mesh.positions_m.size());
        for (int v = 0; v <= cells; ++v) {
            for (int u = 0; u <= cells; ++u) {
                glm::vec3 p;
                p[axis] = face % 2 ? 1.0f : -1.0f;
                p[(axis + 1) % 3] = static_cast<float>(2 * u - cells) / static_cast<float>(cells);
                p[(axis + 2) % 3] = static_cast<float>(2 * v - cells) / static_cast<float>(cells);
                mesh.positions_m.push_back(p);
            }
        }
        const auto row = static_cast<uint32_t>(cells + 1);
        for (uint32_t v = 0; v + 1 < row; ++v) {
            for (uint32_t u = 0; u + 1 < row; ++u) {
                const uint32_t corner = first + v * row + u;
                mesh.triangles.emplace_back(corner, corner + 1, corner + row);
                mesh.triangles.emplace_back(corner + 1, corner + row + 1, corner + row);
            }
        }
    }
    return mesh;
}

}  // namespace patina
