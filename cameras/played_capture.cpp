#include "cameras/played_capture.h"

#include "engine/core/error.h"

namespace patina::cameras {

PlayedCapture::PlayedCapture(const std::filesystem::path& file, sensor::SequenceRole role)
    : file_(file),
      role_(role),
      sequence_(file_.sequence(role)),
      name_("'" + file.string() + "'"),
      frames_(*sequence_.info.frames),
      player_([this] { return read(); }) {
    if (frames_ == 0) throw Error(name_, " holds no frame of the ", sensor::name_of(role), " sequence");
    if (sequence_.info.name.empty()) sequence_.info.name = file.stem().string();
    sequence_.info.frames.reset();
}

std::optional<RawReading> PlayedCapture::read() {
    if (next_ == frames_) return std::nullopt;
    return file_.read(role_, next_++);
}

}  // namespace patina::cameras
