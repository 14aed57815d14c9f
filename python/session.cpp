// Reconstructing all that a sequence holds.

#include "patina/session.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "python/bindings.h"
#include "python/callbacks.h"
#include "python/choices.h"

namespace patina::python {

namespace {

/// A session, and what it calls.
struct Running {
    std::shared_ptr<Callbacks> callbacks;
    std::unique_ptr<Session> session;
};

std::unique_ptr<Running> make_session(Device& device, const std::filesystem::path& sequence, const std::string& format,
                                      uint32_t frames, const GivenLighting& lighting, const std::string& labels,
                                      const std::string& materials, const std::string& poses, const std::string& gains,
                                      const std::filesystem::path& network, std::optional<uint64_t> seed,
                                      uint32_t hold_out, const std::filesystem::path& map, uint32_t checkpoint_every,
                                      bool resume, const std::filesystem::path& extends,
                                      const std::string& reflectance_for, const std::string& detail, float white_albedo,
                                      const std::optional<Settings>& settings, py::object progress, py::object message,
                                      py::object stop) {
    const auto callbacks = std::make_shared<Callbacks>(std::move(progress), std::move(message), std::move(stop));
    SessionOptions options;
    options.sequence = sequence.string();
    options.format = format;
    options.frames = frames;
    options.lighting = to_choice(lighting);
    set_choices(options, labels, materials, poses, gains, network, seed, settings);
    options.hold_out = hold_out;
    options.detail = to_detail(detail);
    options.white_albedo = white_albedo;
    options.map = map;
    options.checkpoint_every = checkpoint_every;
    options.resume = resume;
    options.extends = extends;
    options.reflectance_for = reflectance_for;
    options.callbacks = Callbacks::of(callbacks);
    auto session = callbacks->run([&] { return std::make_unique<Session>(device, options); });
    return std::make_unique<Running>(Running{callbacks, std::move(session)});
}

bool step(Running& self) {
    return self.callbacks->run([&] { return self.session->step(); });
}

void checkpoint(Running& self) {
    const py::gil_scoped_release released;
    self.session->checkpoint();
}

py::dict info_of(const SequenceInfo& info) {
    py::dict result;
    result["name"] = info.name;
    result["format"] = info.format;
    result["fps"] = info.fps;
    result["frames"] = info.frames;
    result["depth"] = info.depth;
    result["color"] = info.color;
    result["color_from_depth"] = to_array(info.color_from_depth);
    result["has_poses"] = info.has_poses;
    return result;
}

std::vector<std::string> shortfalls(Running& self) {
    const py::gil_scoped_release released;
    return self.session->shortfalls();
}

Scene finish(Running& self) {
    return self.callbacks->run([&] { return self.session->finish(); });
}

void wait(Running& self) {
    const py::gil_scoped_release released;
    self.session->wait();
}

}  // namespace

void bind_session(py::module_& m) {
    py::class_<Running>(m, "Session", "Reconstructs all that a sequence holds.")
        .def(py::init(&make_session), py::arg("device"), py::arg("sequence"), py::kw_only(), py::arg("format") = "",
             py::arg("frames") = 0u, py::arg("lighting") = "", py::arg("labels") = "geometry",
             py::arg("materials") = "auto", py::arg("poses") = "auto", py::arg("gains") = "auto",
             py::arg("network") = "", py::arg("seed") = std::nullopt, py::arg("hold_out") = 0u, py::arg("map") = "",
             py::arg("checkpoint_every") = 0u, py::arg("resume") = false, py::arg("extends") = "",
             py::arg("reflectance_for") = "", py::arg("detail") = "auto", py::arg("white_albedo") = 0.8f,
             py::arg("settings") = std::nullopt, py::arg("progress") = std::nullopt, py::arg("message") = std::nullopt,
             py::arg("stop") = std::nullopt, py::keep_alive<1, 2>())
        .def("step", &step)
        .def("checkpoint", &checkpoint)
        // A copy: the session's own changes with the next step.
        .def_property_readonly("last", [](const Running& self) { return std::optional(self.session->last()); })
        .def_property_readonly("info", [](const Running& self) { return info_of(self.session->info()); })
        .def_property_readonly("lighting", [](const Running& self) { return self.session->lighting(); })
        .def(
            "view",
            [](Running& self, const Intrinsics& camera, const py::array_t<double>& world_from_camera) {
                return view_of(*self.session, camera, world_from_camera);
            },
            py::arg("camera"), py::arg("world_from_camera"))
        .def("wait", &wait)
        .def("statistics", [](Running& self) { return to_dict(self.session->statistics()); })
        .def("shortfalls", &shortfalls)
        .def("finish", &finish);
}

}  // namespace patina::python
