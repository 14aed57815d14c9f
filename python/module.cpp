#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "python/arrays.h"
#include "patina/session.h"

namespace patina::python {

namespace {

using Unlocked = py::call_guard<py::gil_scoped_release>;  // the device works meanwhile

template <class Value>
using Words = std::vector<std::pair<std::string, Value>>;

template <class Value>
Value choice(const std::string& word, const char* name, const Words<Value>& words) {
    std::string known;
    for (const auto& [each, value] : words) {
        if (each == word) return value;
        known += (known.empty() ? "" : ", ") + each;
    }
    throw Error(name, " is '", word, "', must be one of: ", known);
}

LightingChoice lighting_of(const std::string& given) {
    if (given.empty()) return LightsBeside{};
    if (given == "none") return NoLights{};
    if (given == "self") return LightsFromMain{};
    if (given.ends_with(".json")) return LightsFromFile{given};
    return LightsFromSequence{given};
}

struct SessionArguments {
    uint32_t frames;
    std::string lighting, labels, materials, poses;
    std::optional<Settings> settings;
    std::optional<uint64_t> seed;
};

SessionOptions options_of(const std::string& sequence, const SessionArguments& given) {
    SessionOptions options;
    options.sequence = sequence;
    options.frames = given.frames;
    options.lighting = lighting_of(given.lighting);
    options.labels = choice<Labels>(
        given.labels, "labels", {{"geometry", Labels::kGeometry}, {"off", Labels::kOff}, {"truth", Labels::kTruth}});
    options.materials = choice<Materials>(given.materials, "materials",
                                          {{"auto", Materials::kAuto},
                                           {"fit", Materials::kFit},
                                           {"hemicnn", Materials::kNetwork},
                                           {"both", Materials::kBoth},
                                           {"off", Materials::kOff},
                                           {"truth", Materials::kTruth}});
    options.poses = choice<Poses>(
        given.poses, "poses",
        {{"auto", Poses::kAuto}, {"given", Poses::kGiven}, {"track", Poses::kTrack}, {"prior", Poses::kPrior}});
    if (given.settings) options.settings = *given.settings;
    options.seed = given.seed;
    // Ctrl-C ends a session between two frames.
    options.callbacks.stop = [] {
        const py::gil_scoped_acquire lock;
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        return false;
    };
    return options;
}

py::dict info_of(const SequenceInfo& info) {
    py::dict result;
    result["name"] = info.name;
    result["format"] = info.format;
    result["fps"] = info.fps;
    result["frames"] = info.frames;
    result["depth"] = info.depth;
    result["color"] = info.color;
    result["has_poses"] = info.has_poses;
    return result;
}

py::dict arrays_of(const ModelView& view) {
    py::dict result;
    result["position"] = copied(view.position_m);
    result["normal"] = copied(view.normal);
    result["color"] = copied(view.color);
    if (!view.label.empty()) result["label"] = copied(view.label);
    if (view.reflectance) {
        result["kd"] = copied(view.reflectance->kd);
        result["ks_alpha"] = copied(view.reflectance->ks_alpha);
        result["rgb"] = copied(view.reflectance->rgb);
    }
    return result;
}

/// Of a session or a reconstruction. Waits.
template <class From>
py::dict view_of(From& from, const Intrinsics& camera, const py::array_t<double>& world_from_camera) {
    const RigidTransform pose = to_transform(world_from_camera);
    std::optional<ModelView> view;
    {
        const py::gil_scoped_release unlocked;
        const PendingView pending = from.view(camera, pose);
        from.wait();
        view = pending.get();
    }
    return arrays_of(*view);
}

py::list segments_of(const Scene& scene) {
    py::list list;
    for (uint32_t label = 1; label < scene.reflectance.segments.size(); ++label) {
        const SegmentReflectance& segment = scene.reflectance.segments[label];
        if (segment.voxels == 0) continue;
        py::dict entry;
        const auto triple = [](glm::vec3 v) { return py::make_tuple(v.r, v.g, v.b); };
        entry["label"] = label;
        entry["voxels"] = segment.voxels;
        if (segment.kd) entry["kd"] = triple(*segment.kd);
        if (segment.gloss) {
            entry["ks"] = triple(segment.gloss->ks);
            entry["alpha"] = segment.gloss->alpha;
        }
        list.append(entry);
    }
    return list;
}

py::array_t<uint32_t> triangles_of(const py::object& self) {
    const auto& triangles = self.cast<const Scene&>().mesh.triangles;
    const uint32_t* data = triangles.empty() ? nullptr : triangles.front().data();
    return py::array_t<uint32_t>({static_cast<py::ssize_t>(triangles.size()), py::ssize_t{3}}, data, self);
}

py::array_t<double> trajectory_of(const Scene& scene) {
    py::array_t<double> poses({static_cast<py::ssize_t>(scene.trajectory.size()), py::ssize_t{4}, py::ssize_t{4}});
    for (size_t i = 0; i < scene.trajectory.size(); ++i)
        for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column)
                poses.mutable_at(i, row, column) = scene.trajectory[i].world_from_camera[column][row];
    return poses;
}

glm::dvec3 to_vector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }
py::tuple to_tuple(glm::dvec3 v) { return py::make_tuple(v.x, v.y, v.z); }

