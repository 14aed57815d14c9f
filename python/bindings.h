#pragma once

#include <memory>
#include <optional>

#include <pybind11/pybind11.h>

#include "patina/reconstruction.h"
#include "python/arrays.h"

namespace patina::python {

/// Add the module's classes. Those of later functions need those of earlier ones.
void bind_types(py::module_& m);
void bind_lighting(py::module_& m);
void bind_scene(py::module_& m);
void bind_reconstruction(py::module_& m);
void bind_session(py::module_& m);

/// A view's pictures by name.
py::dict to_dict(ModelView view);
py::dict to_dict(const Statistics& statistics);

/// What `from`, a session or a reconstruction, shows to a camera. Waits, without the interpreter.
template <class From>
py::dict view_of(From& from, const Intrinsics& camera, const py::array_t<double>& world_from_camera) {
    const RigidTransform pose = to_transform(world_from_camera, "world_from_camera");
    std::optional<ModelView> view;
    {
        const py::gil_scoped_release released;
        const PendingView pending = from.view(camera, pose);
        from.wait();
        view = pending.get();
    }
    return to_dict(*std::move(view));
}

}  // namespace patina::python
