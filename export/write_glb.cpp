#include "export/write_glb.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include <tiny_gltf.h>

#include "export/drawable_mesh.h"
#include "export/glb_file.h"
#include "export/gltf_arrays.h"
#include "export/gltf_material.h"
#include "export/mesh_parts.h"

namespace patina {
namespace {

using Triangle = std::array<uint32_t, 3>;
using Value = tinygltf::Value;

constexpr const char* kSpecular = "KHR_materials_specular";
constexpr const char* kLights = "KHR_lights_punctual";
constexpr const char* kSurface = "surface";

GltfColor encode(glm::vec3 linear) {
    const auto channel = [](float v) {
        return static_cast<uint16_t>(std::lround(std::clamp(v, 0.0f, 1.0f) * 65535.0f));
    };
    return {channel(linear.r), channel(linear.g), channel(linear.b), 65535};
}

bool displayable(glm::vec3 linear) { return linear == glm::clamp(linear, 0.0f, 1.0f); }

Value array_of(glm::dvec3 v) { return Value(Value::Array{Value(v.x), Value(v.y), Value(v.z)}); }

Value ward_extras(const WardGloss& gloss) {
    Value::Object ward{{"variant", Value(std::string("ward"))}, {"exposureScale", Value(1.0)}};
    ward["ks"] = array_of(glm::dvec3(gloss.ks));
    ward["alpha"] = Value(double{gloss.alpha});
    return Value(Value::Object{{"ward", Value(std::move(ward))}});
}

/// A part's vertices out of an array of the whole mesh.
template <class Element>
std::vector<Element> gathered(const std::vector<Element>& all, const MeshPart& part) {
    std::vector<Element> elements;
    elements.reserve(part.vertices.size());
    for (const uint32_t vertex : part.vertices) elements.push_back(all[vertex]);
    return elements;
}

/// A mesh with what it reflects, and its normals.
struct Piece {
    const Mesh& mesh;
    const MeshReflectance* reflectance;  ///< null: it has colours alone
    std::vector<glm::vec3> normals;      ///< unit length

    const SegmentReflectance& segment(uint32_t label) const {
        static const SegmentReflectance kNone;
        return label < reflectance->segments.size() ? reflectance->segments[label] : kNone;
    }
};

}  // namespace

struct GlbWriter::State {
    /// What becomes a node with a mesh and a material.
    struct Segment {
        tinygltf::Material material;
        std::vector<tinygltf::Primitive> primitives;
    };

    State(const std::filesystem::path& at, GlbInfo about) : path(at), info(std::move(about)), file(at) {}

    void add(const Piece& piece, const MeshPart& part);
    GlbSummary finish();

    std::filesystem::path path;
    GlbInfo info;
    GlbFile file;
    tinygltf::Model model;
    GltfArrays arrays{model, file};
    std::map<uint32_t, Segment> segments;  ///< by label
    GlbSummary summary;

  private:
    std::string name_of(uint32_t label) const {
        if (label == 0) return kSurface;
        const bool named = label < info.segment_names.size() && !info.segment_names[label].empty();
        return named ? info.segment_names[label] : "segment " + std::to_string(label);
    }

    void add_root() {
        const glm::dquat turn = glm::normalize(info.y_up_from_world);
        tinygltf::Node root;
        root.name = info.name;
        root.rotation = {turn.x, turn.y, turn.z, turn.w};
        if (info.world_offset_m != glm::dvec3(0))
            root.extras = Value(Value::Object{{"world_offset_m", array_of(info.world_offset_m)}});
        model.nodes.push_back(std::move(root));
        tinygltf::Scene scene;
        scene.name = info.name;
        scene.nodes = {0};
        model.scenes.push_back(std::move(scene));
        model.defaultScene = 0;
        model.asset.version = "2.0";
        model.asset.generator = "Patina " + info.version;
    }

    /// Below the root.
    tinygltf::Node& add_node(const std::string& name) {
        model.nodes.front().children.push_back(static_cast<int>(model.nodes.size()));
        tinygltf::Node& node = model.nodes.emplace_back();
        node.name = name;
        return node;
    }

