#include "sensor/open.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "sensor/readers/native.h"
#include "sensor/readers/seven_scenes.h"
#include "sensor/readers/tum.h"

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
};

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
    fs::path first;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        const bool earlier = first.empty() || entry.path() < first;
        if (entry.is_directory() && earlier && format_of(entry.path())) first = entry.path();
    }
    return first;
}

const Format& recognised(const fs::path& folder) {
    if (const Format* format = format_of(folder)) return *format;
    const std::string nothing = text(folder.string(), " is no sequence: it holds no ", enumerated(&Format::content));
    const fs::path inside = sequence_inside(folder);
    throw inside.empty() ? Error(nothing) : Error(nothing, ", but ", inside.string(), " does");
}

const Format& named(const std::string& name) {
    const auto found = std::find_if(kFormats.begin(), kFormats.end(), [&](const Format& f) { return f.name == name; });
    if (found == kFormats.end()) throw Error("format '", name, "' is not known, must be ", enumerated(&Format::name));
    return *found;
}

}  // namespace

std::unique_ptr<Source> open_sequence(const fs::path& path, const std::string& format) {
    if (!fs::exists(path)) throw Error(path.string(), " does not exist");
    const fs::path folder = path.filename() == "sequence.json" ? fs::absolute(path).parent_path() : path;
    if (!fs::is_directory(folder)) throw Error(path.string(), " is a file, but a sequence is a folder");
    return (format.empty() ? recognised(folder) : named(format)).open(folder);
}

}  // namespace patina::sensor
