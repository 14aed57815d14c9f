#include "scenes/files/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "scenes/description/mesh.h"
#include "scenes/files/mesh_readers/gltf.h"
#include "scenes/files/mesh_readers/obj.h"
#include "scenes/files/mesh_readers/ply.h"

namespace patina::scenes {
namespace {

namespace fs = std::filesystem;

TriangleMesh read_triangles(const fs::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    if (extension != ".obj" && extension != ".ply" && extension != ".glb" && extension != ".gltf")
        throw Error("its name ends in '", extension, "', which is none of .obj, .ply, .glb, .gltf");
    const std::vector<uint8_t> bytes = read_file(file, limits::kMeshBytes);
    if (extension == ".obj") return read_obj(bytes);
    if (extension == ".ply") return read_ply(bytes);
    return read_gltf(file, bytes);
}

/// Rotations that turn the file's up to -y.
glm::dmat3 world_from_file(MeshUp up) {
    switch (up) {
        case MeshUp::kY: return {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
        case MeshUp::kZ: return {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
        case MeshUp::kMinusY: break;
    }
    return glm::dmat3(1);
}

}  // namespace

TriangleMesh read_mesh(const fs::path& file, const MeshSettings& settings) try {
    TriangleMesh mesh = read_triangles(file);
    if (settings.normals != MeshNormals::kFile) mesh.normals.clear();
    mesh = transformed(joined(mesh), world_from_file(settings.up), settings.height_m ? 1 : settings.scale);
    if (settings.height_m && !mesh.triangles.empty()) mesh = standing(std::move(mesh), *settings.height_m);
    check_triangles(mesh);
    return settings.normals == MeshNormals::kSmooth ? with_smooth_normals(std::move(mesh)) : mesh;
} catch (const std::exception& error) {  // a library's too
    const std::string message = reason_of(error);
    throw Error(message.starts_with(file.string()) ? "" : file.string() + ": ", message);
}

}  // namespace patina::scenes