void add_types(py::module_& m) {
    static py::exception<Error> error(m, "Error", PyExc_RuntimeError);
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown) std::rethrow_exception(thrown);
        } catch (const Error& failure) {
            error(failure.what());
        }
    });
    py::class_<Device>(m, "Device", "An opened Vulkan device.")
        .def(py::init([](const std::string& selector, bool validation) {
                 return std::make_unique<Device>(DeviceChoice{.selector = selector, .validation = validation});
             }),
             py::arg("selector") = "", py::arg("validation") = false)
        .def_property_readonly("name", &Device::name)
        .def_property_readonly("driver", &Device::driver);
    m.def("device_names", &device_names, "The names of this machine's Vulkan devices.");
    py::class_<Intrinsics>(m, "Intrinsics", "A pinhole camera in pixels, with OpenCV's distortion k1 k2 p1 p2 k3.")
        .def(py::init([](uint32_t width, uint32_t height, double fx, double fy, double cx, double cy,
                         std::array<double, 5> distortion) {
                 return Intrinsics{{width, height}, fx, fy, cx, cy, distortion};
             }),
             py::arg("width"), py::arg("height"), py::arg("fx"), py::arg("fy"), py::arg("cx"), py::arg("cy"),
             py::arg("distortion") = std::array<double, 5>{})
        .def_property_readonly("width", [](const Intrinsics& camera) { return camera.extent.width; })
        .def_property_readonly("height", [](const Intrinsics& camera) { return camera.extent.height; })
        .def_readonly("fx", &Intrinsics::fx)
        .def_readonly("fy", &Intrinsics::fy)
        .def_readonly("cx", &Intrinsics::cx)
        .def_readonly("cy", &Intrinsics::cy);
    py::class_<Light>(m, "Light", "A lamp: radiance at distance r is intensity / r^2.")
        .def(py::init([](std::array<double, 3> position, std::array<double, 3> intensity, double radius) {
                 return Light{to_vector(position), to_vector(intensity), radius};
             }),
             py::arg("position"), py::arg("intensity"), py::arg("radius") = 0.0)
        .def_property_readonly("position", [](const Light& light) { return to_tuple(light.position_m); })
        .def_property_readonly("intensity", [](const Light& light) { return to_tuple(light.intensity); })
        .def_readonly("radius", &Light::radius_m);
    py::class_<Settings>(m, "Settings", "All settings by their keys; docs/settings.md lists them.")
        .def(py::init<>())
        .def("load", &Settings::load, py::arg("file"))
        .def("__setitem__",
             [](Settings& settings, const std::string& key, const py::object& value) {
                 const bool flag = py::isinstance<py::bool_>(value);
                 settings.set(key, flag ? (value.cast<bool>() ? "true" : "false") : std::string(py::str(value)));
             })
        .def("__getitem__", &Settings::get);
}

void add_scene(py::module_& m) {
    py::class_<Scene>(m, "Scene", "A finished reconstruction. Arrays share the scene's memory.")
        .def_readonly("name", &Scene::name)
        .def_property_readonly("positions",
                               [](py::object self) { return shared(self.cast<const Scene&>().mesh.positions_m, self); })
        .def_property_readonly("normals",
                               [](py::object self) { return shared(self.cast<const Scene&>().mesh.normals, self); })
        .def_property_readonly("colors",
                               [](py::object self) { return shared(self.cast<const Scene&>().mesh.colors, self); })
        .def_property_readonly("kd",
                               [](py::object self) { return shared(self.cast<const Scene&>().reflectance.kd, self); })
        .def_property_readonly("labels",
                               [](py::object self) {
                                   const auto& labels = self.cast<const Scene&>().reflectance.labels;
                                   return py::array_t<uint32_t>(static_cast<py::ssize_t>(labels.size()), labels.data(),
                                                                self);
                               })
        .def_property_readonly("triangles", &triangles_of)
        .def_property_readonly("segments", &segments_of)
        .def_property_readonly("trajectory", &trajectory_of)
        .def_property_readonly("lights", [](const Scene& scene) { return scene.lighting.lights; })
        .def_property_readonly("ambient", [](const Scene& scene) { return to_tuple(scene.lighting.ambient); })
        .def("save_glb", &Scene::save_glb, py::arg("file"), Unlocked())
        .def("save", &Scene::save, py::arg("folder"), Unlocked());
    py::class_<FrameResult>(m, "FrameResult")
        .def_readonly("fused", &FrameResult::fused)
        .def_readonly("reason", &FrameResult::reason)
        .def_property_readonly("state",
                               [](const FrameResult& result) {
                                   constexpr const char* kWords[] = {"tracking", "weak", "lost"};
                                   return kWords[static_cast<int>(result.state)];
                               })
        .def_property_readonly("world_from_camera",
                               [](const FrameResult& result) { return to_array(result.world_from_depth); });
}

