#include "scenes/render/render.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "engine/core/shader_camera.h"
#include "scenes/render/environment_table.h"
#include "scenes/render/gather_light.h"
#include "scenes/render/scene_data.h"
#include "shared/scenes/trace_scene.h"
#include "spirv/shaders.h"

namespace patina::scenes {
namespace {

using vulkan::Format;

/// Brings lists into resources that outlive a frame. A resource of no bytes cannot be bound: what is empty becomes one
/// unused element.
class Uploader {
  public:
    explicit Uploader(graph::Runner& runner) : runner_(runner), frame_(runner.begin()) {}

    template <class T>
    vulkan::BufferRef buffer(const char* name, std::vector<T> values) {
        if (values.empty()) values.emplace_back();
        const auto bytes = std::as_bytes(std::span<const T>(values));
        const vulkan::BufferRef buffer = runner_.device().create_buffer({.name = name, .bytes = bytes.size()});
        frame_.keep(frame_.upload_bytes(frame_.import(buffer), 0, bytes, true));
        return buffer;
    }

    /// A list of 16-byte texels, kTexelRow to a row.
    template <class T>
    vulkan::ImageRef image(const char* name, Format format, const std::vector<T>& values) {
        const auto bytes = std::as_bytes(std::span<const T>(values));
        const size_t row_bytes = size_t{gpu::kTexelRow} * vulkan::bytes_per_pixel(format);
        const size_t rows = std::max<size_t>(1, (bytes.size() + row_bytes - 1) / row_bytes);
        std::vector<std::byte> padded(bytes.begin(), bytes.end());
        padded.resize(rows * row_bytes);
        const vulkan::ImageRef image = runner_.device().create_image(
            {.name = name, .extent = {gpu::kTexelRow, static_cast<uint32_t>(rows)}, .format = format});
        frame_.keep(frame_.upload(frame_.import(image), padded));
        return image;
    }

    void submit() { runner_.submit(std::move(frame_)); }

  private:
    graph::Runner& runner_;
    graph::FrameGraph frame_;
};

RenderedImages add_trace(graph::FrameGraph& frame, const SceneModel& scene, Extent2D extent,
                         const gpu::TraceSceneParams& params) {
    auto pass = frame.compute("scenes.trace_scene", spirv::trace_scene);
    scene.bind_geometry(frame, pass);
    scene.bind_surfaces(frame, pass);
    const RenderedImages images{.radiance = pass.create("radiance", {extent, Format::kRgba32f}),
                                .depth_m = pass.create("depth_m", {extent, Format::kR32f}),
                                .object_id = pass.create("object_id", {extent, Format::kR32u}),
                                .normal = pass.create("normal", {extent, Format::kRgba32f}),
                                .kd = pass.create("kd", {extent, Format::kRgba32f}),
                                .ks_alpha = pass.create("ks_alpha", {extent, Format::kRgba32f}),
                                .lifted_m = pass.create("Lifted", extent.area() * sizeof(glm::vec4))};
    pass.push(params).dispatch_covering(bundles_of(extent));
    return images;
}

/// Adds the paper's Eq. 6 to the radiance.
void add_shade(graph::FrameGraph& frame, const SceneModel& scene, RenderedImages& images, Extent2D extent,
               const gpu::TraceSceneParams& params, bool shadows) {
    auto pass = frame.compute("scenes.shade_scene", spirv::shade_scene);
    scene.bind_geometry(frame, pass);
    pass.read("depth_m", images.depth_m).read("object_id", images.object_id).read("normal", images.normal);
    pass.read("kd", images.kd).read("ks_alpha", images.ks_alpha).read("Lifted", images.lifted_m);
    images.radiance = pass.modify("radiance", images.radiance);
    pass.specialise("kShadows", shadows ? 1 : 0);
    pass.push(params).dispatch_covering(bundles_of(extent));
}

}  // namespace

Extent2D bundles_of(Extent2D extent) {
    return {extent.width, (extent.height + gpu::kBundleRays - 1) / gpu::kBundleRays};
}

SceneModel::SceneModel(graph::Runner& runner, const SyntheticScene& scene) {
    SceneData data = pack_scene(scene);
    EnvironmentTable environment;
    if (scene.environment) environment = make_environment_table(scene.name, *scene.environment->radiance);
    data.info.environment_size = {environment.extent.width, environment.extent.height};
    has_environment_ = scene.environment.has_value();
    has_area_lights_ = data.info.has_lamps != 0;
    Uploader upload(runner);
    info_ = upload.buffer("scene info", std::vector{data.info});
    nodes_ = upload.image("scene nodes", Format::kRgba32u, data.nodes);
    shapes_ = upload.image("scene shapes", Format::kRgba32f, data.shapes);
    lights_ = upload.buffer("scene lights", data.lights);
    objects_ = upload.buffer("scene objects", data.objects);
    triangle_surfaces_ = upload.buffer("scene triangle surfaces", data.triangles);
    texels_ = upload.image("scene texels", Format::kRgba32f, data.texels);
    environment_ = upload.buffer("scene environment", environment.cells);
    environment_aliases_ = upload.buffer("scene environment aliases", environment.aliases);
    upload.submit();
}

void SceneModel::bind_geometry(graph::FrameGraph& frame, graph::PassBuilder& pass) const {
    pass.read("Scene", frame.import(info_)).read("Lights", frame.import(lights_));
    pass.read("nodes", frame.import(nodes_)).read("shapes", frame.import(shapes_));
}

void SceneModel::bind_surfaces(graph::FrameGraph& frame, graph::PassBuilder& pass) const {
    pass.read("Objects", frame.import(objects_)).read("TriangleSurfaces", frame.import(triangle_surfaces_));
    pass.read("texels", frame.import(texels_));
}

void SceneModel::bind_environment(graph::FrameGraph& frame, graph::PassBuilder& pass) const {
    pass.read("Environment", frame.import(environment_));
    pass.read("EnvironmentAliases", frame.import(environment_aliases_));
}

RenderedImages add_render(graph::FrameGraph& frame, const SceneModel& scene, const Intrinsics& camera,
                          const RigidTransform& world_from_camera, const RenderSettings& settings,
                          uint32_t frame_index) {
    if (camera.distorted()) throw Error("the pass 'scenes.trace_scene' takes a camera without lens distortion");
    const gpu::TraceSceneParams params{make_camera(camera, world_from_camera)};
    RenderedImages images = add_trace(frame, scene, camera.extent, params);
    if (!samples_direct_light(scene, settings))
        add_shade(frame, scene, images, camera.extent, params, settings.shadows);
    add_gather_light(frame, scene, camera, world_from_camera, settings, frame_index, images);
    return images;
}

}  // namespace patina::scenes
