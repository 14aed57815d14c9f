#include "python/bindings.h"

PYBIND11_MODULE(patina, m) {
    m.doc() = "Geometry with materials from RGB-D streams, on any Vulkan device.";
    patina::python::bind_types(m);
    patina::python::bind_lighting(m);
    patina::python::bind_scene(m);
    patina::python::bind_reconstruction(m);
    patina::python::bind_session(m);
}
