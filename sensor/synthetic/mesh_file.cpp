#include "sensor/synthetic/mesh_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <glm/gtc/matrix_inverse.hpp>

#include "engine/core/error.h"
#include "sensor/synthetic/mesh.h"

namespace patina::sensor {
namespace {

namespace fs = std::filesystem;

/// Our own joining is exact; Assimp's takes vertices for equal that are 1e-5 apart, whatever the file's unit.
constexpr unsigned kSteps = aiProcess_ValidateDataStructure | aiProcess_Triangulate | aiProcess_SortByPType;

glm::dmat4 to_glm(const aiMatrix4x4& m) {
    return glm::dmat4(m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2, m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4);
}

glm::dvec3 to_glm(const aiVector3D& v) { return {v.x, v.y, v.z}; }

glm::dvec3 face_normal(const std::array<glm::dvec3, 3>& p) {
    return glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
}

/// Gathers the triangles of all nodes; no two share a vertex.
class Gathering {
  public:
    explicit Gathering(const aiScene& scene) : scene_(scene) {
        for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
            has_normals_ |= scene.mMeshes[i]->HasNormals();
            has_texture_coordinates_ |= scene.mMeshes[i]->HasTextureCoords(0);
        }
    }

    TriangleMesh gather() && {
        add(*scene_.mRootNode, glm::dmat4(1));
        return std::move(mesh_);
    }

  private:
    void add(const aiNode& node, const glm::dmat4& world_from_parent) {
        const glm::dmat4 world_from_node = world_from_parent * to_glm(node.mTransformation);
        for (unsigned i = 0; i < node.mNumMeshes; ++i) add(*scene_.mMeshes[node.mMeshes[i]], world_from_node);
        for (unsigned i = 0; i < node.mNumChildren; ++i) add(*node.mChildren[i], world_from_node);
    }

    void add(const aiMesh& mesh, const glm::dmat4& world_from_node) {
        const bool mirrored = glm::determinant(glm::dmat3(world_from_node)) < 0;
        for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
            const aiFace& face = mesh.mFaces[i];
            if (face.mNumIndices != 3) continue;
            std::array<unsigned, 3> indices{face.mIndices[0], face.mIndices[1], face.mIndices[2]};
            if (mirrored) std::swap(indices[1], indices[2]);
            add_triangle(mesh, indices, world_from_node);
        }
    }

    void add_triangle(const aiMesh& mesh, const std::array<unsigned, 3>& indices, const glm::dmat4& world_from_node) {
        const auto first = static_cast<uint32_t>(mesh_.positions_m.size());
        mesh_.triangles.emplace_back(first, first + 1, first + 2);
        std::array<glm::dvec3, 3> corners;
        for (size_t i = 0; i < 3; ++i) {
            corners[i] = glm::dvec3(world_from_node * glm::dvec4(to_glm(mesh.mVertices[indices[i]]), 1));
            mesh_.positions_m.emplace_back(corners[i]);
        }
        const glm::dmat3 normals_from_node = glm::inverseTranspose(glm::dmat3(world_from_node));
        for (const unsigned index : indices) {
            if (has_normals_) add_normal(mesh, index, normals_from_node, corners);
            if (has_texture_coordinates_) add_texture_coordinates(mesh, index);
        }
    }

    /// A vertex whose normal is missing or has no length gets its triangle's.
    void add_normal(const aiMesh& mesh, unsigned index, const glm::dmat3& normals_from_node,
                    const std::array<glm::dvec3, 3>& corners) {
        const glm::dvec3 normal = mesh.HasNormals() ? normals_from_node * to_glm(mesh.mNormals[index]) : glm::dvec3(0);
        const double length = glm::length(normal);
        const bool usable = std::isfinite(length) && length > 1e-12;
        mesh_.normals.emplace_back(usable ? normal / length : face_normal(corners));
    }

    /// Assimp's v points up from the picture's bottom.
    void add_texture_coordinates(const aiMesh& mesh, unsigned index) {
        const bool present = mesh.HasTextureCoords(0);
        const glm::dvec3 uv = present ? to_glm(mesh.mTextureCoords[0][index]) : glm::dvec3(0, 1, 0);
        mesh_.texture_coordinates.emplace_back(uv.x, 1 - uv.y);
    }

    const aiScene& scene_;
    TriangleMesh mesh_;
    bool has_normals_ = false;
    bool has_texture_coordinates_ = false;
};

void check_kind(const fs::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    constexpr std::array kKnown{".obj", ".ply", ".glb", ".gltf"};
    if (std::find(kKnown.begin(), kKnown.end(), extension) == kKnown.end())
        throw Error("its name ends in '", extension, "', which is none of .obj, .ply, .glb, .gltf");
}

TriangleMesh read_triangles(const fs::path& file) {
    check_kind(file);
    if (!fs::is_regular_file(file)) throw Error("there is no such file");
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(file.string(), kSteps);
    if (!scene || !scene->mRootNode) throw Error("it cannot be read: ", importer.GetErrorString());
    return Gathering(*scene).gather();
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
} catch (const Error& error) {
    throw Error(file.string(), ": ", error.what());
}

}  // namespace patina::sensor
