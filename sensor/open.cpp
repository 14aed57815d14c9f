#include "sensor/open.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "engine/core/did_you_mean.h"
#include "engine/core/input_file.h"
#include "sensor/readers/native.h"
#include "sensor/readers/oni.h"
#include "sensor/readers/oni_file.h"
#include "sensor/readers/open3d.h"
#include "sensor/readers/seven_scenes.h"
#include "sensor/readers/tum.h"
#include "sensor/recording/container.h"

namespace patina::sensor {
namespace {

namespace fs = std::filesystem;

struct Format {
    std::string_view name;
    std::string_view content;  ///< what recognises() looks for, for the message that nothing was found
    bool (*recognises)(const fs::path&);
    std::unique_ptr<Source> (*open)(const fs::path&);
};

constexpr std::array kFormats{
    Format{"patina-sequence", "sequence.json", is_native_sequence, open_native},
    Format{"7-scenes", "frame-NNNNNN.depth.png", is_seven_scenes_sequence, open_seven_scenes},
    Format{"tum", "rgb.txt with depth.txt", is_tum_sequence, open_tum},
    Format{"open3d", "camera_intrinsic.json with color/ and depth/", is_open3d_sequence, open_open3d},
};

/// Of a sequence that is named by its folder or by its sequence.json.
fs::path folder_of(const fs::path& sequence) {
    return sequence.filename() == "sequence.json" ? fs::absolute(sequence).parent_path() : sequence;
}

/// All formats' names or contents in one enumeration: "a, b or c".
std::string enumerated(std::string_view Format::*member) {
    std::string list;
    for (size_t i = 0; i < kFormats.size(); ++i) {
        if (i > 0) list += i + 1 < kFormats.size() ? ", " : " or ";
        list += kFormats[i].*member;
    }
    return list;
}

const Format* format_of(const fs::path& folder) {
    const auto found =
        std::find_if(kFormats.begin(), kFormats.end(), [&](const Format& f) { return f.recognises(folder); });
    return found == kFormats.end() ? nullptr : found;
}

/// The first sub-folder, by name, that is a sequence; empty when there is none.
fs::path sequence_inside(const fs::path& folder) {
    for (const fs::path& entry : entries_of(folder)) {
        try {
            if (is_folder(entry) && format_of(entry)) return entry;
        } catch (const Error&) {  // it may not be entered
        }
    }
    return {};
}

const Format& recognised(const fs::path& folder) {
    if (const Format* format = format_of(folder)) return *format;
    const std::string nothing = text(folder.string(), " is no sequence: it holds no ", enumerated(&Format::content));
    const fs::path inside = sequence_inside(folder);
    throw inside.empty() ? Error(nothing) : Error(nothing, ", but ", inside.string(), " does");
}

const Format& named(const std::string& name) {
    const auto found = std::find_if(kFormats.begin(), kFormats.end(), [&](const Format& f) { return f.name == name; });
    if (found == kFormats.end()) {
        std::vector<std::string> names;
        for (const Format& format : kFormats) names.emplace_back(format.name);
        throw Error("format '", name, "' is not known, must be ", format_names(), did_you_mean(name, names));
    }
    return *found;
}

}  // namespace

std::string format_names() { return enumerated(&Format::name); }

void expect_sequence_path(const fs::path& path) {
    if (names_recording(path)) return;
    if (path.empty()) throw Error("a sequence is named by an empty path, but must be a folder");
    if (!path_exists(path)) throw Error(path.string(), " does not exist");
}

std::unique_ptr<Source> open_sequence(const fs::path& path, const std::string& format,
                                      const MakePayloadDecoder& make_decoder) {
    if (names_recording(path)) return open_recording(path, make_decoder);
    expect_sequence_path(path);
    if (is_oni_file(path)) return open_oni(path);
    const fs::path folder = folder_of(path);
    if (!is_folder(folder))
        throw Error(path.string(), " is a file, but a sequence is a folder, or a recording of Patina or OpenNI");
    return (format.empty() ? recognised(folder) : named(format)).open(folder);
}

fs::path lighting_of(const fs::path& sequence) {
    if (is_recording(sequence)) {
        const RecordingFile recording(sequence);
        const bool any =
            recording.has(SequenceRole::kLighting) && *recording.sequence(SequenceRole::kLighting).info.frames > 0;
        return any ? lighting_in(sequence) : fs::path();
    }
    const fs::path inside = folder_of(sequence) / "lighting";
    return is_folder(inside) ? inside : fs::path();
}

fs::path main_of(const fs::path& lighting) {
    const fs::path folder = folder_of(lighting);
    if (folder.filename() != "lighting") return {};
    const fs::path beside = fs::absolute(folder).lexically_normal().parent_path();
    return is_recording(beside) || path_exists(beside / "sequence.json") ? beside : fs::path();
}

}  // namespace patina::sensor