    void use_extension(const char* name) {
        auto& used = model.extensionsUsed;
        if (std::ranges::find(used, name) == used.end()) used.emplace_back(name);
    }

    void add_segment(uint32_t label, Segment&& segment) {
        const int material = static_cast<int>(model.materials.size());
        for (tinygltf::Primitive& primitive : segment.primitives) primitive.material = material;
        model.materials.push_back(std::move(segment.material));
        add_node(name_of(label)).mesh = static_cast<int>(model.meshes.size());
        tinygltf::Mesh& mesh = model.meshes.emplace_back();
        mesh.name = name_of(label);
        mesh.primitives = std::move(segment.primitives);
    }

    tinygltf::Material material_of(const Piece& piece, uint32_t label) {
        tinygltf::Material material;
        material.name = name_of(label);
        material.pbrMetallicRoughness.metallicFactor = 0;
        material.pbrMetallicRoughness.roughnessFactor = 1;
        if (!piece.reflectance) return material;
        const SegmentReflectance& own = piece.segment(label);
        set_material(look_of(own), material);
        if (own.gloss) material.extras = ward_extras(*own.gloss);
        return material;
    }

    /// A segment without a material has no highlight at all, which is what ks = 0 becomes.
    static GltfMaterial look_of(const SegmentReflectance& segment) {
        return gltf_material(segment.gloss.value_or(WardGloss{}), segment.kd.value_or(glm::vec3(1)));
    }

    void add_colors(tinygltf::Primitive& primitive, const std::vector<glm::vec3>& linear) {
        std::vector<GltfColor> colors(linear.size());
        std::ranges::transform(linear, colors.begin(), encode);
        primitive.attributes["COLOR_0"] = arrays.add_vertices("COLOR_0", colors);
        summary.clamped_colors += static_cast<uint64_t>(std::ranges::count_if(linear, std::not_fn(displayable)));
    }

    std::vector<glm::vec3> albedo_of(const Piece& piece, const MeshPart& part) {
        const auto& mean = piece.segment(part.label).kd;
        std::vector<glm::vec3> albedo;
        albedo.reserve(part.vertices.size());
        for (const uint32_t vertex : part.vertices) {
            const glm::vec4 known = piece.reflectance->kd[vertex];
            summary.unknown_albedo += known.a == 0 && !mean;
            const glm::vec3 fallback = mean ? *mean : glm::min(piece.mesh.colors[vertex], 1.0f);
            albedo.push_back(known.a > 0 ? glm::vec3(known) : fallback);
        }
        return albedo;
    }

    void add_reflectance(const Piece& piece, const MeshPart& part, tinygltf::Primitive& primitive) {
        const SegmentReflectance& own = piece.segment(part.label);
        const std::vector<glm::vec3> albedo = albedo_of(piece, part);
        const GltfMaterial shown = look_of(own);
        primitive.attributes["_KD"] = arrays.add_vertices("_KD", albedo);
        if (!shown.metal) {
            std::vector<glm::vec3> base(albedo.size());
            std::ranges::transform(albedo, base.begin(), [&](glm::vec3 kd) { return base_color_of(shown, kd); });
            add_colors(primitive, base);
        }
        if (!own.gloss) return;
        const size_t count = part.vertices.size();
        primitive.attributes["_KS"] = arrays.add_vertices("_KS", std::vector<glm::vec3>(count, own.gloss->ks));
        primitive.attributes["_WARD_ALPHA"] =
            arrays.add_vertices("_WARD_ALPHA", std::vector<float>(count, own.gloss->alpha));
    }

