#include "tools/program/console.h"

#include "engine/core/printable.h"
#include "tools/program/standard_streams.h"

namespace patina::tools {

namespace {

/// A task of SessionProgress in words.
std::string stage_of(const std::string& task) {
    if (task == "frames") return "Reconstructing";
    if (task == "lamps" || task == "lights") return "Looking for " + task;
    return task;
}

}  // namespace

SessionCallbacks Console::callbacks() {
    return {.progress = [this](const SessionProgress& progress) { show(progress); },
            .message = [this](const std::string& message) { say(message); },
            .stop = [this] { return interrupt_.requested(); }};
}

void Console::show(const SessionProgress& progress) {
    if (!progress_ || task_ != progress.task) {
        task_ = progress.task;
        progress_.emplace(stage_of(task_), progress.total, quiet_);
    }
    progress_->update(progress.done, progress.detail);
}

void Console::say(const std::string& message) {
    if (progress_)
        progress_->say(message);
    else if (!quiet_)
        print_error("{}\n", printable(message));
}

}  // namespace patina::tools
