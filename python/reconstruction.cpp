// Fusing arrays of one's own.

#include "patina/reconstruction.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "python/bindings.h"
#include "python/choices.h"

namespace patina::python {

namespace {

using Unlocked = py::call_guard<py::gil_scoped_release>;
using Pose = std::optional<py::array_t<double>>;

std::unique_ptr<Reconstruction> make_reconstruction(Device& device, const std::optional<Settings>& settings,
                                                    std::vector<Light> lights, std::array<double, 3> ambient,
                                                    const std::string& labels, const std::string& materials,
                                                    const std::string& poses, const std::string& gains,
                                                    const std::filesystem::path& network,
                                                    std::optional<uint64_t> seed) {
    ReconstructionOptions options;
    options.lighting = Lighting{std::move(lights), {ambient[0], ambient[1], ambient[2]}, "given"};
    set_choices(options, labels, materials, poses, gains, network, seed, settings);
    const py::gil_scoped_release released;
    return std::make_unique<Reconstruction>(device, options);
}

/// A frame without a pose is one for a tracker alone: at the identity it would be fused where the camera was not.
RigidTransform pose_of(const Reconstruction& reconstruction, const Pose& given) {
    if (given) return to_transform(*given, "world_from_camera");
    if (!reconstruction.tracks())
        throw Error("the frame has no pose: give world_from_camera, or make the reconstruction with poses='track'");
    return RigidTransform(1.0);
}

FrameResult add(Reconstruction& self, const py::object& depth, const py::object& color, const Intrinsics& camera,
                const Pose& world_from_camera, const std::optional<Intrinsics>& color_camera,
                const Pose& color_from_depth, double timestamp, double metres_per_unit, double max_metres,
                const py::object& labels, const Pose& prior, bool held_out) {
    RgbdFrame frame;
    frame.depth = to_depth(depth, camera, metres_per_unit, max_metres);
    frame.color = to_color(color, color_camera.value_or(camera));
    frame.world_from_depth = pose_of(self, world_from_camera);
    if (color_from_depth) frame.color_from_depth = to_transform(*color_from_depth, "color_from_depth");
    if (!labels.is_none()) frame.labels = to_labels(labels, camera);
    frame.time.timestamp_s = timestamp;
    if (prior) frame.time.prior = to_transform(*prior, "prior");
    frame.held_out = held_out;
    const py::gil_scoped_release released;  // the arguments keep the arrays alive
    return self.add(frame);
}

}  // namespace

void bind_reconstruction(py::module_& m) {
    py::class_<Reconstruction>(m, "Reconstruction", "Fuses arrays. With light, segments and their materials are found.")
        .def(py::init(&make_reconstruction), py::arg("device"), py::arg("settings") = std::nullopt,
             py::arg("lights") = py::tuple(), py::arg("ambient") = std::array<double, 3>{}, py::kw_only(),
             py::arg("labels") = "geometry", py::arg("materials") = "auto", py::arg("poses") = "auto",
             py::arg("gains") = "auto", py::arg("network") = "", py::arg("seed") = std::nullopt, py::keep_alive<1, 2>())
        .def("add", &add, py::arg("depth"), py::arg("color"), py::arg("camera"),
             py::arg("world_from_camera") = std::nullopt, py::arg("color_camera") = std::nullopt,
             py::arg("color_from_depth") = std::nullopt, py::arg("timestamp") = 0.0, py::arg("metres_per_unit") = 0.001,
             py::arg("max_metres") = 8.0, py::kw_only(), py::arg("labels") = std::nullopt,
             py::arg("prior") = std::nullopt, py::arg("held_out") = false)
        .def("view", &view_of<Reconstruction>, py::arg("camera"), py::arg("world_from_camera"))
        .def("wait", &Reconstruction::wait, Unlocked())
        .def_property_readonly("tracks", &Reconstruction::tracks)
        .def("statistics", [](Reconstruction& self) { return to_dict(self.statistics()); })
        .def("finish", &Reconstruction::finish, Unlocked());
}

}  // namespace patina::python
