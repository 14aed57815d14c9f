// Lamps, and where a session's lights come from.

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "patina/session.h"
#include "python/arrays.h"
#include "python/bindings.h"

namespace patina::python {

namespace {

glm::dvec3 to_vector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

void bind_lamps(py::module_& m) {
    py::class_<Light>(m, "Light",
                      "A lamp: radiance at distance r is intensity / r^2, of a flat one times the cosine to its axis.")
        .def(py::init([](std::array<double, 3> position, std::array<double, 3> intensity, double radius,
                         std::array<double, 3> axis) {
                 return Light{to_vector(position), to_vector(intensity), radius, to_vector(axis)};
             }),
             py::arg("position"), py::arg("intensity"), py::arg("radius") = 0.0,
             py::arg("axis") = std::array<double, 3>{})
        .def_property_readonly("position", [](const Light& light) { return to_tuple(light.position_m); })
        .def_property_readonly("intensity", [](const Light& light) { return to_tuple(light.intensity); })
        .def_readonly("radius", &Light::radius_m)
        .def_property_readonly("axis", [](const Light& light) { return to_tuple(light.axis); });
    py::class_<AreaLight>(m, "AreaLight", "A window as a rectangle that shines to half_u x half_v.")
        .def_property_readonly("center", [](const AreaLight& window) { return to_tuple(window.center_m); })
        .def_property_readonly("half_u", [](const AreaLight& window) { return to_tuple(window.half_u_m); })
        .def_property_readonly("half_v", [](const AreaLight& window) { return to_tuple(window.half_v_m); })
        .def_property_readonly("radiance", [](const AreaLight& window) { return to_tuple(window.radiance); })
        .def_readonly("clipped", &AreaLight::clipped);
    py::class_<Lighting>(m, "Lighting", "What lights a room: lamps, windows, and light that arrives everywhere alike.")
        .def(py::init([](std::vector<Light> lights, std::array<double, 3> ambient) {
                 return Lighting{std::move(lights), to_vector(ambient), "given"};
             }),
             py::arg("lights") = py::tuple(), py::arg("ambient") = std::array<double, 3>{})
        .def_property_readonly("lights", [](const Lighting& lighting) { return lighting.lights; })
        .def_property_readonly("ambient", [](const Lighting& lighting) { return to_tuple(lighting.ambient); })
        .def_readonly("found_by", &Lighting::found_by)
        .def_property_readonly("windows", [](const Lighting& lighting) { return lighting.windows; });
    m.def("read_lighting", &read_lighting, py::arg("file"), "Reads a lights.json.");
    m.def("write_lighting", &write_lighting, py::arg("file"), py::arg("lighting"), "Writes a lights.json.");
}

void bind_choices(py::module_& m) {
    py::class_<LightsBeside>(m, "LightsBeside",
                             "Lights of the sequence's own lighting/; without one, looked for in what they light.")
        .def(py::init<>());
    py::class_<NoLights>(m, "NoLights", "No light: geometry and colours alone.").def(py::init<>());
    py::class_<LightsFromFile>(m, "LightsFromFile", "The lights of a lights.json, whatever its name.")
        .def(py::init([](std::filesystem::path file) { return LightsFromFile{std::move(file)}; }), py::arg("file"))
        .def_readonly("file", &LightsFromFile::file);
    py::class_<LightsFromSequence>(m, "LightsFromSequence", "Lights that a sequence of low exposure shows.")
        .def(py::init([](const std::filesystem::path& sequence) { return LightsFromSequence{sequence.string()}; }),
             py::arg("sequence"))
        .def_readonly("sequence", &LightsFromSequence::sequence);
    py::class_<LightsFromMain>(m, "LightsFromMain", "Lights as the sequence itself shows what they light.")
        .def(py::init<>());
}

}  // namespace

void bind_lighting(py::module_& m) {
    bind_lamps(m);
    bind_choices(m);
}

}  // namespace patina::python
