#include "reconstruction/session/session_state.h"

#include <span>

#include "engine/core/digest.h"
#include "engine/core/error.h"
#include "engine/core/version.h"
#include "reconstruction/session/choices.h"
#include "reconstruction/session/session_materials.h"
#include "reconstruction/setting_table.h"
#include "sensor/camera_json.h"

namespace patina {

namespace {

std::string digest_of(const NetworkDescription& network) {
    Digest digest;
    const auto add = [&](const std::vector<float>& values) {
        const auto bytes = std::as_bytes(std::span(values));
        digest.add({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    };
    for (const NetworkLayer& layer : network.layers) {
        add(layer.weight);
        add(layer.bias);
    }
    return digest.digits();
}

}  // namespace

nlohmann::ordered_json identity_of(const SessionOptions& options, const SequenceInfo& info,
                                   const ReconstructionSettings& settings) {
    nlohmann::ordered_json json{{"patina", kVersion}, {"sequence", info.name}, {"format", info.format}};
    // A recording may be cut short; a scene's path is as long as its frames.
    if (synthetic_scene(options)) json["frames"] = info.frames.value_or(0);
    json["color"] = sensor::camera_json(info.color);
    json["depth"] = sensor::camera_json(info.depth);
    json["labels"] = name_of(options.labels);
    json["specular"] = specular_mode(settings);
    json["truth_materials"] = options.materials == Materials::kTruth;
    json["poses"] = settings.tracking ? (options.poses == Poses::kPrior ? "prior" : "track") : "given";
    json["hold_out"] = options.hold_out;
    json["network"] = settings.network ? digest_of(*settings.network) : "none";
    json["settings"] = settings_json(settings);
    return json;
}

nlohmann::ordered_json model_of(const nlohmann::ordered_json& identity) {
    nlohmann::ordered_json model = identity;
    for (const char* of_sequence : {"sequence", "format", "frames", "color", "depth", "poses", "hold_out"})
        model.erase(of_sequence);
    return model;
}

void expect_same(const std::filesystem::path& map, const nlohmann::ordered_json& kept,
                 const nlohmann::ordered_json& now) {
    const auto was = kept.flatten(), is = now.flatten();
    const auto value_in = [](const nlohmann::ordered_json& flat, const std::string& key) {
        return flat.contains(key) ? flat.at(key).dump() : std::string("none");
    };
    const auto compare = [&](const nlohmann::ordered_json& keys) {
        for (const auto& [key, value] : keys.items()) {
            const std::string before = value_in(was, key), after = value_in(is, key);
            if (before == after) continue;
            std::string name = key.substr(1);
            for (char& c : name) c = c == '/' ? '.' : c;
            throw Error("'", map.string(), "' was written with ", name, " = ", before, ", now it is ", after);
        }
    };
    compare(was);
    compare(is);
}

nlohmann::ordered_json detail_json(const DetailChoice& detail) {
    return {{"level", name_of(detail.level)}, {"because", detail.because}};
}

DetailChoice detail_in(MapFile& map) {
    const nlohmann::ordered_json kept = map.expect_json("detail");
    const auto word = [&](const char* key) {
        const auto found = kept.is_object() ? kept.find(key) : kept.end();
        return found != kept.end() && found->is_string() ? found->get<std::string>() : std::string();
    };
    for (const Detail level : {Detail::kFine, Detail::kNormal, Detail::kCoarse})
        if (name_of(level) == word("level")) return {level, word("because")};
    throw Error("'", map.file().string(), "' has the level of detail '", word("level"),
                "', it must be fine, normal or coarse");
}

void visit(graph::StateVisitor& visitor, SessionLight& light) {
    Illumination& found = light.illumination;
    visitor.text("light.found_by", found.found_by);
    visitor.values("light.lamps", found.lights);
    visitor.values("light.candidates_m", found.candidates_m);
    visitor.value("light.world_offset_m", found.world_offset_m);
    visitor.value("light.ambient", found.ambient);
    visitor.value("light.assumed", found.assumed);
    visitor.value("light.given", found.given);
    visitor.value("light.misfit", found.misfit);
    visitor.value("light.unexplained", found.unexplained);
    visitor.text("light.none_because", light.none_because);
    visitor.texts("light.shortfalls", light.shortfalls);
}

void visit(graph::StateVisitor& visitor, std::vector<TrackedFrame>& tracked) {
    std::vector<uint32_t> indices;
    std::vector<TrackingFigures> figures;
    std::vector<std::string> reasons;
    for (const TrackedFrame& frame : tracked) {
        indices.push_back(frame.index);
        figures.push_back(frame.report);
        reasons.push_back(frame.report.reason);
    }
    visitor.values("session.tracked", indices);
    visitor.values("session.tracking_figures", figures);
    visitor.texts("session.tracking_reasons", reasons);
    tracked.clear();
    for (size_t i = 0; i < indices.size(); ++i) tracked.push_back({indices[i], {figures.at(i), reasons.at(i)}});
}

void visit(graph::StateVisitor& visitor, sensor::Ledger& ledger, const FrameIndices& frames) {
    uint32_t read = ledger.read();
    std::vector<uint32_t> indices;
    std::vector<std::string> reasons;
    for (const Skipped& skipped : ledger.skipped()) {
        indices.push_back(skipped.index);
        reasons.push_back(skipped.reason);
    }
    visitor.value("session.read", read);
    visitor.values("session.used", frames.fused);
    visitor.values("session.held_out", frames.held_out);
    visitor.values("session.repeated", frames.repeated);
    visitor.values("session.undone", frames.undone);
    visitor.values("session.skipped", indices);
    visitor.texts("session.skipped_because", reasons);
    ledger = {};
    for (uint32_t index = 0; index < read; ++index) {
        Frame frame;
        frame.index = index;
        ledger.note(frame);
    }
    for (const std::vector<uint32_t>* used : {&frames.fused, &frames.held_out, &frames.undone})
        for (const uint32_t index : *used) ledger.use(index);
    for (const uint32_t index : frames.repeated) ledger.repeat(index);
    ledger.undo(static_cast<uint32_t>(frames.undone.size()));
    for (size_t i = 0; i < indices.size(); ++i) ledger.skip(indices[i], reasons.at(i));
}

}  // namespace patina
