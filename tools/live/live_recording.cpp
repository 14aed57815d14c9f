#include "tools/live/live_recording.h"

#include <utility>

#include "engine/core/error.h"

namespace patina::tools {

void LiveRecording::start(const std::filesystem::path& file) {
    auto recorder = std::make_shared<sensor::Recorder>(file);
    auto pass = std::make_shared<CameraPass>(recorder);
    pass->begin(sensor::SequenceRole::kMain, sequence_);
    recorder_ = std::move(recorder);
    file_ = file;
    const std::lock_guard lock(mutex_);
    pass_ = std::move(pass);
}

void LiveRecording::stop() {
    if (!recorder_) return;
    {
        const std::lock_guard lock(mutex_);
        pass_->end();
        pass_.reset();
    }
    EndedRecording ended{file_, {}, "", ""};
    try {
        recorder_->finish();
    } catch (const Error& error) {
        ended.problem = error.what();
    }
    ended.counts = recorder_->counts();
    ended.warning = recorder_->warning();
    if (ended.counts.given == 0) recorder_->discard();
    recorder_.reset();
    ended_.push_back(std::move(ended));
}

std::optional<std::filesystem::path> LiveRecording::file() const {
    return recorder_ ? std::optional(file_) : std::nullopt;
}

std::shared_ptr<CameraPass> LiveRecording::pass() const {
    const std::lock_guard lock(mutex_);
    return pass_;
}

}  // namespace patina::tools
