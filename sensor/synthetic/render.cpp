#include "sensor/synthetic/render.h"

#include <array>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "engine/core/shader_camera.h"
#include "shared/trace_scene.h"
#include "spirv/shaders.h"

namespace patina::sensor {
namespace {

glm::vec4 half_size_of(const Shape& shape) {
    struct {
        glm::vec4 operator()(const RectangleShape& s) const { return {s.half_size_m, 0, 0}; }
        glm::vec4 operator()(const BoxShape& s) const { return {s.half_size_m, 0}; }
        glm::vec4 operator()(const SphereShape& s) const { return {s.radius_m, 0, 0, 0}; }
        glm::vec4 operator()(const CylinderShape&) const { return {}; }
        glm::vec4 operator()(const MeshShape&) const { return {}; }
    } visitor;
    return std::visit(visitor, shape);
}

void check(const Scene& scene) {
    std::set<uint32_t> ids;
    for (const SceneObject& object : scene.objects) {
        const Material& m = object.material;
        const auto fail = [&](const auto&... parts) {
            throw Error("scene '", scene.name, "': object '", m.name, "' ", parts...);
        };
        if (m.id == 0 || m.id > UINT16_MAX) fail("has id ", m.id, ", outside 1 to ", UINT16_MAX);
        if (!ids.insert(m.id).second) fail("has id ", m.id, ", which is another object's");
        if (!m.kd) fail("has neither kd nor a texture");
        if (!(m.alpha > 0 && m.alpha <= 1)) fail("has alpha ", m.alpha, ", outside (0, 1]");
    }
}

gpu::TraceObject to_gpu(const SceneObject& object, const Part& part) {
    gpu::TraceObject out{};
    out.object_from_world = glm::mat4(rigid_inverse(part.world_from_part));
    out.half_size_m = half_size_of(part.shape);
    out.kd = glm::vec4(*object.material.kd, 0);
    out.ks_alpha = glm::vec4(object.material.ks, object.material.alpha);
    out.id = object.material.id;
    return out;
}

/// The scene's parts of one kind of shape, in their order.
std::vector<gpu::TraceObject> parts_of_kind(const Scene& scene, size_t kind) {
    std::vector<gpu::TraceObject> parts;
    for (const SceneObject& object : scene.objects) {
        for (const Part& part : object.parts)
            if (part.shape.index() == kind) parts.push_back(to_gpu(object, part));
    }
    return parts;
}

/// A buffer of no bytes cannot be bound: what is empty becomes one unused element.
template <class T>
vulkan::BufferRef upload(graph::Runner& runner, graph::Frame& frame, const char* name, std::vector<T> values) {
    if (values.empty()) values.emplace_back();
    const auto bytes = std::as_bytes(std::span<const T>(values));
    const vulkan::BufferRef buffer = runner.device().create_buffer({.name = name, .bytes = bytes.size()});
    frame.keep(frame.upload_bytes(frame.import(buffer), 0, bytes, true));
    return buffer;
}

std::vector<gpu::TraceLight> lights_of(const Scene& scene) {
    std::vector<gpu::TraceLight> lights;
    for (const PointLight& light : scene.lights)
        lights.push_back({glm::vec4(light.position_m, 1), glm::vec4(light.intensity, 0)});
    return lights;
}

}  // namespace

SceneModel::SceneModel(graph::Runner& runner, const Scene& scene) {
    check(scene);
    const std::array kinds{parts_of_kind(scene, 0), parts_of_kind(scene, 1), parts_of_kind(scene, 2)};
    std::vector<gpu::TraceObject> objects;
    for (const auto& kind : kinds) objects.insert(objects.end(), kind.begin(), kind.end());
    rectangle_count_ = static_cast<uint32_t>(kinds[0].size());
    box_count_ = static_cast<uint32_t>(kinds[1].size());
    sphere_count_ = static_cast<uint32_t>(kinds[2].size());
    light_count_ = static_cast<uint32_t>(scene.lights.size());
    graph::Frame frame = runner.begin();
    objects_ = upload(runner, frame, "scene objects", std::move(objects));
    lights_ = upload(runner, frame, "scene lights", lights_of(scene));
    runner.submit(std::move(frame));
}

SceneModel::Ids SceneModel::import(graph::Frame& frame) const {
    return {.objects = frame.import(objects_), .lights = frame.import(lights_)};
}

RenderedImages add_render(graph::Frame& frame, const SceneModel& scene, const Intrinsics& camera,
                          const RigidTransform& world_from_camera, const RenderSettings& settings, uint32_t) {
    using vulkan::Format;
    if (camera.distorted()) throw Error("the pass 'synthetic.trace_scene' takes a camera without lens distortion");
    const SceneModel::Ids ids = scene.import(frame);
    auto pass = frame.compute("synthetic.trace_scene", spirv::trace_scene);
    pass.read("Objects", ids.objects).read("Lights", ids.lights);
    const RenderedImages out{.radiance = pass.create("radiance", {camera.extent, Format::kRgba32f}),
                             .depth_m = pass.create("depth_m", {camera.extent, Format::kR32f}),
                             .object_id = pass.create("object_id", {camera.extent, Format::kR32u}),
                             .normal = pass.create("normal", {camera.extent, Format::kRgba32f}),
                             .kd = pass.create("kd", {camera.extent, Format::kRgba32f}),
                             .ks_alpha = pass.create("ks_alpha", {camera.extent, Format::kRgba32f})};
    pass.specialise("kShadows", settings.shadows ? 1 : 0);
    pass.push(gpu::TraceSceneParams{make_camera(camera, world_from_camera), scene.rectangle_count(), scene.box_count(),
                                    scene.sphere_count(), scene.light_count()});
    const uint32_t bundles = (camera.extent.height + gpu::kTraceSceneRays - 1) / gpu::kTraceSceneRays;
    pass.dispatch_covering(Extent2D{camera.extent.width, bundles});
    return out;
}

}  // namespace patina::sensor
