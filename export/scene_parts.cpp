#include "export/scene_parts.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <glm/gtc/quaternion.hpp>

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "export/glb_model.h"
#include "sensor/files/exr_file.h"

namespace patina {

namespace {

using Value = tinygltf::Value;

double number(const Value& object, const char* name, double otherwise) {
    if (!object.IsObject() || !object.Has(name) || !object.Get(name).IsNumber()) return otherwise;
    return object.Get(name).GetNumberAsDouble();
}

glm::dvec3 vector(const Value& object, const char* name, glm::dvec3 otherwise) {
    if (!object.IsObject() || !object.Has(name) || object.Get(name).ArrayLen() != 3) return otherwise;
    glm::dvec3 result;
    for (int i = 0; i < 3; ++i) result[i] = object.Get(name).Get(static_cast<size_t>(i)).GetNumberAsDouble();
    return result;
}

const Value& extension(const tinygltf::ExtensionMap& extensions, const char* name) {
    static const Value kNone;
    const auto found = extensions.find(name);
    return found == extensions.end() ? kNone : found->second;
}

GltfMaterial gltf_of(const tinygltf::Material& material) {
    GltfMaterial gltf;
    const tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
    gltf.metal = pbr.metallicFactor > 0.5;
    gltf.roughness = static_cast<float>(pbr.roughnessFactor);
    const Value& ior = extension(material.extensions, "KHR_materials_ior");
    gltf.ior = static_cast<float>(number(ior, "ior", 1.5));
    const Value& specular = extension(material.extensions, "KHR_materials_specular");
    gltf.specular = static_cast<float>(number(specular, "specularFactor", ior.IsObject() ? 1 : 0));
    gltf.specular_color = glm::vec3(vector(specular, "specularColorFactor", glm::dvec3(1)));
    for (glm::length_t i = 0; i < 3 && pbr.baseColorFactor.size() == 4; ++i)
        gltf.base_color[i] = static_cast<float>(pbr.baseColorFactor[static_cast<size_t>(i)]);
    return gltf;
}

PartMaterial material_of(const tinygltf::Node& node, const tinygltf::Material& material) {
    PartMaterial result;
    result.name = node.name;
    result.label = static_cast<uint32_t>(std::max(number(node.extras, "segment", 0), 0.0));
    result.gltf = gltf_of(material);
    if (!material.extras.IsObject() || !material.extras.Has("ward")) return result;
    const Value& ward = material.extras.Get("ward");
    result.has_reflectance = true;
    result.observed = ward.IsObject() && ward.Has("ks");
    result.gltf.observed = result.observed;
    const Value& values = ward.Has("guess") ? ward.Get("guess") : ward;
    if (values.Has("ks"))
        result.gloss =
            WardGloss{glm::vec3(vector(values, "ks", glm::dvec3(0))), static_cast<float>(number(values, "alpha", 1))};
    return result;
}

/// The transform of a node below its parent: what Patina writes has no scale.
glm::dmat4 transform_of(const tinygltf::Node& node) {
    glm::dmat4 transform(1);
    if (node.rotation.size() == 4)
        transform = glm::mat4_cast(
            glm::normalize(glm::dquat(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2])));
    if (node.translation.size() == 3)
        transform[3] = glm::dvec4(node.translation[0], node.translation[1], node.translation[2], 1);
    return transform;
}

class Reader {
  public:
    explicit Reader(const std::filesystem::path& file) : file_(file), model_(read_glb(file)), arrays_(file_, model_) {}

