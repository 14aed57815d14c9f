#pragma once

#include <memory>
#include <optional>
#include <utility>

#include <pybind11/pybind11.h>

#include "patina/session.h"

namespace patina::python {

namespace py = pybind11;

/// What a session calls in Python. The interpreter is held by each call alone. What a callback raises, and Ctrl-C,
/// stops the session as its own `stop` does, and is thrown by run() once the session has stopped: an exception of
/// Python would not be known for one in a search that goes on without what has failed.
class Callbacks {
  public:
    /// Each may be None.
    Callbacks(py::object progress, py::object message, py::object stop);

    /// They share `callbacks`, so that copies can be destroyed without the interpreter. The last one needs it.
    static SessionCallbacks of(const std::shared_ptr<Callbacks>& callbacks);

    /// What `work` returns, which runs without the interpreter. Throws what was raised meanwhile, else what `work`
    /// does.
    template <class Work>
    auto run(Work&& work) {
        try {
            auto result = unlocked(std::forward<Work>(work));
            throw_raised();
            return result;
        } catch (...) {
            throw_raised();
            throw;
        }
    }

  private:
    template <class Work>
    static auto unlocked(Work&& work) {
        const py::gil_scoped_release released;
        return work();
    }
    template <class Call>
    bool call(Call&& call);
    void throw_raised();

    py::object progress_, message_, stop_;
    std::optional<py::error_already_set> raised_;
};

}  // namespace patina::python
