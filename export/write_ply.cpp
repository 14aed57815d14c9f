#include "export/write_ply.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "engine/core/error.h"
#include "engine/core/srgb.h"
#include "sensor/output/new_file.h"

namespace patina {

namespace {

/// Little-endian, whatever the machine is.
void put(std::string& bytes, uint32_t word) {
    for (uint32_t i = 0; i < 4; ++i) bytes += static_cast<char>(word >> 8 * i & 0xff);
}

void put(std::string& bytes, float value) { put(bytes, std::bit_cast<uint32_t>(value)); }

void put(std::string& bytes, glm::vec3 vector) {
    for (glm::length_t i = 0; i < 3; ++i) put(bytes, vector[i]);
}

void put_srgb(std::string& bytes, glm::vec3 linear) {
    for (glm::length_t i = 0; i < 3; ++i) {
        const double code = srgb_encoded(double{std::clamp(linear[i], 0.0f, 1.0f)});
        bytes += static_cast<char>(std::lround(255 * code));
    }
}

std::string header_of(const SceneParts& scene, PlyContent content, bool reflectance) {
    std::string header = fmt::format("ply\nformat binary_little_endian 1.0\ncomment metres, y up\nelement vertex {}\n",
                                     scene.vertices());
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) header += fmt::format("property float {}\n", name);
    for (const char* name : {"red", "green", "blue"}) header += fmt::format("property uchar {}\n", name);
    header += "property uint label\n";
    if (reflectance) {
        for (const char* name : {"kd_red", "kd_green", "kd_blue", "ks_red", "ks_green", "ks_blue", "alpha"})
            header += fmt::format("property float {}\n", name);
    }
    if (content == PlyContent::kMesh)
        header += fmt::format("element face {}\nproperty list uchar uint vertex_indices\n", scene.triangles());
    return header + "end_header\n";
}

std::string vertices_of(const ScenePart& part, const std::vector<glm::vec3>& base, const PartMaterial& material,
                        bool reflectance) {
    const float unknown = std::numeric_limits<float>::quiet_NaN();
    const bool observed = material.observed && material.gloss;
    std::string bytes;
    for (size_t i = 0; i < part.positions_m.size(); ++i) {
        put(bytes, part.positions_m[i]);
        put(bytes, part.normals[i]);
        const glm::vec3 kd = material.kd_over_base() * base[i];
        put_srgb(bytes, kd);
        put(bytes, material.label);
        if (!reflectance) continue;
        put(bytes, kd);
        put(bytes, observed ? material.gloss->ks : glm::vec3(unknown));
        put(bytes, observed ? material.gloss->alpha : unknown);
    }
    return bytes;
}

}  // namespace

void write_ply(const std::filesystem::path& path, const SceneParts& scene, PlyContent content) {
    if (scene.vertices() > UINT32_MAX)
        throw Error(path, ": a PLY file counts vertices with 32 bits, but the scene has ", scene.vertices());
    const bool reflectance = std::ranges::any_of(scene.materials, &PartMaterial::has_reflectance);
    const std::vector<std::vector<glm::vec3>> base = base_colors(scene);
    sensor::NewFile file(path);
    file.write(header_of(scene, content, reflectance));
    for (size_t i = 0; i < scene.parts.size(); ++i) {
        const ScenePart& part = scene.parts[i];
        file.write(vertices_of(part, base[i], scene.materials[part.material], reflectance));
    }
    uint32_t first = 0;
    for (const ScenePart& part : scene.parts) {
        if (content == PlyContent::kPoints) break;
        std::string bytes;
        for (const auto& triangle : part.triangles) {
            bytes += '\3';
            for (const uint32_t vertex : triangle) put(bytes, first + vertex);
        }
        file.write(bytes);
        first += static_cast<uint32_t>(part.positions_m.size());
    }
    file.close();
}

}  // namespace patina
