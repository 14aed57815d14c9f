#include "export/rewrite_glb.h"

#include <algorithm>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/error.h"
#include "export/fewer_triangles.h"
#include "export/glb_file.h"
#include "export/glb_model.h"
#include "export/gltf_arrays.h"
#include "export/mesh_parts.h"
#include "export/page_picture.h"
#include "export/surface_survey.h"
#include "export/upright.h"

namespace patina {

namespace {

uint64_t triangles_in(const tinygltf::Model& model) {
    uint64_t indices = 0;
    for (const tinygltf::Mesh& mesh : model.meshes) {
        for (const tinygltf::Primitive& primitive : mesh.primitives) {
            const auto number = static_cast<size_t>(primitive.indices);
            if (primitive.indices >= 0 && number < model.accessors.size()) indices += model.accessors[number].count;
        }
    }
    return indices / 3;
}

constexpr uint32_t kLeastPage = 32;  // texels along a side

/// A GLB that is read, and written with changes.
class Rewriter {
  public:
    Rewriter(const std::filesystem::path& from, const std::filesystem::path& to, const GlbChanges& changes)
        : from_(from), changes_(changes), old_(read_glb(from)), model_(old_), file_(to) {
        if (changes.without_texture) {
            for (size_t i = 0; i < base_color_pages(old_); ++i)
                pages_.push_back(linear_page({old_.images[i].mimeType, old_.images[i].image}));
        }
        if (changes.triangles) share_ = share_of(*changes.triangles);
    }

    void write() {
        model_.accessors.clear();
        model_.bufferViews.clear();
        const std::vector<MeshPart> parts = collapsed();
        auto part = parts.begin();
        for (tinygltf::Mesh& mesh : model_.meshes)
            for (tinygltf::Primitive& primitive : mesh.primitives) write(*part++, primitive);
        write_pictures();
        if (changes_.up) turn(*changes_.up);
        file_.finish(model_);
    }

  private:
    double share_of(uint64_t triangles) const {
        const uint64_t there = triangles_in(old_);
        if (triangles > there)
            throw Error(from_, " has ", there, " triangles, fewer than the ", triangles,
                        " that are asked for: more need the map of the run");
        return static_cast<double>(triangles) / static_cast<double>(std::max<uint64_t>(there, 1));
    }

    /// The surface of all primitives, with as many triangles as are asked for.
    std::vector<MeshPart> collapsed() const {
        std::vector<PartSurface> surfaces;
        for (const tinygltf::Mesh& mesh : old_.meshes) {
            for (const tinygltf::Primitive& primitive : mesh.primitives) {
                PartSurface& surface = surfaces.emplace_back();
                surface.positions_m = in_.vectors(attribute_of(primitive, "POSITION"));
                surface.triangles = in_.triangles(primitive, surface.positions_m.size());
                if (surface.triangles.empty()) throw Error(from_, ": a primitive has no triangles");
            }
        }
        std::vector<MeshPart> parts;
        const auto kept = collapse(surfaces, share_);
        for (size_t i = 0; i < surfaces.size(); ++i) parts.push_back({0, kept[i], std::move(surfaces[i].triangles)});
        return parts;
    }

    void write(const MeshPart& kept, tinygltf::Primitive& primitive) {
        const tinygltf::Primitive old = primitive;
        primitive.attributes.clear();
        const std::vector<glm::vec3> positions_m = gathered(in_.vectors(attribute_of(old, "POSITION")), kept);
        primitive.attributes["POSITION"] = arrays_.add_positions(positions_m);
        survey(positions_m, kept);
        for (const auto& [name, accessor] : old.attributes) write(name, accessor, kept, primitive);
        if (changes_.without_texture) paint(old, kept, primitive);
        primitive.indices = arrays_.add_indices(kept.triangles, kept.vertices.size());
    }

    void write(const std::string& name, int accessor, const MeshPart& kept, tinygltf::Primitive& primitive) {
        const bool of_texture = name == "TEXCOORD_0" || name == "TANGENT";
        if (name == "POSITION" || (of_texture && changes_.without_texture)) return;
        const int type = in_.at(old_.accessors, accessor, "accessor").type;
        int& written = primitive.attributes[name];
        if (name == "COLOR_0") {
            written = add_colors(gathered(in_.colors(accessor), kept));
        } else if (type == TINYGLTF_TYPE_VEC2) {
            written = arrays_.add_vertices(name.c_str(), gathered(in_.pairs(accessor), kept));
        } else if (type == TINYGLTF_TYPE_VEC4) {
            written = arrays_.add_vertices(name.c_str(), gathered(in_.quads(accessor), kept));
        } else if (type == TINYGLTF_TYPE_SCALAR) {
            written = arrays_.add_vertices(name.c_str(), gathered(in_.scalars(accessor), kept));
        } else {
            written = arrays_.add_vertices(name.c_str(), gathered(in_.vectors(accessor), kept));
        }
    }