void add_reconstruction(py::module_& m) {
    py::class_<Reconstruction>(m, "Reconstruction", "Fuses arrays.")
        .def(py::init([](Device& device, const std::optional<Settings>& settings, const std::vector<Light>& lights,
                         std::array<double, 3> ambient) {
                 const py::gil_scoped_release unlocked;
                 return std::make_unique<Reconstruction>(device, settings.value_or(Settings()),
                                                         Lighting{lights, to_vector(ambient), "given"});
             }),
             py::arg("device"), py::arg("settings") = std::nullopt, py::arg("lights") = std::vector<Light>(),
             py::arg("ambient") = std::array<double, 3>{}, py::keep_alive<1, 2>())
        .def(
            "add",
            [](Reconstruction& self, const py::array& depth, const py::array& color, const Intrinsics& camera,
               const std::optional<py::array_t<double>>& world_from_camera,
               const std::optional<Intrinsics>& color_camera,
               const std::optional<py::array_t<double>>& color_from_depth, double timestamp, double metres_per_unit,
               double max_metres) {
                RgbdFrame frame;
                frame.depth = to_depth(depth, camera, metres_per_unit, max_metres);
                frame.color = to_color(color, color_camera.value_or(camera));
                frame.world_from_depth = to_transform(world_from_camera);
                frame.color_from_depth = to_transform(color_from_depth);
                frame.time.timestamp_s = timestamp;
                const py::gil_scoped_release unlocked;
                return self.add(frame);
            },
            py::arg("depth"), py::arg("color"), py::arg("camera"), py::arg("world_from_camera") = std::nullopt,
            py::arg("color_camera") = std::nullopt, py::arg("color_from_depth") = std::nullopt,
            py::arg("timestamp") = 0.0, py::arg("metres_per_unit") = 0.001, py::arg("max_metres") = 8.0)
        .def("view", &view_of<Reconstruction>, py::arg("camera"), py::arg("world_from_camera"))
        .def("wait", &Reconstruction::wait, Unlocked())
        .def("finish", &Reconstruction::finish, Unlocked());
}

void add_session(py::module_& m) {
    py::class_<Session>(m, "Session", "Reconstructs all that a sequence holds.")
        .def(py::init([](Device& device, const std::string& sequence, uint32_t frames, const std::string& lighting,
                         const std::string& labels, const std::string& materials, const std::string& poses,
                         const std::optional<Settings>& settings, std::optional<uint64_t> seed) {
                 const SessionOptions options =
                     options_of(sequence, {frames, lighting, labels, materials, poses, settings, seed});
                 const py::gil_scoped_release unlocked;
                 return std::make_unique<Session>(device, options);
             }),
             py::arg("device"), py::arg("sequence"), py::kw_only(), py::arg("frames") = 0u, py::arg("lighting") = "",
             py::arg("labels") = "geometry", py::arg("materials") = "auto", py::arg("poses") = "auto",
             py::arg("settings") = std::nullopt, py::arg("seed") = std::nullopt, py::keep_alive<1, 2>())
        .def("step", &Session::step, Unlocked())
        .def_property_readonly("last", &Session::last)
        .def_property_readonly("info", [](const Session& session) { return info_of(session.info()); })
        .def("view", &view_of<Session>, py::arg("camera"), py::arg("world_from_camera"))
        .def("shortfalls", &Session::shortfalls, Unlocked())
        .def("finish", &Session::finish, Unlocked());
}

}  // namespace

PYBIND11_MODULE(patina, m) {
    m.doc() = "Geometry with materials from RGB-D streams, on any Vulkan device.";
    add_types(m);
    add_scene(m);
    add_reconstruction(m);
    add_session(m);
}

}  // namespace patina::python
