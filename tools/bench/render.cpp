// `patina bench render`: how fast synthetic scenes are rendered. See docs/develop/benchmarks.md.
#include "scenes/render/render.h"

#include <cmath>
#include <ctime>
#include <memory>
#include <numbers>

#include <CLI/CLI.hpp>

#include "engine/core/error.h"
#include "engine/graph/runner.h"
#include "scenes/files/scene_file.h"
#include "tools/bench/subjects.h"

namespace patina::bench {
namespace render_bench {
namespace {

struct Options {
    std::string scene;
    bool no_shadows = false;
    double lamp_radius_m = 0;
    uint32_t bounces = 0;
    uint32_t samples = 64;
};

struct Figures {
    std::vector<Row> passes;
    double processor_ms = 0;  ///< of all cores, per frame: what a software device takes, whatever else runs beside it
};

/// A sphere of radius 1 m with bumps, as a grid of longitudes and latitudes: about as fine and as uneven as a scanned
/// figure. Two triangles to each of rings x segments cells, one at the poles.
std::shared_ptr<const scenes::TriangleMesh> bumpy_sphere(uint32_t rings, uint32_t segments) {
    auto mesh = std::make_shared<scenes::TriangleMesh>();
    for (uint32_t ring = 0; ring <= rings; ++ring) {
        for (uint32_t segment = 0; segment < segments; ++segment) {
            const double latitude = std::numbers::pi * ring / rings,
                         longitude = 2 * std::numbers::pi * segment / segments;
            const glm::dvec3 direction(std::sin(latitude) * std::sin(longitude), -std::cos(latitude),
                                       std::sin(latitude) * std::cos(longitude));
            const double radius_m = 1 + 0.1 * std::sin(7 * longitude) * std::sin(9 * latitude);
            mesh->positions_m.emplace_back(radius_m * direction);
            mesh->normals.emplace_back(direction);
        }
    }
    const auto vertex = [&](uint32_t ring, uint32_t segment) { return ring * segments + segment % segments; };
    for (uint32_t ring = 0; ring < rings; ++ring) {
        for (uint32_t s = 0; s < segments; ++s) {
            if (ring > 0) mesh->triangles.emplace_back(vertex(ring, s), vertex(ring, s + 1), vertex(ring + 1, s));
            if (ring + 1 < rings)
                mesh->triangles.emplace_back(vertex(ring, s + 1), vertex(ring + 1, s + 1), vertex(ring + 1, s));
        }
    }
    return mesh;
}

/// Three figures of 23 400 triangles each on a floor under three lights, 4 m away.
scenes::SyntheticScene generated_scene() {
    scenes::SyntheticScene scene;
    scene.name = "three bumpy spheres";
    const auto mesh = bumpy_sphere(118, 100);
    const auto object = [](uint32_t id, scenes::Part part) {
        return scenes::SceneObject{{std::move(part)}, {id, "", glm::dvec3(0.4), glm::dvec3(0.1), 0.2}};
    };
    scene.objects.push_back(
        object(1, {scenes::RectangleShape{{4, 4}}, scenes::placed({0, 0, 4}, {1, 0, 0}, std::numbers::pi / 2)}));
    for (uint32_t i = 0; i < 3; ++i) {
        const glm::dvec3 position_m(-1.6 + 1.6 * i, -0.75, 4 + 0.4 * (i % 2));
        RigidTransform pose = scenes::placed(position_m, {0, 1, 0}, i);
        scene.objects.push_back(object(2 + i, {scenes::MeshShape{mesh}, pose}));
    }
    scene.lights = {{{-3, -3, 1}, {8, 8, 8}}, {{3, -3.5, 2}, {8, 7, 6}}, {{0, -4, 6}, {5, 6, 8}}};
    scene.path = scenes::OrbitPath{.target_m = {0, -0.6, 4},
                                   .distance_m = 4,
                                   .azimuth_amplitude_rad = 0.9,
                                   .azimuth_period_s = 20,
                                   .elevation_rad = 0.35};
    return scene;
}

size_t triangles_of(const scenes::SyntheticScene& scene) {
    size_t count = 0;
    for (const auto& object : scene.objects)
        for (const auto& part : object.parts)
            if (const auto* shape = std::get_if<scenes::MeshShape>(&part.shape)) count += shape->mesh->triangles.size();
    return count;
}

/// Renders frames along the scene's path, each alone on the device.
Figures measure(vulkan::Device& device, const scenes::SyntheticScene& scene, const Options& options,
                const Conditions& conditions) {
    graph::Runner runner(device);
    const scenes::SceneModel model(runner, scene);
    scenes::RenderSettings settings = scene.recording.render;
    settings.shadows = settings.shadows && !options.no_shadows;
    settings.area_lights = options.lamp_radius_m > 0;
    settings.bounces = options.bounces;
    settings.samples = options.samples;
    std::clock_t start = 0;
    for (uint32_t i = 0; i < conditions.warmup + conditions.frames; ++i) {
        runner.wait();
        if (i == conditions.warmup) {
            runner.clear_timings();
            start = std::clock();
        }
        graph::FrameGraph frame = runner.begin();
        const auto pose = world_from_camera(scene.path, i * 10 / scene.fps);
        const auto images = scenes::add_render(frame, model, scene.camera, pose, settings, i);
        for (const auto& id : {images.radiance, images.depth_m, images.object_id, images.normal, images.kd})
            frame.keep(id);
        runner.submit(std::move(frame));
    }
    runner.wait();
    Figures figures;
    figures.processor_ms = 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / conditions.frames;
    std::vector<float> total_ms(conditions.frames, 0);
    for (const graph::Timing& timing : runner.pass_timings()) {
        figures.passes.push_back({timing.name, distribution(timing.samples_ms)});
        // A pass with many samples has several dispatches in each frame.
        const size_t dispatches = timing.samples_ms.size() / conditions.frames;
        for (size_t i = 0; i < timing.samples_ms.size(); ++i) total_ms[i / dispatches] += timing.samples_ms[i];
    }
    figures.passes.push_back({"all", distribution(total_ms)});
    return figures;
}

Report run(const Options& options, const Conditions& conditions) {
    scenes::SyntheticScene scene = options.scene.empty() ? generated_scene() : scenes::load_scene(options.scene);
    if (options.lamp_radius_m > 0)
        for (auto& light : scene.lights) light.radius_m = options.lamp_radius_m;
    vulkan::Device device(conditions.device);
    const Figures figures = measure(device, scene, options, conditions);
    const Extent2D extent = scene.camera.extent;
    Report report(device.caps());
    report.print("{} at {}x{}, {} triangles, {} lights, {} frames\n\n", scene.name, extent.width, extent.height,
                 triangles_of(scene), scene.lights.size(), conditions.frames);
    report.json["scene"] = scene.name;
    report.table("pass (GPU ms)", figures.passes);
    report.print("{:<36} {:>10} {:>10.4f}\n", "processor time, all cores", "", figures.processor_ms);
    report.json["processor_ms"] = figures.processor_ms;
    return report;
}

}  // namespace
}  // namespace render_bench

Subject render_subject() {
    using namespace render_bench;
    return {
        "render", "How fast synthetic scenes are rendered", {.warmup = 3, .frames = 30}, [](CLI::App& app) -> Measure {
            const auto options = std::make_shared<Options>();
            app.add_option("scene", options->scene,
                           "Scene file or built-in scene; without, 70 000 triangles are generated");
            app.add_flag("--no-shadows", options->no_shadows, "Light passes through objects, whatever the scene says");
            app.add_option("--lamp-radius", options->lamp_radius_m,
                           "Makes all lamps spheres of this radius, in metres");
            app.add_option("--bounces", options->bounces, "Bounces of indirect light")->capture_default_str();
            app.add_option("--samples", options->samples,
                           "Samples per pixel, with lamps of a radius, bounces or environment")
                ->capture_default_str();
            return [options](const Conditions& conditions) { return run(*options, conditions); };
        }};
}

}  // namespace patina::bench