    int add_colors(const std::vector<glm::vec3>& linear) {
        std::vector<GltfColor> colors;
        for (const glm::vec3 color : linear) {
            const glm::vec3 code = glm::round(glm::clamp(color, 0.0f, 1.0f) * 65535.0f);
            colors.push_back(
                {static_cast<uint16_t>(code.r), static_cast<uint16_t>(code.g), static_cast<uint16_t>(code.b), 65535});
        }
        return arrays_.add_vertices("COLOR_0", colors);
    }

    /// What the texture shows, at the vertices.
    void paint(const tinygltf::Primitive& old, const MeshPart& kept, tinygltf::Primitive& primitive) {
        const tinygltf::Material& material = in_.at(old_.materials, old.material, "material");
        const int texture = material.pbrMetallicRoughness.baseColorTexture.index;
        if (texture < 0) return;
        const Image<glm::vec3>& page = in_.at(pages_, in_.at(old_.textures, texture, "texture").source, "page");
        std::vector<glm::vec3> colors;
        for (const glm::vec2 place : gathered(in_.pairs(attribute_of(old, "TEXCOORD_0")), kept))
            colors.push_back(texel_at(page, place));
        primitive.attributes["COLOR_0"] = add_colors(colors);
    }

    void write_pictures() {
        if (changes_.without_texture) {
            model_.images.clear();
            model_.textures.clear();
            model_.samplers.clear();
            for (tinygltf::Material& material : model_.materials) {
                material.pbrMetallicRoughness.baseColorTexture = tinygltf::TextureInfo();
                material.normalTexture = tinygltf::NormalTextureInfo();
            }
            return;
        }
        const std::set<size_t> pages = pages_of_surface();
        for (size_t i = 0; i < model_.images.size(); ++i) {
            tinygltf::Image& image = model_.images[i];
            if (pages.contains(i) && changes_.halvings > 0) shrink(image, changes_.halvings);
            image.bufferView = arrays_.add_bytes(image.name.c_str(), std::as_bytes(std::span(image.image)));
            image.image.clear();
        }
    }

    /// The pictures that materials show: base colours and detail.
    std::set<size_t> pages_of_surface() const {
        std::set<size_t> pages;
        for (const tinygltf::Material& material : model_.materials) {
            for (const int texture :
                 {material.pbrMetallicRoughness.baseColorTexture.index, material.normalTexture.index}) {
                if (texture < 0) continue;
                pages.insert(static_cast<size_t>(in_.at(old_.textures, texture, "texture").source));
            }
        }
        return pages;
    }

    /// Halves a page that often, but for small ones, and doubles `texel_m` of its extras each time.
    static void shrink(tinygltf::Image& image, uint32_t halvings) {
        Image<SrgbPixel> page = decoded({image.mimeType, image.image});
        uint32_t scale = 1;
        while (scale < 1u << halvings && std::min(page.extent().width, page.extent().height) >= 2 * kLeastPage) {
            page = halved(page);
            scale *= 2;
        }
        if (scale == 1) return;
        const bool is_png = image.mimeType == "image/png";
        EncodedPicture coarse = is_png ? encoded_as_png(page) : encoded(page);
        image.image = std::move(coarse.bytes);
        image.mimeType = coarse.mime_type;
        if (!image.extras.IsObject() || !image.extras.Has("texel_m")) return;
        auto extras = image.extras.Get<tinygltf::Value::Object>();
        extras["texel_m"] = tinygltf::Value(scale * extras["texel_m"].GetNumberAsDouble());
        image.extras = tinygltf::Value(std::move(extras));
    }

    void survey(const std::vector<glm::vec3>& positions_m, const MeshPart& part) {
        if (!changes_.up) return;
        Mesh mesh;
        mesh.positions_m = positions_m;
        mesh.triangles = part.triangles;
        survey_.add(mesh, {});
    }

    /// The root's transform, of positions in the recording's world.
    void turn(glm::dvec3 up) {
        const Upright upright = find_upright({up, {}, {}}, survey_.patches());
        const int number = in_.at(old_.scenes, old_.defaultScene, "scene").nodes.at(0);
        in_.at(old_.nodes, number, "node");
        tinygltf::Node& root = model_.nodes[static_cast<size_t>(number)];
        const glm::dquat turn = glm::normalize(upright.y_up_from_world);
        root.rotation = {turn.x, turn.y, turn.z, turn.w};
        root.translation = {0, -upright.floor_m, 0};
    }

    const std::filesystem::path& from_;
    const GlbChanges& changes_;
    tinygltf::Model old_, model_;
    GlbArrays in_{from_, old_};
    GlbFile file_;
    GltfArrays arrays_{model_, file_};
    std::vector<Image<glm::vec3>> pages_;
    SurfaceSurvey survey_;
    double share_ = 1;
};

}  // namespace

uint64_t triangles_in(const std::filesystem::path& glb) { return triangles_in(read_glb(glb)); }

void rewrite_glb(const std::filesystem::path& from, const std::filesystem::path& to, const GlbChanges& changes) {
    Rewriter(from, to, changes).write();
}

}  // namespace patina
