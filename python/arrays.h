#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <glm/glm.hpp>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "patina/camera.h"
#include "patina/frame.h"

namespace patina::python {

namespace py = pybind11;

/// A transform as a 4 x 4 array whose rows are the matrix's rows, and back. Throws Error for another shape, values that
/// are not finite, or what is no rigid transform; `what` names it then.
py::array_t<double> to_array(const RigidTransform& transform);
RigidTransform to_transform(const py::array_t<double>& array, const char* what);

/// Three numbers.
py::tuple to_tuple(glm::dvec3 v);

/// A depth picture: uint16 units or float32 metres, H x W of the camera, C order. Borrows the array's memory. Throws
/// Error for another type, shape or layout, and for what is no array.
DepthInput to_depth(const py::object& given, const Intrinsics& camera, double metres_per_unit, double max_metres);

/// A colour picture: uint8 sRGB or float32 linear, H x W x 3. Borrows likewise.
ColorInput to_color(const py::object& given, const Intrinsics& camera);

/// Labels of a depth picture's pixels: uint16, H x W. Borrows likewise.
std::span<const uint16_t> to_labels(const py::object& given, const Intrinsics& camera);

/// An array that shares the memory of `owner`, which it keeps alive. It cannot be written to: indices are not checked
/// again when a scene is saved.
template <class T>
py::array_t<T> shared(std::vector<py::ssize_t> shape, const T* data, py::handle owner) {
    if (!data) return py::array_t<T>(std::move(shape));
    py::array_t<T> array(std::move(shape), data, owner);
    py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return array;
}

/// Rows of vectors as an N x L array that shares their memory.
template <glm::length_t L, class T, glm::qualifier Q>
py::array_t<T> shared(const std::vector<glm::vec<L, T, Q>>& rows, py::handle owner) {
    return shared<T>({static_cast<py::ssize_t>(rows.size()), py::ssize_t{L}}, rows.empty() ? nullptr : &rows.front()[0],
                     owner);
}

/// Hands a vector to Python, whose arrays it is the base of.
template <class Value>
std::pair<const Value*, py::capsule> handed_over(std::vector<Value> values) {
    auto owned = std::make_unique<std::vector<Value>>(std::move(values));
    const Value* data = owned->data();
    py::capsule owner(owned.get(), [](void* vector) { delete static_cast<std::vector<Value>*>(vector); });
    owned.release();  // the capsule's now
    return {data, std::move(owner)};
}

/// An image of vectors as an H x W x L array, of numbers as an H x W array. The image's memory becomes the array's.
template <glm::length_t L, class T, glm::qualifier Q>
py::array_t<T> moved(Image<glm::vec<L, T, Q>> image) {
    const Extent2D extent = image.extent();
    const auto [data, owner] = handed_over(std::move(image.pixels()));
    return py::array_t<T>({py::ssize_t{extent.height}, py::ssize_t{extent.width}, py::ssize_t{L}}, &data->x, owner);
}

template <class T>
py::array_t<T> moved(Image<T> image) {
    const Extent2D extent = image.extent();
    const auto [data, owner] = handed_over(std::move(image.pixels()));
    return py::array_t<T>({py::ssize_t{extent.height}, py::ssize_t{extent.width}}, data, owner);
}

}  // namespace patina::python
