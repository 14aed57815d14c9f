#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "export/write_glb.h"
#include "patina/scene.h"

namespace patina {

/// Writes a scene as 3D Tiles 1.1 (OGC 22-025r4): tileset.json, and below it a tile for each cell of the surface, in
/// levels of detail as LEVEL/NNNNNN.glb, level 0 the finest. Each is a GLB as GlbWriter's, without lamps. Coarser
/// levels have some eighth of the triangles of the level before; cells meet without gaps at all levels.
class TileWriter {
  public:
    static constexpr uint32_t kLevels = 3;

    /// `write`: calls its second argument with where to write the file of a name, and sees to it that the file is kept.
    using Write =
        std::function<void(const std::string& name, const std::function<void(const std::filesystem::path&)>&)>;
    TileWriter(Write write, GlbInfo info, const GlbOptions& options = {});

    /// Adds a cell with what its vertices reflect; without triangles nothing. Throws Error as GlbWriter.
    void add(const Mesh& mesh, const MeshReflectance& reflectance);

    /// Writes tileset.json; nothing may follow. Returns what became of the finest level. Throws Error where the disk
    /// refuses.
    GlbSummary finish();

  private:
    struct Level {
        std::string name;
        double error_m = 0;
    };
    void add(const GlbSummary& tile);
    void add_tile(const Mesh& mesh, const std::array<Level, kLevels>& levels);

    Write write_;
    GlbInfo info_;
    GlbOptions options_;
    GlbSummary summary_;
    uint32_t cells_ = 0;
    glm::dvec3 low_{1e9}, high_{-1e9};  ///< of all tiles, z up
    nlohmann::ordered_json tiles_ = nlohmann::ordered_json::array();
};

}  // namespace patina
