// Errors, devices, cameras, settings.

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "patina/device.h"
#include "patina/settings.h"
#include "python/bindings.h"

namespace patina::python {

namespace {

using Unlocked = py::call_guard<py::gil_scoped_release>;  // the device works meanwhile

void bind_errors(py::module_& m) {
    // The one that was registered last is looked at first.
    const auto error = py::register_exception<Error>(m, "Error", PyExc_RuntimeError);
    py::register_exception<Interrupted>(m, "Interrupted", error);
    error.attr("__doc__") = "What the outside causes: a file, a device, memory, settings, or wrong arguments.";
    m.attr("Interrupted").attr("__doc__") = "The stop callback asked to stop. What was fused so far is still there.";
}

void bind_device(py::module_& m) {
    py::class_<Device>(m, "Device",
                       "An opened Vulkan device. One thread at a time works with it and what is made on it.")
        .def(py::init([](const std::string& selector, bool validation,
                         const std::filesystem::path& pipeline_cache_folder, uint64_t memory_limit) {
                 return std::make_unique<Device>(DeviceChoice{.selector = selector,
                                                              .validation = validation,
                                                              .pipeline_cache_folder = pipeline_cache_folder,
                                                              .memory_limit = memory_limit});
             }),
             py::arg("selector") = "", py::arg("validation") = false, py::arg("pipeline_cache_folder") = "",
             py::arg("memory_limit") = uint64_t{0})
        .def_property_readonly("name", &Device::name)
        .def_property_readonly("driver", &Device::driver)
        .def("validation_messages", &Device::validation_messages);
    m.def("device_names", &device_names, "The names of this machine's Vulkan devices.", Unlocked());
}

void bind_intrinsics(py::module_& m) {
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
        .def_readonly("cy", &Intrinsics::cy)
        .def_property_readonly("distortion", [](const Intrinsics& camera) { return camera.distortion; });
}

std::string text_of(const py::object& value) {
    if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
    return py::str(value);
}

void bind_settings(py::module_& m) {
    py::class_<Settings>(m, "Settings", "All settings by their keys; docs/settings.md lists them.")
        .def(py::init<>())
        .def("load", &Settings::load, py::arg("file"))
        .def(
            "__setitem__",
            [](Settings& settings, const std::string& key, const py::object& value) {
                settings.set(key, text_of(value));
            },
            py::arg("key"), py::arg("value"))
        .def("__getitem__", &Settings::get, py::arg("key"));
}

}  // namespace

void bind_types(py::module_& m) {
    bind_errors(m);
    bind_device(m);
    bind_intrinsics(m);
    bind_settings(m);
}

}  // namespace patina::python
