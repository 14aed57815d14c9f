#include "python/callbacks.h"

#include <string>

#include <pybind11/stl.h>

namespace patina::python {

Callbacks::Callbacks(py::object progress, py::object message, py::object stop)
    : progress_(std::move(progress)), message_(std::move(message)), stop_(std::move(stop)) {}

/// Whether the session is to stop: the call says so, or it or one before it raised something.
template <class Call>
bool Callbacks::call(Call&& call) {
    const py::gil_scoped_acquire held;
    if (raised_) return true;
    try {
        return call();
    } catch (const py::error_already_set& error) {
        raised_ = error;
        return true;
    }
}

SessionCallbacks Callbacks::of(const std::shared_ptr<Callbacks>& callbacks) {
    SessionCallbacks result;
    result.stop = [callbacks] {
        return callbacks->call([&] {
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();  // Ctrl-C
            return !callbacks->stop_.is_none() && bool(py::bool_(callbacks->stop_()));
        });
    };
    if (!callbacks->progress_.is_none()) {
        result.progress = [callbacks](const SessionProgress& progress) {
            callbacks->call([&] {
                callbacks->progress_(std::string(progress.task), progress.done, progress.total, progress.detail);
                return false;
            });
        };
    }
    if (!callbacks->message_.is_none()) {
        result.message = [callbacks](const std::string& line) {
            callbacks->call([&] {
                callbacks->message_(line);
                return false;
            });
        };
    }
    return result;
}

void Callbacks::throw_raised() {
    if (!raised_) return;
    const py::error_already_set error = *std::exchange(raised_, std::nullopt);
    throw error;
}

}  // namespace patina::python
