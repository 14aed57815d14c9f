#include "tools/figure/write_ply.h"

#include <bit>
#include <sstream>
#include <string>

#include "engine/core/error.h"
#include "sensor/files/text_file.h"

namespace patina::figure {
namespace {

static_assert(std::endian::native == std::endian::little, "values are written as they lie in memory");

template <class T>
void append(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string header(size_t vertices, size_t triangles) {
    std::ostringstream text;
    text << "ply\nformat binary_little_endian 1.0\ncomment made by tools/figure\nelement vertex " << vertices;
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) text << "\nproperty float " << name;
    text << "\nelement face " << triangles << "\nproperty list uchar int vertex_indices\nend_header\n";
    return text.str();
}

}  // namespace

void write_ply(const std::filesystem::path& file, const scenes::TriangleMesh& mesh) {
    PATINA_ASSERT(mesh.normals.size() == mesh.positions_m.size(), "normals ", mesh.normals.size());
    std::string bytes = header(mesh.positions_m.size(), mesh.triangles.size());
    for (size_t i = 0; i < mesh.positions_m.size(); ++i) {
        append(bytes, mesh.positions_m[i]);
        append(bytes, mesh.normals[i]);
    }
    for (const glm::uvec3& triangle : mesh.triangles) {
        append(bytes, uint8_t{3});
        append(bytes, triangle);
    }
    sensor::write_bytes(file, bytes);
}

}  // namespace patina::figure
