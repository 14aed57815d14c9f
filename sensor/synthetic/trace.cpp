#include "sensor/synthetic/trace.h"

#include <algorithm>
#include <set>
#include <vector>

#include "engine/core/shader_camera.h"
#include "shared/encode_frame.h"
#include "shared/trace_scene.h"
#include "spirv/shaders.h"

namespace patina::sensor {
namespace {

glm::vec4 half_size_of(const SceneObject& object) {
    struct {
        glm::vec4 operator()(const RectangleShape& s) const { return {s.half_size_m, 0, 0}; }
        glm::vec4 operator()(const BoxShape& s) const { return {s.half_size_m, 0}; }
        glm::vec4 operator()(const SphereShape& s) const { return {s.radius_m, 0, 0, 0}; }
    } visitor;
    return std::visit(visitor, object.shape);
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
        if (!m.kd) fail("has no kd; textured materials cannot be traced");
        if (!(m.alpha > 0 && m.alpha <= 1)) fail("has alpha ", m.alpha, ", outside (0, 1]");
    }
}

gpu::TraceObject to_gpu(const SceneObject& object) {
    gpu::TraceObject out{};
    out.object_from_world = glm::mat4(rigid_inverse(object.world_from_object));
    out.half_size_m = half_size_of(object);
    out.kd = glm::vec4(*object.material.kd, 0);
    out.ks_alpha = glm::vec4(object.material.ks, object.material.alpha);
    out.id = object.material.id;
    return out;
}

/// The scene's objects, sorted by kind, otherwise in their order.
std::vector<gpu::TraceObject> sorted_objects(const Scene& scene) {
    std::vector<gpu::TraceObject> objects;
    for (size_t kind = 0; kind < std::variant_size_v<decltype(SceneObject::shape)>; ++kind) {
        for (const SceneObject& object : scene.objects)
            if (object.shape.index() == kind) objects.push_back(to_gpu(object));
    }
    return objects;
}

uint32_t count_kind(const Scene& scene, size_t kind) {
    return static_cast<uint32_t>(
        std::count_if(scene.objects.begin(), scene.objects.end(),
                      [&](const SceneObject& object) { return object.shape.index() == kind; }));
}

/// A buffer of no bytes cannot be bound: what is empty becomes one unused element.
template <class T>
graph::BufferId upload_some(graph::Frame& frame, const char* name, std::vector<T> values) {
    if (values.empty()) values.emplace_back();
    return frame.upload<T>(name, values);
}

}  // namespace

SceneBuffers upload_scene(graph::Frame& frame, const Scene& scene) {
    check(scene);
    std::vector<gpu::TraceLight> lights;
    for (const PointLight& light : scene.lights)
        lights.push_back({glm::vec4(light.position_m, 1), glm::vec4(light.intensity, 0)});
    const auto light_count = static_cast<uint32_t>(lights.size());
    return {.objects = upload_some(frame, "scene objects", sorted_objects(scene)),
            .lights = upload_some(frame, "scene lights", std::move(lights)),
            .rectangle_count = count_kind(scene, 0),
            .box_count = count_kind(scene, 1),
            .sphere_count = count_kind(scene, 2),
            .light_count = light_count};
}

TracedImages add_trace_scene(graph::Frame& frame, const SceneBuffers& scene, const Intrinsics& camera,
                             const RigidTransform& world_from_camera, Shadows shadows) {
    using vulkan::Format;
    if (camera.distorted()) throw Error("the pass 'synthetic.trace_scene' takes a camera without lens distortion");
    auto pass = frame.compute("synthetic.trace_scene", spirv::trace_scene);
    pass.read("Objects", scene.objects).read("Lights", scene.lights);
    const TracedImages out{.radiance = pass.create("radiance", {camera.extent, Format::kRgba32f}),
                           .depth_m = pass.create("depth_m", {camera.extent, Format::kR32f}),
                           .object_id = pass.create("object_id", {camera.extent, Format::kR32u}),
                           .normal = pass.create("normal", {camera.extent, Format::kRgba16f})};
    pass.specialise("kShadows", shadows == Shadows::kHard ? 1 : 0);
    pass.push(gpu::TraceSceneParams{make_camera(camera, world_from_camera), scene.rectangle_count, scene.box_count,
                                    scene.sphere_count, scene.light_count});
    const uint32_t bundles = (camera.extent.height + gpu::kTraceSceneRays - 1) / gpu::kTraceSceneRays;
    pass.dispatch_covering(Extent2D{camera.extent.width, bundles});
    return out;
}

graph::BufferId add_encode_frame(graph::Frame& frame, const TracedImages& traced, double metres_per_unit) {
    const Extent2D extent = frame.common_extent({traced.radiance, traced.depth_m, traced.object_id});
    auto pass = frame.compute("synthetic.encode_frame", spirv::encode_frame);
    pass.read("radiance", traced.radiance).read("depth_m", traced.depth_m).read("object_id", traced.object_id);
    const graph::BufferId encoded = pass.create("Encoded", extent.area() * sizeof(glm::uvec2));
    pass.push(gpu::EncodeFrameParams{{extent.width, extent.height}, static_cast<float>(1 / metres_per_unit), 0});
    pass.dispatch_covering(extent);
    return encoded;
}

}  // namespace patina::sensor
