#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "patina/frame.h"

namespace patina {

class Device;

/// A frame that could not be used, and why, in one sentence that names its file.
struct Skipped {
    uint32_t index = 0;
    std::string reason;
    bool dropped = false;  ///< nothing was wrong with it: a live source had a newer frame
};

/// One step of a source: a frame, or the reason why there is none at this index.
using Reading = std::variant<Frame, Skipped>;

/// Where frames come from: a recording, a camera, a synthetic scene. Knows no reconstruction. Every index from 0 on is
/// yielded once, in order, as a frame or as skipped; of a source with a known length, all up to it.
class Source {
  public:
    virtual ~Source() = default;

    /// What holds for all frames; valid from construction on. A live source has no length (SequenceInfo::frames).
    virtual const SequenceInfo& info() const = 0;

    /// The next frame; empty after the last one, which a live source has when it is stopped. May wait for the camera.
    /// A damaged frame is skipped; what makes the whole source unusable throws Error.
    virtual std::optional<Reading> next() = 0;
};

/// Opens a recorded sequence: a folder, its sequence.json, or a file that `patina record` wrote. `format`: a name as
/// SequenceInfo::format; empty: recognised by the content. Throws Error when the path does not exist, is of no known
/// format, or the sequence as a whole is unusable.
std::unique_ptr<Source> open_recording(const std::filesystem::path& path, const std::string& format = "");

/// Renders a synthetic scene on the device as it is read. `scene` is the name of a built-in one ("cubes", "bunnies",
/// "office", "balls", "halls") or a JSON file; `frames`: how many, 0 takes 120. The device must outlive the source.
/// Throws Error when there is no such scene, or its file is wrong.
std::unique_ptr<Source> open_synthetic(Device& device, const std::string& scene, uint32_t frames = 0);

}  // namespace patina
