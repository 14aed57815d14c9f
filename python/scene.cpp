// What comes out: scenes, views, numbers.

#include "patina/scene.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "python/arrays.h"
#include "python/bindings.h"

namespace patina::python {

namespace {

using Unlocked = py::call_guard<py::gil_scoped_release>;

py::list segments_of(const Scene& scene) {
    py::list list;
    for (uint32_t label = 1; label < scene.reflectance.segments.size(); ++label) {
        const SegmentReflectance& segment = scene.reflectance.segments[label];
        if (segment.voxels == 0) continue;
        py::dict entry;
        entry["label"] = label;
        entry["voxels"] = segment.voxels;
        if (segment.kd) entry["kd"] = to_tuple(*segment.kd);
        if (segment.gloss) {
            entry["ks"] = to_tuple(segment.gloss->ks);
            entry["alpha"] = segment.gloss->alpha;
        }
        list.append(entry);
    }
    return list;
}

const Scene& scene_of(const py::object& self) { return self.cast<const Scene&>(); }

py::array_t<uint32_t> triangles_of(const py::object& self) {
    const auto& triangles = scene_of(self).mesh.triangles;
    return shared<uint32_t>({static_cast<py::ssize_t>(triangles.size()), py::ssize_t{3}},
                            triangles.empty() ? nullptr : triangles.front().data(), self);
}

py::array_t<uint32_t> labels_of(const py::object& self) {
    const auto& labels = scene_of(self).reflectance.labels;
    return shared<uint32_t>({static_cast<py::ssize_t>(labels.size())}, labels.empty() ? nullptr : labels.data(), self);
}

py::array_t<double> trajectory_of(const Scene& scene) {
    py::array_t<double> poses({static_cast<py::ssize_t>(scene.trajectory.size()), py::ssize_t{4}, py::ssize_t{4}});
    for (size_t i = 0; i < scene.trajectory.size(); ++i)
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column)
                poses.mutable_at(i, row, column) = scene.trajectory[i].world_from_camera[column][row];
    return poses;
}

py::array_t<double> timestamps_of(const Scene& scene) {
    py::array_t<double> times(static_cast<py::ssize_t>(scene.trajectory.size()));
    for (size_t i = 0; i < scene.trajectory.size(); ++i) times.mutable_at(i) = scene.trajectory[i].timestamp_s;
    return times;
}

const char* word_of(TrackingState state) {
    switch (state) {
        case TrackingState::kTracking: return "tracking";
        case TrackingState::kWeak: return "weak";
        case TrackingState::kLost: break;
    }
    return "lost";
}

void bind_frame_result(py::module_& m) {
    py::class_<FrameResult>(m, "FrameResult", "What became of one frame.")
        .def_readonly("fused", &FrameResult::fused)
        .def_readonly("reason", &FrameResult::reason)
        .def_property_readonly("state", [](const FrameResult& result) { return word_of(result.state); })
        .def_property_readonly("world_from_camera",
                               [](const FrameResult& result) { return to_array(result.world_from_depth); });
}

}  // namespace

void bind_scene(py::module_& m) {
    py::class_<Scene>(
        m, "Scene", "A finished reconstruction. Arrays of vertices and triangles share its memory, and are to be read.")
        .def_readonly("name", &Scene::name)
        .def_property_readonly("positions",
                               [](py::object self) { return shared(scene_of(self).mesh.positions_m, self); })
        .def_property_readonly("normals", [](py::object self) { return shared(scene_of(self).mesh.normals, self); })
        .def_property_readonly("colors", [](py::object self) { return shared(scene_of(self).mesh.colors, self); })
        .def_property_readonly("kd", [](py::object self) { return shared(scene_of(self).reflectance.kd, self); })
        .def_property_readonly("labels", &labels_of)
        .def_property_readonly("triangles", &triangles_of)
        .def_property_readonly("segments", &segments_of)
        .def_property_readonly("segment_names", [](const Scene& scene) { return scene.segment_names; })
        .def_property_readonly("trajectory", &trajectory_of)
        .def_property_readonly("timestamps", &timestamps_of)
        .def_property_readonly("lights", [](const Scene& scene) { return scene.lighting.lights; })
        .def_property_readonly("ambient", [](const Scene& scene) { return to_tuple(scene.lighting.ambient); })
        .def_property_readonly("world_offset", [](const Scene& scene) { return to_tuple(scene.world_offset_m); })
        .def("save_glb", &Scene::save_glb, py::arg("file"), Unlocked())
        .def("save", &Scene::save, py::arg("folder"), Unlocked());
    bind_frame_result(m);
}

py::dict to_dict(ModelView view) {
    py::dict result;
    result["position"] = moved(std::move(view.position_m));
    result["normal"] = moved(std::move(view.normal));
    result["color"] = moved(std::move(view.color));
    if (!view.label.empty()) result["label"] = moved(std::move(view.label));
    if (!view.reflectance) return result;
    result["kd"] = moved(std::move(view.reflectance->kd));
    result["ks_alpha"] = moved(std::move(view.reflectance->ks_alpha));
    result["rgb"] = moved(std::move(view.reflectance->rgb));
    result["light"] = moved(std::move(view.reflectance->light));
    return result;
}

py::dict to_dict(const Statistics& statistics) {
    using namespace py::literals;
    py::list pools, passes;
    for (const PoolUse& pool : statistics.pools)
        pools.append(py::dict("name"_a = pool.name, "used"_a = pool.used, "capacity"_a = pool.capacity,
                              "refused"_a = pool.refused));
    for (const PassTime& pass : statistics.passes)
        passes.append(py::dict("name"_a = pass.name, "count"_a = pass.count, "min_ms"_a = pass.min_ms,
                               "median_ms"_a = pass.median_ms, "max_ms"_a = pass.max_ms));
    return py::dict("frames"_a = statistics.frames, "visible_blocks"_a = statistics.visible_blocks,
                    "segments"_a = statistics.segments, "pools"_a = pools, "passes"_a = passes);
}

}  // namespace patina::python
