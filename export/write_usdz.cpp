#include "export/write_usdz.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include "export/stored_zip.h"

namespace patina {

namespace {

/// USD's names are of letters, digits and "_", and begin with no digit.
std::string identifier(std::string name) {
    if (name.empty() || (name.front() >= '0' && name.front() <= '9')) name.insert(0, "part ");
    std::ranges::replace_if(
        name, [](char c) { return !((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9')); },
        '_');
    return name;
}

std::string quoted(const std::string& text) {
    std::string escaped = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') escaped += '\\';
        escaped += static_cast<unsigned char>(c) < 32 ? ' ' : c;
    }
    return escaped + '"';
}

std::string tuple(glm::vec3 v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z); }
std::string tuple(glm::vec2 v) { return fmt::format("({:.7f}, {:.7f})", v.x, 1 - v.y); }  // t counts upwards

template <class Vector>
void append_list(std::string& text, std::span<const Vector> vectors) {
    text += '[';
    for (size_t i = 0; i < vectors.size(); ++i) text += (i > 0 ? ", " : "") + tuple(vectors[i]);
    text += ']';
}

std::string material_name(const ScenePart& part) {
    return part.page == ScenePart::kNoPage ? fmt::format("material_{}", part.material)
                                           : fmt::format("material_{}_page_{}", part.material, part.page + 1);
}

std::string custom_data(const PartMaterial& material) {
    std::string ward = fmt::format("   bool observed = {}\n", material.observed ? 1 : 0);
    if (material.gloss && material.observed)
        ward += fmt::format("   float3 ks = {}\n   float alpha = {:.6g}\n", tuple(material.gloss->ks),
                            material.gloss->alpha);
    return fmt::format(" (\n customData = {{\n  dictionary ward = {{\n{}  }}\n }}\n)", ward);
}

/// The shader that reads a part's colours.
std::string color_name(const ScenePart& part) {
    return part.page == ScenePart::kNoPage ? "color" : fmt::format("page_{}", part.page + 1);
}

std::string color_source(const ScenePart& part, const std::string& path, const std::vector<std::string>& pages) {
    if (part.page == ScenePart::kNoPage) {
        return " def Shader \"color\"\n {\n  uniform token info:id = \"UsdPrimvarReader_float3\"\n"
               "  string inputs:varname = \"displayColor\"\n  float3 outputs:result\n }\n";
    }
    return fmt::format(
        " def Shader \"place\"\n {{\n  uniform token info:id = \"UsdPrimvarReader_float2\"\n"
        "  string inputs:varname = \"st\"\n  float2 outputs:result\n }}\n"
        " def Shader \"{}\"\n {{\n  uniform token info:id = \"UsdUVTexture\"\n  asset inputs:file = @{}@\n"
        "  float2 inputs:st.connect = <{}/place.outputs:result>\n  token inputs:sourceColorSpace = \"sRGB\"\n"
        "  token inputs:wrapS = \"clamp\"\n  token inputs:wrapT = \"clamp\"\n  float3 outputs:rgb\n }}\n",
        color_name(part), pages[part.page], path);
}

std::string material_text(const SceneParts& scene, const ScenePart& part, const std::vector<std::string>& pages) {
    const PartMaterial& material = scene.materials[part.material];
    const GltfMaterial& gltf = material.gltf;
    const std::string path = fmt::format("/scene/materials/{}", material_name(part));
    // The metallic workflow has no colour of the gloss: the index has its strength.
    const float f0 = std::max({f0_of(gltf).r, f0_of(gltf).g, f0_of(gltf).b});
    const double ior = gltf.metal ? 1.5 : (1 + std::sqrt(double{f0})) / std::max(1 - std::sqrt(double{f0}), 1e-3);
    std::string text = fmt::format("def Material \"{}\"{}\n{{\n", material_name(part), custom_data(material));
    text += fmt::format(" token outputs:surface.connect = <{}/surface.outputs:surface>\n", path);
    text += fmt::format(
        " def Shader \"surface\"\n {{\n  uniform token info:id = \"UsdPreviewSurface\"\n"
        "  color3f inputs:diffuseColor.connect = <{}/{}.outputs:{}>\n  float inputs:roughness = {:.4f}\n"
        "  float inputs:metallic = {}\n  float inputs:ior = {:.4f}\n  token outputs:surface\n }}\n",
        path, color_name(part), part.page == ScenePart::kNoPage ? "result" : "rgb", gltf.roughness, gltf.metal ? 1 : 0,
        ior);
    return text + color_source(part, path, pages) + "}\n";
}

std::string materials_text(const SceneParts& scene, const std::vector<std::string>& pages) {
    std::set<std::string> written;
    std::string text = "def Scope \"materials\"\n{\n";
    for (const ScenePart& part : scene.parts) {
        if (written.insert(material_name(part)).second) text += material_text(scene, part, pages);
    }
    return text + "}\n";
}

std::string mesh_text(const SceneParts& scene, const ScenePart& part, size_t number) {
    const PartMaterial& material = scene.materials[part.material];
    std::string text = fmt::format(
        "def Xform \"{}_{}\" (\n doc = {}\n)\n{{\n"
        "def Mesh \"surface\" (\n prepend apiSchemas = [\"MaterialBindingAPI\"]\n)\n{{\n"
        " rel material:binding = </scene/materials/{}>\n uniform token subdivisionScheme = \"none\"\n",
        identifier(material.name), number, quoted(material.name), material_name(part));
    text += " int[] faceVertexCounts = [";
    for (size_t i = 0; i < part.triangles.size(); ++i) text += i > 0 ? ",3" : "3";
    text += "]\n int[] faceVertexIndices = [";
    for (size_t i = 0; i < part.triangles.size(); ++i) {
        const auto& [a, b, c] = part.triangles[i];
        fmt::format_to(std::back_inserter(text), "{}{},{},{}", i > 0 ? "," : "", a, b, c);
    }
    text += "]\n point3f[] points = ";
    append_list<glm::vec3>(text, part.positions_m);
    text += "\n normal3f[] normals = ";
    append_list<glm::vec3>(text, part.normals);
    text += " (\n  interpolation = \"vertex\"\n )\n";
    if (part.places.empty()) {
        text += " color3f[] primvars:displayColor = ";
        append_list<glm::vec3>(text, part.base);
    } else {
        text += " texCoord2f[] primvars:st = ";
        append_list<glm::vec2>(text, part.places);
    }
    return text + " (\n  interpolation = \"vertex\"\n )\n}\n}\n";
}

/// A sphere of radiance L has L pi r^2 candela, and so has a disc along its axis; with `normalize` the intensity is L
/// times the area.
std::string light_text(const Light& light, double candela_per_intensity, size_t number) {
    const glm::dvec3 candela = light.intensity * candela_per_intensity;
    const double strongest = std::max({candela.r, candela.g, candela.b});
    const glm::vec3 color = strongest > 0 ? glm::vec3(candela / strongest) : glm::vec3(1);
    const glm::dquat turn =
        is_flat(light) ? glm::dquat(glm::dvec3(0, 0, -1), glm::normalize(light.axis)) : glm::dquat(1, 0, 0, 0);
    return fmt::format(
        "def {} \"light_{}\"\n{{\n color3f inputs:color = {}\n float inputs:intensity = {:.6g}\n"
        " bool inputs:normalize = 1\n float inputs:radius = {:.4f}\n double3 xformOp:translate = ({:.6f}, {:.6f}, "
        "{:.6f})\n quatf xformOp:orient = ({:.6g}, {:.6g}, {:.6g}, {:.6g})\n"
        " uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\"]\n}}\n",
        is_flat(light) ? "DiskLight" : "SphereLight", number + 1, tuple(color), (is_flat(light) ? 1 : 4) * strongest,
        light.radius_m > 0 ? light.radius_m : 0.01, light.position_m.x, light.position_m.y, light.position_m.z, turn.w,
        turn.x, turn.y, turn.z);
}

/// A rectangle of USD has its width along x and its height along y, and shines along -z.
std::string window_text(const AreaLight& window, double luminance_per_radiance, size_t number) {
    const glm::dvec3 luminance = window.radiance * luminance_per_radiance;
    const double strongest = std::max({luminance.r, luminance.g, luminance.b});
    const glm::vec3 color = strongest > 0 ? glm::vec3(luminance / strongest) : glm::vec3(1);
    const double width_m = 2 * glm::length(window.half_u_m), height_m = 2 * glm::length(window.half_v_m);
    const glm::dvec3 back = -normal_of(window), up = glm::normalize(window.half_v_m);
    const glm::dquat turn = glm::quat_cast(glm::dmat3(glm::cross(up, back), up, back));
    return fmt::format(
        "def RectLight \"window_{}\"\n{{\n color3f inputs:color = {}\n float inputs:intensity = {:.6g}\n"
        " float inputs:width = {:.4f}\n float inputs:height = {:.4f}\n double3 xformOp:translate = ({:.6f}, {:.6f}, "
        "{:.6f})\n quatf xformOp:orient = ({:.6g}, {:.6g}, {:.6g}, {:.6g})\n"
        " uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\"]\n}}\n",
        number + 1, tuple(color), strongest, width_m, height_m, window.center_m.x, window.center_m.y, window.center_m.z,
        turn.w, turn.x + 0.0, turn.y + 0.0, turn.z + 0.0);  // no -0
}

}  // namespace

std::string usda_text(const SceneParts& scene, const std::vector<std::string>& pages) {
    std::string text =
        "#usda 1.0\n(\n defaultPrim = \"scene\"\n metersPerUnit = 1\n upAxis = \"Y\"\n)\n\ndef Xform \"scene\"\n{\n";
    text += materials_text(scene, pages);
    for (size_t i = 0; i < scene.parts.size(); ++i) text += mesh_text(scene, scene.parts[i], i);
    for (size_t i = 0; i < scene.lights.size(); ++i)
        text += light_text(scene.lights[i], scene.candela_per_intensity, i);
    for (size_t i = 0; i < scene.windows.size(); ++i)
        text += window_text(scene.windows[i], scene.luminance_per_radiance(), i);
    return text + "}\n";
}

void write_usdz(const std::filesystem::path& path, const SceneParts& scene) {
    std::vector<std::string> pages;
    for (size_t i = 0; i < scene.pages.size(); ++i)
        pages.push_back(fmt::format("textures/page-{}{}", i + 1, extension_of(scene.pages[i])));
    StoredZip zip(path);
    zip.add("scene.usda", usda_text(scene, pages));
    for (size_t i = 0; i < pages.size(); ++i) {
        const std::vector<unsigned char>& bytes = scene.pages[i].bytes;
        zip.add(pages[i], {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    }
    zip.finish();
}

}  // namespace patina