    void set_material(const GltfMaterial& shown, tinygltf::Material& material) {
        tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
        pbr.roughnessFactor = double{shown.roughness};
        if (shown.metal) {
            pbr.metallicFactor = 1;
            pbr.baseColorFactor = {shown.base_color.r, shown.base_color.g, shown.base_color.b, 1};
            return;
        }
        // Black without a highlight: Blender 3.4 reads the colour and not the factor.
        const glm::dvec3 color(shown.specular > 0 ? shown.specular_color : glm::vec3(0));
        material.extensions[kSpecular] = Value(
            Value::Object{{"specularFactor", Value(double{shown.specular})}, {"specularColorFactor", array_of(color)}});
        use_extension(kSpecular);
    }

    void add_light(const Light& light) {
        const double strongest = std::max({light.intensity.r, light.intensity.g, light.intensity.b});
        const glm::dvec3 color = strongest > 0 ? light.intensity / strongest : glm::dvec3(1);
        const int index = static_cast<int>(model.lights.size());
        tinygltf::Light lamp;
        lamp.name = "light " + std::to_string(index + 1);
        lamp.type = "point";
        lamp.color = {color.r, color.g, color.b};
        lamp.intensity = strongest;
        Value::Object extras{{"calibrated", Value(false)},
                             {"unit", Value(std::string("linear pixel value times square metre"))}};
        if (light.radius_m > 0) extras["radius_m"] = Value(light.radius_m);
        lamp.extras = Value(std::move(extras));
        tinygltf::Node& node = add_node(lamp.name);
        node.translation = {light.position_m.x, light.position_m.y, light.position_m.z};
        node.extensions[kLights] = Value(Value::Object{{"light", Value(index)}});
        model.lights.push_back(std::move(lamp));
        use_extension(kLights);
    }
};

void GlbWriter::State::add(const Piece& piece, const MeshPart& part) {
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.attributes["POSITION"] = arrays.add_positions(gathered(piece.mesh.positions_m, part));
    primitive.attributes["NORMAL"] = arrays.add_vertices("NORMAL", gathered(piece.normals, part));
    if (piece.reflectance) {
        add_reflectance(piece, part, primitive);
    } else {
        add_colors(primitive, gathered(piece.mesh.colors, part));
    }
    primitive.indices = arrays.add_indices(part.triangles, part.vertices.size());

    const auto [segment, is_new] = segments.try_emplace(part.label);
    if (is_new) segment->second.material = material_of(piece, part.label);
    segment->second.primitives.push_back(std::move(primitive));
    summary.vertices += part.vertices.size();
    summary.triangles += part.triangles.size();
}

GlbSummary GlbWriter::State::finish() {
    add_root();
    if (segments.empty()) add_node(kSurface);
    for (auto& [label, segment] : segments) add_segment(label, std::move(segment));
    for (const Light& light : info.lights) add_light(light);
    file.finish(model);
    return summary;
}

GlbWriter::GlbWriter(const std::filesystem::path& path, GlbInfo info)
    : state_(std::make_unique<State>(path, std::move(info))) {}

GlbWriter::~GlbWriter() = default;

void GlbWriter::add(const Mesh& mesh, const MeshReflectance* reflectance) {
    if (reflectance && reflectance->kd.empty()) reflectance = nullptr;
    check_mesh(state_->path, mesh);
    if (reflectance) check_reflectance(state_->path, mesh, *reflectance);
    const std::vector<Triangle> triangles = drawable_triangles(mesh);
    state_->summary.degenerate_triangles += mesh.triangles.size() - triangles.size();
    if (triangles.empty()) return;
    const Piece piece{mesh, reflectance, unit_normals(mesh, triangles)};
    const std::span<const uint32_t> labels =
        reflectance ? std::span<const uint32_t>(reflectance->labels) : std::span<const uint32_t>();
    for (const MeshPart& part : parts_by_label(static_cast<uint32_t>(mesh.positions_m.size()), triangles, labels))
        state_->add(piece, part);
}

GlbSummary GlbWriter::finish() { return state_->finish(); }

GlbSummary write_glb(const std::filesystem::path& path, const GlbScene& scene, const GlbInfo& info) {
    GlbWriter writer(path, info);
    writer.add(scene.mesh, scene.reflectance);
    return writer.finish();
}

}  // namespace patina
