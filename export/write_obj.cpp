#include "export/write_obj.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include <fmt/format.h>

namespace patina {

namespace {

constexpr double kMostShininess = 1e4;

std::string page_name(const std::string& stem, const SceneParts& scene, uint32_t page) {
    return fmt::format("{}-{}{}", stem, page + 1, extension_of(scene.pages[page]));
}

/// Names in an OBJ end at a space.
std::string word_of(std::string name) {
    std::ranges::replace_if(
        name, [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }, '_');
    return name;
}

std::string material_name(const SceneParts& scene, const ScenePart& part) {
    const PartMaterial& material = scene.materials[part.material];
    const std::string name = word_of(material.name.empty() ? "material" : material.name);
    const std::string unique = fmt::format("{}.{}", name, part.material);
    return part.page == ScenePart::kNoPage ? unique : fmt::format("{}.page{}", unique, part.page + 1);
}

std::string material_text(const std::string& stem, const SceneParts& scene, const ScenePart& part) {
    const GltfMaterial& gltf = scene.materials[part.material].gltf;
    const glm::vec3 specular = f0_of(gltf);
    // Of a part without a page the vertices have the colour.
    const glm::vec3 base = gltf.metal ? gltf.base_color : glm::vec3(1);
    const double alpha = double{gltf.roughness} * double{gltf.roughness};
    std::string text =
        fmt::format("newmtl {}\nKd {:.5f} {:.5f} {:.5f}\nKs {:.5f} {:.5f} {:.5f}\nNs {:.3f}\nNi {:.4f}\n",
                    material_name(scene, part), base.r, base.g, base.b, specular.r, specular.g, specular.b,
                    std::clamp(2 / (alpha * alpha) - 2, 0.0, kMostShininess), gltf.ior);
    text += fmt::format("Pr {:.4f}\nPm {}\nillum 2\n", gltf.roughness, gltf.metal ? 1 : 0);
    if (part.page != ScenePart::kNoPage) text += fmt::format("map_Kd {}\n", page_name(stem, scene, part.page));
    return text + "\n";
}

std::string materials_text(const std::string& stem, const SceneParts& scene) {
    std::set<std::pair<size_t, uint32_t>> written;
    std::string text = "# Patina\n";
    for (const ScenePart& part : scene.parts) {
        if (written.emplace(part.material, part.page).second) text += material_text(stem, scene, part);
    }
    return text;
}

void append_vertices(std::string& text, const ScenePart& part) {
    const auto end = std::back_inserter(text);
    for (size_t i = 0; i < part.positions_m.size(); ++i) {
        const glm::vec3 p = part.positions_m[i];
        fmt::format_to(end, "v {:.6g} {:.6g} {:.6g}", p.x, p.y, p.z);
        if (!part.base.empty())
            fmt::format_to(end, " {:.5f} {:.5f} {:.5f}", part.base[i].r, part.base[i].g, part.base[i].b);
        text += '\n';
    }
    for (const glm::vec3 n : part.normals) fmt::format_to(end, "vn {:.5f} {:.5f} {:.5f}\n", n.x, n.y, n.z);
    for (const glm::vec2 place : part.places) fmt::format_to(end, "vt {:.7f} {:.7f}\n", place.x, 1 - place.y);
}

/// `first` and `first_place`: the numbers of the part's first vertex, and its first place in a page; OBJ counts from 1.
void append_faces(std::string& text, const ScenePart& part, uint64_t first, uint64_t first_place) {
    const auto end = std::back_inserter(text);
    for (const auto& triangle : part.triangles) {
        text += 'f';
        for (const uint32_t vertex : triangle) {
            if (part.places.empty()) {
                fmt::format_to(end, " {0}//{0}", first + vertex);
            } else {
                fmt::format_to(end, " {0}/{1}/{0}", first + vertex, first_place + vertex);
            }
        }
        text += '\n';
    }
}

std::string surface_text(const std::string& stem, const SceneParts& scene) {
    std::string text = fmt::format("# Patina: metres, y up\nmtllib {}.mtl\n", stem);
    uint64_t first = 1, first_place = 1;
    for (const ScenePart& part : scene.parts) {
        text +=
            fmt::format("g {}\nusemtl {}\n", word_of(scene.materials[part.material].name), material_name(scene, part));
        append_vertices(text, part);
        append_faces(text, part, first, first_place);
        first += part.positions_m.size();
        first_place += part.places.size();
    }
    return text;
}

}  // namespace

void write_obj(const std::string& stem, const SceneParts& scene, const PutFile& put) {
    for (uint32_t page = 0; page < scene.pages.size(); ++page) {
        const std::vector<unsigned char>& bytes = scene.pages[page].bytes;
        put(page_name(stem, scene, page), {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    }
    put(stem + ".mtl", materials_text(stem, scene));
    put(stem + ".obj", surface_text(stem, scene));
}

}  // namespace patina
