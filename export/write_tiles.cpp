#include "export/write_tiles.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "export/coarser_mesh.h"
#include "sensor/files/text_file.h"

namespace patina {

namespace {

constexpr double kPartOfLevel = 1.0 / 8;

struct TileBox {
    glm::dvec3 low{1e9}, high{-1e9};

    void add(glm::dvec3 point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
};

/// In the tileset's coordinates, in which z is up: viewers turn the y of a glTF there.
TileBox box_of(const Mesh& mesh, const Upright& upright) {
    TileBox box;
    const RigidTransform gltf_from_world = upright.gltf_from_world();
    for (const glm::vec3& position : mesh.positions_m) {
        const glm::dvec3 y_up(gltf_from_world * glm::dvec4(position, 1));
        box.add({y_up.x, -y_up.z, y_up.y});
    }
    return box;
}

/// A box by its centre and half its edges.
nlohmann::ordered_json volume_of(const TileBox& box) {
    const glm::dvec3 center = (box.low + box.high) / 2.0, half = (box.high - box.low) / 2.0;
    return {{"box", {center.x, center.y, center.z, half.x, 0, 0, 0, half.y, 0, 0, 0, half.z}}};
}

MeshReflectance of_vertices(const MeshReflectance& reflectance, const std::vector<uint32_t>& vertices) {
    MeshReflectance some;
    some.segments = reflectance.segments;
    if (reflectance.kd.empty()) return some;
    for (const uint32_t vertex : vertices) {
        some.kd.push_back(reflectance.kd[vertex]);
        some.labels.push_back(reflectance.labels[vertex]);
    }
    return some;
}

}  // namespace

TileWriter::TileWriter(Write write, GlbInfo info, const GlbOptions& options)
    : write_(std::move(write)), info_(std::move(info)), options_(options) {
    info_.lights.clear();
    info_.environment.reset();
}

void TileWriter::add(const Mesh& mesh, const MeshReflectance& reflectance) {
    if (mesh.triangles.empty()) return;
    std::array<Level, kLevels> levels;
    CoarserMesh coarse;
    const std::vector<float> shades = shades_of(mesh, reflectance);
    for (uint32_t level = 0; level < kLevels; ++level) {
        if (level > 0) coarse = coarser(mesh, shades, {.part = std::pow(kPartOfLevel, level)});
        levels[level] = {fmt::format("{}/{:06}.glb", level, cells_),
                         level > 0 ? std::max(coarse.error_m, levels[level - 1].error_m) : 0};
        write_(levels[level].name, [&](const std::filesystem::path& path) {
            GlbWriter writer(path, options_);
            if (level == 0) {
                writer.add(mesh, &reflectance);
            } else {
                const MeshReflectance some = of_vertices(reflectance, coarse.vertices);
                writer.add(coarse.mesh, &some);
            }
            const GlbSummary written = writer.finish(info_);
            if (level == 0) add(written);
        });
    }
    add_tile(mesh, levels);
    ++cells_;
}

/// The coarsest level, with each finer one below the one before.
void TileWriter::add_tile(const Mesh& mesh, const std::array<Level, kLevels>& levels) {
    const TileBox box = box_of(mesh, info_.upright);
    low_ = glm::min(low_, box.low);
    high_ = glm::max(high_, box.high);
    nlohmann::ordered_json tile;
    for (const Level& level : levels) {
        nlohmann::ordered_json above{{"boundingVolume", volume_of(box)}, {"geometricError", level.error_m}};
        above["content"] = {{"uri", level.name}};
        if (!tile.is_null()) above["children"] = nlohmann::ordered_json::array({std::move(tile)});
        tile = std::move(above);
    }
    tiles_.push_back(std::move(tile));
}

void TileWriter::add(const GlbSummary& tile) {
    summary_.vertices += tile.vertices;
    summary_.triangles += tile.triangles;
    summary_.degenerate_triangles += tile.degenerate_triangles;
    summary_.clamped_colors += tile.clamped_colors;
    summary_.unknown_albedo += tile.unknown_albedo;
}

GlbSummary TileWriter::finish() {
    const TileBox box = cells_ > 0 ? TileBox{low_, high_} : TileBox{glm::dvec3(0), glm::dvec3(0)};
    // Of a scene that is not drawn at all, all is missing.
    const double all_m = glm::distance(box.low, box.high);
    nlohmann::ordered_json root{{"boundingVolume", volume_of(box)}, {"geometricError", all_m}, {"refine", "REPLACE"}};
    if (cells_ > 0) root["children"] = tiles_;
    const nlohmann::ordered_json set{{"asset", {{"version", "1.1"}, {"generator", "Patina " + info_.version}}},
                                     {"geometricError", all_m},
                                     {"root", std::move(root)}};
    write_("tileset.json", [&](const std::filesystem::path& path) { sensor::write_bytes(path, set.dump(2) + "\n"); });
    return summary_;
}

}  // namespace patina
