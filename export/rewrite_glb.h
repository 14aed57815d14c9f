#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include <glm/glm.hpp>

namespace patina {

/// What is to be another way in a scene.glb.
struct GlbChanges {
    std::optional<uint64_t> triangles{};  ///< about so many; empty: as many as there are
    bool without_texture = false;         ///< vertices have the texture's colours in its place
    std::optional<glm::dvec3> up{};       ///< direction in the recording's world, of any length but 0; empty: as it is
    uint32_t halvings = 0;                ///< of the resolution of the texture's pages; they stay 32 wide

    bool any() const { return triangles || without_texture || halvings > 0 || up; }
};

/// Triangles of a scene.glb. Throws Error where it cannot be read.
uint64_t triangles_in(const std::filesystem::path& glb);

/// Writes a scene.glb anew with changes; all else stays. Edges are collapsed by collapse(), so that more triangles than
/// asked for may be left. Throws Error where the file cannot be read or written, or has fewer
/// triangles than are asked for.
void rewrite_glb(const std::filesystem::path& from, const std::filesystem::path& to, const GlbChanges& changes);

}  // namespace patina
