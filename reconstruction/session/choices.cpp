#include "reconstruction/session/choices.h"

#include "scenes/files/scene_file.h"

namespace patina {

std::optional<std::string> synthetic_scene(const SessionOptions& options) {
    return scenes::scene_name(options.sequence);
}

std::string name_of(const LightingChoice& lighting) {
    if (std::holds_alternative<NoLights>(lighting)) return "none";
    if (std::holds_alternative<LightsFromMain>(lighting)) return "self";
    if (const auto* named = std::get_if<LightsFromSequence>(&lighting)) return named->sequence;
    return "";
}

std::string name_of(Labels labels) {
    switch (labels) {
        case Labels::kOff: return "off";
        case Labels::kTruth: return "truth";
        case Labels::kGeometry: break;
    }
    return "geometry";
}

std::string name_of(Poses poses) {
    switch (poses) {
        case Poses::kGiven: return "given";
        case Poses::kTrack: return "track";
        case Poses::kPrior: return "prior";
        case Poses::kAuto: break;
    }
    return "auto";
}

std::string name_of(Materials materials) {
    switch (materials) {
        case Materials::kFit: return "fit";
        case Materials::kNetwork: return "hemicnn";
        case Materials::kBoth: return "both";
        case Materials::kOff: return "off";
        case Materials::kTruth: return "truth";
        case Materials::kAuto: break;
    }
    return "";
}

std::string name_of(Detail detail) {
    switch (detail) {
        case Detail::kFine: return "fine";
        case Detail::kNormal: return "normal";
        case Detail::kCoarse: return "coarse";
        case Detail::kAuto: break;
    }
    return "auto";
}

bool uses_given_poses(const SessionOptions& options) { return options.poses != Poses::kTrack; }

std::string hinted(const std::string& sentence, const std::string& hint) {
    return hint.empty() ? sentence : sentence + " (" + hint + ")";
}

std::string give_lights(const SessionOptions& options) {
    return hinted(
        "give lights or a lighting sequence (recorded at low exposure), or have lights looked for in the recording",
        options.hints.lights);
}

void report(const SessionCallbacks& callbacks, const SessionProgress& progress) {
    if (callbacks.progress) callbacks.progress(progress);
}

void report(const SessionCallbacks& callbacks, const std::string& message) {
    if (callbacks.message) callbacks.message(message);
}

bool stop_requested(const SessionCallbacks& callbacks) { return callbacks.stop && callbacks.stop(); }

}  // namespace patina
