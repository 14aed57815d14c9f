#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/graph/state_visitor.h"
#include "patina/source.h"
#include "reconstruction/reconstruction_settings.h"
#include "reconstruction/session/detail.h"
#include "reconstruction/session/session_lights.h"
#include "reconstruction/session/tracked_frame.h"
#include "reconstruction/store/map_file.h"
#include "sensor/ledger.h"

namespace patina {

/// What two sessions must have in common for one to go on where the other was: sequence, choices, settings, network.
nlohmann::ordered_json identity_of(const SessionOptions& options, const SequenceInfo& info,
                                   const ReconstructionSettings& settings);

/// Of identity_of(), what must be the same for a session of another sequence to extend a map.
nlohmann::ordered_json model_of(const nlohmann::ordered_json& identity);

/// Throws Error, naming the map and both values, where a session is not the one that a map is of.
void expect_same(const std::filesystem::path& map, const nlohmann::ordered_json& kept,
                 const nlohmann::ordered_json& now);

/// What was taken from all positions of the session in a map.
glm::dvec3 world_offset_in(vulkan::Device& device, MapFile& map);

nlohmann::ordered_json detail_json(const DetailChoice& detail);

/// The level that the map was made with. Throws Error for one that there is not.
DetailChoice detail_in(MapFile& map);

SessionLight light_in(vulkan::Device& device, MapFile& map);

/// Parts of a session's state on the host, to be kept or brought back.
void visit(graph::StateVisitor& visitor, SessionLight& light);
void visit(graph::StateVisitor& visitor, std::vector<TrackedFrame>& tracked);
/// Indices of frames, by what became of them.
struct FrameIndices {
    std::vector<uint32_t>& fused;
    std::vector<uint32_t>& held_out;
    std::vector<uint32_t>& repeated;  ///< those that repeat the one before
    std::vector<uint32_t>& undone;    ///< were fused or held out, and forgotten again
};
/// Brought back, the ledger is made anew of them.
void visit(graph::StateVisitor& visitor, sensor::Ledger& ledger, const FrameIndices& frames);

}  // namespace patina
