#include "python/arrays.h"

#include <cmath>
#include <optional>
#include <string>

#include "patina/error.h"

namespace patina::python {

namespace {

/// The largest entry by which R^T R of a pose may differ from the identity.
constexpr double kMaxRotationDefect = 1e-3;

std::string shape_of(const py::array& array) {
    std::string shape = "(";
    for (py::ssize_t i = 0; i < array.ndim(); ++i) shape += (i > 0 ? ", " : "") + std::to_string(array.shape(i));
    return shape + ") " + std::string(py::str(array.dtype()));
}

py::array to_numpy(const py::object& given, const char* what) {
    if (!py::isinstance<py::array>(given))
        throw Error(what, " is a numpy array, not ", std::string(py::str(py::type::handle_of(given).attr("__name__"))));
    return py::reinterpret_borrow<py::array>(given);
}

/// The array's pixels where it is of this type; its shape must be H x W x channels then, and its memory that of an
/// image without gaps, whose values stand where this type may stand.
template <class Value, class Pixel>
std::optional<std::span<const Pixel>> pixels_of(const py::array& array, Extent2D extent, py::ssize_t channels,
                                                const char* what) {
    if (!py::isinstance<py::array_t<Value>>(array)) return std::nullopt;
    const py::ssize_t dimensions = channels > 1 ? 3 : 2;
    const bool fits = array.ndim() == dimensions && array.shape(0) == static_cast<py::ssize_t>(extent.height) &&
                      array.shape(1) == static_cast<py::ssize_t>(extent.width) &&
                      (channels == 1 || array.shape(2) == channels);
    if (!fits)
        throw Error("the ", what, " array is ", shape_of(array), ", but its camera has ", extent.height, " x ",
                    extent.width, " pixels", channels > 1 ? text(" of ", channels, " channels") : "");
    if ((array.flags() & py::array::c_style) == 0)
        throw Error("the ", what, " array is not in C order; numpy.ascontiguousarray() makes it so");
    if ((array.flags() & py::detail::npy_api::NPY_ARRAY_ALIGNED_) == 0)
        throw Error("the ", what, " array is not aligned; its copy() is");
    return std::span(reinterpret_cast<const Pixel*>(array.data()), extent.area());
}

}  // namespace

py::array_t<double> to_array(const RigidTransform& transform) {
    py::array_t<double> array({4, 4});
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) array.mutable_at(row, column) = transform[column][row];
    return array;
}

RigidTransform to_transform(const py::array_t<double>& array, const char* what) {
    if (array.ndim() != 2 || array.shape(0) != 4 || array.shape(1) != 4)
        throw Error(what, " is a 4 x 4 array, not ", shape_of(array));
    RigidTransform transform(1.0);
    bool finite = true;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            transform[column][row] = array.at(row, column);
            finite = finite && std::isfinite(array.at(row, column));
        }
    }
    if (!finite) throw Error(what, " holds values that are not finite");
    const double defect = rotation_defect(transform);
    if (!(defect < kMaxRotationDefect)) throw Error(what, " is no rigid transform: its rotation is off by ", defect);
    for (int column = 0; column < 4; ++column)
        if (transform[column][3] != (column == 3 ? 1 : 0))
            throw Error(what, " is no rigid transform: its last row is not 0 0 0 1");
    return transform;
}

py::tuple to_tuple(glm::dvec3 v) { return py::make_tuple(v.x, v.y, v.z); }

DepthInput to_depth(const py::object& given, const Intrinsics& camera, double metres_per_unit, double max_metres) {
    const py::array array = to_numpy(given, "depth");
    DepthInput depth;
    depth.camera = camera;
    depth.metres_per_unit = metres_per_unit;
    depth.max_metres = max_metres;
    if (const auto units = pixels_of<uint16_t, uint16_t>(array, camera.extent, 1, "depth"))
        depth.pixels = *units;
    else if (const auto metres = pixels_of<float, float>(array, camera.extent, 1, "depth"))
        depth.pixels = *metres;
    else
        throw Error("depth is uint16 (units) or float32 (metres), not ", shape_of(array));
    return depth;
}

ColorInput to_color(const py::object& given, const Intrinsics& camera) {
    const py::array array = to_numpy(given, "colour");
    ColorInput color;
    color.camera = camera;
    if (const auto srgb = pixels_of<uint8_t, glm::u8vec3>(array, camera.extent, 3, "colour"))
        color.pixels = *srgb;
    else if (const auto linear = pixels_of<float, glm::vec3>(array, camera.extent, 3, "colour"))
        color.pixels = *linear;
    else
        throw Error("colour is uint8 (sRGB) or float32 (linear), not ", shape_of(array));
    return color;
}

std::span<const uint16_t> to_labels(const py::object& given, const Intrinsics& camera) {
    const py::array array = to_numpy(given, "labels");
    const auto labels = pixels_of<uint16_t, uint16_t>(array, camera.extent, 1, "label");
    if (!labels) throw Error("labels are uint16, not ", shape_of(array));
    return *labels;
}

}  // namespace patina::python