    SceneParts read() {
        const bool ours = model_.asset.generator.starts_with("Patina") && model_.scenes.size() == 1 &&
                          model_.scenes.front().nodes.size() == 1;
        if (!ours) throw Error(file_, " was not written by Patina but by '", model_.asset.generator, "'");
        const tinygltf::Node& root = arrays_.at(model_.nodes, model_.scenes.front().nodes.front(), "node");
        scene_.name = root.name;
        const Value& extras = model_.scenes.front().extras;
        if (extras.IsObject() && extras.Has("photometric"))
            scene_.candela_per_intensity = number(extras.Get("photometric"), "candela_per_intensity", 1);
        if (!(scene_.candela_per_intensity > 0))
            throw Error(file_, ": candela_per_intensity is ", scene_.candela_per_intensity, ", not above 0");
        for (size_t i = 0; i < base_color_pages(model_); ++i)
            scene_.pages.push_back({model_.images[i].mimeType, model_.images[i].image});
        const glm::dmat4 to_gltf = transform_of(root);
        if (extras.IsObject() && extras.Has("environment")) take_environment(extras.Get("environment"), to_gltf);
        for (const int child : root.children) {
            const tinygltf::Node& node = arrays_.at(model_.nodes, child, "node");
            if (node.mesh >= 0) add_mesh(node, to_gltf * transform_of(node));
            add_light(node, to_gltf);
        }
        if (extras.IsObject() && extras.Has("windows")) take_windows(extras.Get("windows"), to_gltf);
        return std::move(scene_);
    }

  private:
    void take_environment(const Value& environment, const glm::dmat4& to_gltf) {
        const auto text = [&](const char* name) {
            return environment.IsObject() && environment.Has(name) && environment.Get(name).IsString()
                       ? environment.Get(name).Get<std::string>()
                       : std::string();
        };
        const std::filesystem::path name = text("file");
        const double scale = number(environment, "luminance_per_pixel_value", 0);
        if (name.empty() || name != name.filename() || !(scale > 0)) return;  // nothing outside the folder is read
        tinygltf::Node axes;
        const Value& turn = environment.Get("y_up_from_root");
        if (!turn.IsArray() || turn.ArrayLen() != 4) return;
        for (size_t i = 0; i < 4; ++i) axes.rotation.push_back(turn.Get(i).GetNumberAsDouble());
        scene_.environment_file = name.string();
        scene_.luminance_per_pixel_value = scale;
        scene_.environment_from_gltf =
            glm::quat_cast(glm::dmat3(transform_of(axes)) * glm::transpose(glm::dmat3(to_gltf)));
    }

    /// After the lamps, whose scale theirs is. One that has no area is left out.
    void take_windows(const Value& windows, const glm::dmat4& to_gltf) {
        const auto count = windows.IsArray() ? static_cast<int>(windows.ArrayLen()) : 0;
        for (int i = 0; i < count; ++i) {
            const Value& told = windows.Get(i);
            const glm::dmat3 turn(to_gltf);
            AreaLight window{.center_m = glm::dvec3(to_gltf * glm::dvec4(vector(told, "center", glm::dvec3(0)), 1)),
                             .half_u_m = turn * vector(told, "half_u", glm::dvec3(0)),
                             .half_v_m = turn * vector(told, "half_v", glm::dvec3(0)),
                             .radiance = vector(told, "luminance", glm::dvec3(0)) / scene_.luminance_per_radiance()};
            if (told.IsObject() && told.Has("clipped") && told.Get("clipped").IsBool())
                window.clipped = told.Get("clipped").Get<bool>();
            const double area_m2 = glm::length(glm::cross(window.half_u_m, window.half_v_m));
            if (area_m2 > 0 && std::isfinite(area_m2)) scene_.windows.push_back(window);
        }
    }

    void add_mesh(const tinygltf::Node& node, const glm::dmat4& to_gltf) {
        for (const tinygltf::Primitive& primitive : arrays_.at(model_.meshes, node.mesh, "mesh").primitives) {
            const tinygltf::Material& material = arrays_.at(model_.materials, primitive.material, "material");
            const auto [known, is_new] = materials_.try_emplace(node.mesh, scene_.materials.size());
            if (is_new) scene_.materials.push_back(material_of(node, material));
            add_part(primitive, material, known->second, to_gltf);
        }
    }

