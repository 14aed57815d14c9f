#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "patina/camera.h"
#include "patina/frame.h"

namespace patina::python {

namespace py = pybind11;

/// A transform as a 4 x 4 array whose rows are the matrix's rows, and back. Throws Error for another shape.
py::array_t<double> to_array(const RigidTransform& transform);
RigidTransform to_transform(const std::optional<py::array_t<double>>& array);

/// A depth picture: uint16 units or float32 metres, H x W of the camera, C order. Borrows the array's memory. Throws
/// Error for another type or shape.
DepthInput to_depth(const py::array& array, const Intrinsics& camera, double metres_per_unit, double max_metres);

/// A colour picture: uint8 sRGB or float32 linear, H x W x 3. Borrows likewise.
ColorInput to_color(const py::array& array, const Intrinsics& camera);

/// Rows of vectors as an N x L array that shares their memory; `owner` keeps it alive.
template <glm::length_t L, class T, glm::qualifier Q>
py::array_t<T> shared(const std::vector<glm::vec<L, T, Q>>& rows, py::handle owner) {
    const T* data = rows.empty() ? nullptr : &rows.front()[0];
    return py::array_t<T>({static_cast<py::ssize_t>(rows.size()), py::ssize_t{L}}, data, owner);
}

/// An image of vectors as an H x W x L array, copied.
template <glm::length_t L, class T, glm::qualifier Q>
py::array_t<T> copied(const Image<glm::vec<L, T, Q>>& image) {
    const T* data = image.empty() ? nullptr : &image.pixels().front()[0];
    return py::array_t<T>({py::ssize_t{image.extent().height}, py::ssize_t{image.extent().width}, py::ssize_t{L}},
                          data);
}

/// An image of numbers as an H x W array, copied.
template <class T>
py::array_t<T> copied(const Image<T>& image) {
    return py::array_t<T>({py::ssize_t{image.extent().height}, py::ssize_t{image.extent().width}},
                          image.pixels().data());
}

}  // namespace patina::python
