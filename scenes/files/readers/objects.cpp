#include "scenes/files/readers/objects.h"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "scenes/files/mesh_file.h"
#include "scenes/files/readers/values.h"

namespace patina::scenes {
namespace {

namespace fs = std::filesystem;

/// The value that `name` stands for.
template <class Value>
Value read_choice(const sensor::JsonValue& name, const std::map<std::string, Value>& choices) {
    const auto choice = choices.find(name.string());
    if (choice != choices.end()) return choice->second;
    std::string list;
    for (const auto& [known, value] : choices) list += (list.empty() ? "" : ", ") + known;
    name.fail("must be one of " + list);
}

RectangleShape read_rectangle(const sensor::JsonValue& value) {
    value.expect_keys({"size"});
    const std::vector<sensor::JsonValue> size = value.at("size").elements_of(2);
    return {glm::dvec2(read_positive(size[0]), read_positive(size[1])) / 2.0};
}

BoxShape read_box(const sensor::JsonValue& value) {
    value.expect_keys({"size"});
    const std::vector<sensor::JsonValue> size = value.at("size").elements_of(3);
    return {glm::dvec3(read_positive(size[0]), read_positive(size[1]), read_positive(size[2])) / 2.0};
}

SphereShape read_sphere(const sensor::JsonValue& value) {
    value.expect_keys({"radius"});
    return {read_positive(value.at("radius"))};
}

CylinderShape read_cylinder(const sensor::JsonValue& value) {
    value.expect_keys({"radius", "height"});
    return {read_positive(value.at("radius")), read_positive(value.at("height")) / 2};
}

MeshSettings read_mesh_settings(const sensor::JsonValue& value) {
    value.expect_keys({"file", "height", "scale", "up", "normals"});
    MeshSettings settings;
    if (const auto up = value.find("up")) {
        settings.up = read_choice<MeshUp>(*up, {{"y", MeshUp::kY}, {"z", MeshUp::kZ}, {"-y", MeshUp::kMinusY}});
    }
    if (const auto normals = value.find("normals")) {
        settings.normals = read_choice<MeshNormals>(
            *normals, {{"file", MeshNormals::kFile}, {"smooth", MeshNormals::kSmooth}, {"flat", MeshNormals::kFlat}});
    }
    if (const auto height = value.find("height")) settings.height_m = read_positive(*height);
    if (const auto scale = value.find("scale")) {
        if (settings.height_m) scale->fail("which is of no use beside a height");
        settings.scale = read_positive(*scale);
    }
    return settings;
}

class ObjectReader {
  public:
    ObjectReader(const MaterialReader& materials, MeshChanges changes)
        : materials_(materials), changes_(std::move(changes)) {}

    SceneObject read(const sensor::JsonValue& value) {
        value.expect_keys({"name", "material", "parts", "position", "rotations"});
        ObjectMaterial material = materials_.read(value.at("material"));
        SceneObject object{{}, std::move(material.material), std::move(material.texture)};
        object.material.name = read_name(value.at("name"));
        object.material.id = static_cast<uint32_t>(place_of_name_.size());
        const RigidTransform world_from_object = read_placement(value);
        const sensor::JsonValue parts = value.at("parts");
        for (const sensor::JsonValue& part : parts.elements())
            object.parts.push_back({read_shape(part), world_from_object * read_placement(part)});
        if (object.parts.empty()) parts.fail("must hold at least one part");
        return object;
    }

  private:
    std::string read_name(const sensor::JsonValue& value) {
        const std::string name = value.string();
        if (name.empty()) value.fail("must not be empty");
        const auto [entry, is_new] = place_of_name_.try_emplace(name, value.where());
        if (!is_new) value.fail("which is the name of another object, at " + entry->second);
        return name;
    }

    Shape read_shape(const sensor::JsonValue& part) {
        const auto [kind, shape] =
            read_kind(part, {"rectangle", "box", "sphere", "cylinder", "mesh"}, {"position", "rotations"});
        if (kind == "rectangle") return read_rectangle(shape);
        if (kind == "box") return read_box(shape);
        if (kind == "sphere") return read_sphere(shape);
        if (kind == "cylinder") return read_cylinder(shape);
        return read_mesh_shape(shape);
    }

    MeshShape read_mesh_shape(const sensor::JsonValue& value) {
        const MeshSettings settings = read_mesh_settings(value);
        const sensor::JsonValue name = value.at("file");
        if (settings.height_m && !changes_.file.empty()) return {shared_mesh(changes_.file, settings)};
        return located(name, [&] { return MeshShape{shared_mesh(beside_file(name), settings)}; });
    }

    /// Meshes of the same file and settings are read once.
    std::shared_ptr<const TriangleMesh> shared_mesh(const fs::path& file, const MeshSettings& settings) {
        std::shared_ptr<const TriangleMesh>& mesh = meshes_[{file, settings}];
        if (mesh) return mesh;
        TriangleMesh triangles = read_mesh(file, settings);
        if (settings.height_m && changes_.bumps) triangles = with_bumps(std::move(triangles), *changes_.bumps);
        return mesh = std::make_shared<const TriangleMesh>(std::move(triangles));
    }

    const MaterialReader& materials_;
    MeshChanges changes_;
    std::map<std::string, std::string> place_of_name_;
    std::map<std::pair<fs::path, MeshSettings>, std::shared_ptr<const TriangleMesh>> meshes_;
};

}  // namespace

std::vector<SceneObject> read_objects(std::span<const sensor::JsonValue> lists, const MaterialReader& materials,
                                      const MeshChanges& changes) {
    ObjectReader reader(materials, changes);
    std::vector<SceneObject> objects;
    for (const sensor::JsonValue& list : lists) {
        const std::vector<sensor::JsonValue> elements = list.elements();
        if (elements.empty()) list.fail("must hold at least one object");
        if (elements.size() > UINT16_MAX) {
            throw Error(list.where(), " holds ", elements.size(), " objects, but label images tell apart ", UINT16_MAX);
        }
        for (const sensor::JsonValue& element : elements) objects.push_back(reader.read(element));
    }
    return objects;
}

void remove_objects(const sensor::JsonValue& names, SyntheticScene& scene) {
    for (const sensor::JsonValue& name : names.elements()) {
        const auto has_name = [&](const SceneObject& object) { return object.material.name == name.string(); };
        if (std::erase_if(scene.objects, has_name) == 0) name.fail("which is no object of " + scene.name);
    }
    number_objects(names, scene);
}

void number_objects(const sensor::JsonValue& value, SyntheticScene& scene) {
    if (scene.objects.size() > UINT16_MAX)
        value.fail("which makes " + std::to_string(scene.objects.size()) + " objects, but label images tell apart " +
                   std::to_string(UINT16_MAX));
    for (size_t i = 0; i < scene.objects.size(); ++i) scene.objects[i].material.id = static_cast<uint32_t>(i + 1);
}

}  // namespace patina::scenes