    void add_part(const tinygltf::Primitive& primitive, const tinygltf::Material& material, size_t number,
                  const glm::dmat4& to_gltf) {
        ScenePart part;
        part.material = number;
        part.positions_m = arrays_.vectors(attribute_of(primitive, "POSITION"));
        part.normals = arrays_.vectors(attribute_of(primitive, "NORMAL"));
        const size_t vertices = part.positions_m.size();
        for (glm::vec3& position : part.positions_m) position = glm::vec3(to_gltf * glm::dvec4(position, 1));
        for (glm::vec3& normal : part.normals) normal = glm::vec3(to_gltf * glm::dvec4(normal, 0));
        part.triangles = arrays_.triangles(primitive, vertices);
        const int texture = material.pbrMetallicRoughness.baseColorTexture.index;
        const int places = attribute_of(primitive, "TEXCOORD_0"), colors = attribute_of(primitive, "COLOR_0");
        if (texture >= 0 && places >= 0) {
            part.page = static_cast<uint32_t>(arrays_.at(model_.textures, texture, "texture").source);
            if (part.page >= scene_.pages.size())
                throw Error(file_, ": page ", part.page, " is asked for, but there are ", scene_.pages.size());
            part.places = arrays_.pairs(places);
        } else if (colors >= 0) {
            part.base = arrays_.colors(colors);
        } else {
            part.base.assign(vertices, scene_.materials[number].gltf.base_color);
        }
        if (part.normals.size() != vertices || part.places.size() + part.base.size() != vertices)
            throw Error(file_, ": the attributes of a primitive have ", vertices, ", ", part.normals.size(), " and ",
                        part.places.size() + part.base.size(), " vertices");
        scene_.parts.push_back(std::move(part));
    }

    void add_light(const tinygltf::Node& node, const glm::dmat4& to_gltf) {
        const double index = number(extension(node.extensions, "KHR_lights_punctual"), "light", -1);
        if (index < 0) return;
        const tinygltf::Light& lamp = arrays_.at(model_.lights, static_cast<int>(index), "light");
        Light light;
        const glm::dmat4 to_lamp = to_gltf * transform_of(node);
        light.position_m = glm::dvec3(to_lamp[3]);
        if (lamp.type == "spot") light.axis = -glm::normalize(glm::dvec3(to_lamp[2]));
        const glm::dvec3 color =
            lamp.color.size() == 3 ? glm::dvec3(lamp.color[0], lamp.color[1], lamp.color[2]) : glm::dvec3(1);
        light.intensity = color * (lamp.intensity / scene_.candela_per_intensity);
        light.radius_m = number(lamp.extras, "radius_m", 0);
        scene_.lights.push_back(light);
    }

    const std::filesystem::path& file_;
    tinygltf::Model model_;
    GlbArrays arrays_;
    SceneParts scene_;
    std::map<int, size_t> materials_;  ///< by mesh
};

}  // namespace

uint64_t SceneParts::triangles() const {
    uint64_t count = 0;
    for (const ScenePart& part : parts) count += part.triangles.size();
    return count;
}

uint64_t SceneParts::vertices() const {
    uint64_t count = 0;
    for (const ScenePart& part : parts) count += part.positions_m.size();
    return count;
}

SceneParts read_scene_parts(const std::filesystem::path& file) { return Reader(file).read(); }

void read_environment(SceneParts& scene, const std::filesystem::path& folder) {
    if (scene.environment_file.empty() || !path_exists(folder / scene.environment_file)) return;
    scene.environment = sensor::read_exr_color(folder / scene.environment_file);
    for (glm::vec3& radiance : scene.environment.pixels())
        radiance /= static_cast<float>(scene.luminance_per_pixel_value);
}

std::vector<std::vector<glm::vec3>> base_colors(const SceneParts& scene) {
    std::vector<std::vector<glm::vec3>> colors(scene.parts.size());
    for (size_t i = 0; i < scene.parts.size(); ++i) colors[i] = scene.parts[i].base;
    for (uint32_t number = 0; number < scene.pages.size(); ++number) {
        const Image<glm::vec3> page = linear_page(scene.pages[number]);
        for (size_t i = 0; i < scene.parts.size(); ++i) {
            if (scene.parts[i].page != number) continue;
            for (const glm::vec2 place : scene.parts[i].places) colors[i].push_back(texel_at(page, place));
        }
    }
    return colors;
}

std::array<glm::vec3, 2> bounds_of(const SceneParts& scene) {
    glm::vec3 low(1e30f), high(-1e30f);
    for (const ScenePart& part : scene.parts) {
        for (const glm::vec3 position : part.positions_m)
            low = glm::min(low, position), high = glm::max(high, position);
    }
    if (low.x > high.x) return {glm::vec3(0), glm::vec3(0)};
    return {low, high};
}

}  // namespace patina
