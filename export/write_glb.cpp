#include "export/write_glb.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <ostream>
#include <utility>

#include <tiny_gltf.h>

#include "engine/core/error.h"
#include "export/gltf_arrays.h"
#include "export/gltf_material.h"
#include "export/mesh_parts.h"
#include "sensor/output/new_file.h"

namespace patina {
namespace {

using Triangle = std::array<uint32_t, 3>;
using Value = tinygltf::Value;

/// Left for the headers and the JSON, whose size depends on the number of segments and lights alone.
constexpr uint64_t kJsonAllowance = 1 << 24;
constexpr const char* kSpecular = "KHR_materials_specular";
constexpr const char* kLights = "KHR_lights_punctual";
constexpr const char* kSurface = "surface";

bool finite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check_finite(const std::filesystem::path& path, const char* what, std::span<const glm::vec3> values) {
    const auto bad = std::ranges::find_if_not(values, finite);
    if (bad == values.end()) return;
    throw Error(path, ": the ", what, " of vertex ", bad - values.begin(), " of ", values.size(), " is not finite: (",
                bad->x, ", ", bad->y, ", ", bad->z, ")");
}

void check_scene(const std::filesystem::path& path, const GlbScene& scene) {
    const Mesh& mesh = scene.mesh;
    const size_t vertices = mesh.positions_m.size();
    PATINA_ASSERT(mesh.normals.size() == vertices && mesh.colors.size() == vertices, "positions ", vertices,
                  ", normals ", mesh.normals.size(), ", colors ", mesh.colors.size());
    check_finite(path, "position", mesh.positions_m);
    check_finite(path, "normal", mesh.normals);
    check_finite(path, "colour", mesh.colors);
    if (scene.reflectance) {
        const auto& [kd, labels, segments] = *scene.reflectance;
        PATINA_ASSERT(kd.size() == labels.size() && (kd.empty() || kd.size() == vertices), "vertices ", vertices,
                      ", kd ", kd.size(), ", labels ", labels.size());
        check_finite(path, "albedo", std::vector<glm::vec3>(kd.begin(), kd.end()));
    }
    for (const Triangle& triangle : mesh.triangles) {
        const uint32_t largest = std::ranges::max(triangle);
        if (largest >= vertices) throw Error(path, ": a triangle names vertex ", largest, " of ", vertices);
    }
}

/// Twice the triangle's area along its normal. Float differences are exact in double, so that coinciding and (but for
/// extreme scales) collinear corners give exactly zero.
glm::dvec3 area_vector(const Mesh& mesh, const Triangle& t) {
    const glm::dvec3 a(mesh.positions_m[t[0]]), b(mesh.positions_m[t[1]]), c(mesh.positions_m[t[2]]);
    return glm::cross(b - a, c - a);
}

std::vector<Triangle> drawable_triangles(const Mesh& mesh) {
    std::vector<Triangle> kept;
    kept.reserve(mesh.triangles.size());
    std::ranges::copy_if(mesh.triangles, std::back_inserter(kept),
                         [&](const Triangle& t) { return area_vector(mesh, t) != glm::dvec3(0); });
    return kept;
}

/// The sum of the area vectors around each vertex that has no normal; zero for all others.
std::vector<glm::dvec3> substitute_normals(const Mesh& mesh, std::span<const Triangle> triangles) {
    std::vector<glm::dvec3> sums(mesh.normals.size());
    for (const Triangle& triangle : triangles) {
        const glm::dvec3 area = area_vector(mesh, triangle);
        for (uint32_t vertex : triangle) {
            if (mesh.normals[vertex] == glm::vec3(0)) sums[vertex] += area;
        }
    }
    return sums;
}

std::vector<glm::vec3> unit_normals(const Mesh& mesh, std::span<const Triangle> triangles) {
    std::vector<glm::vec3> normals(mesh.normals.size());
    std::vector<glm::dvec3> substitutes;
    for (size_t i = 0; i < normals.size(); ++i) {
        glm::dvec3 normal(mesh.normals[i]);
        if (normal == glm::dvec3(0)) {
            if (substitutes.empty()) substitutes = substitute_normals(mesh, triangles);
            normal = substitutes[i];
        }
        // A vertex of no triangle is never drawn; the format still wants a direction there.
        normals[i] = normal == glm::dvec3(0) ? glm::vec3(0, 0, 1) : glm::vec3(glm::normalize(normal));
    }
    return normals;
}

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

/// Puts a scene into a model, part by part.
class GlbBuilder {
  public:
    GlbBuilder(const GlbScene& scene, const GlbInfo& info, std::span<const Triangle> triangles)
        : scene_(scene),
          reflectance_(scene.reflectance && !scene.reflectance->kd.empty() ? scene.reflectance : nullptr),
          parts_(parts_by_label(
              static_cast<uint32_t>(scene.mesh.positions_m.size()), triangles,
              reflectance_ ? std::span<const uint32_t>(reflectance_->labels) : std::span<const uint32_t>())) {
        add_root(info);
        if (triangles.empty()) {
            add_node(kSurface);
        } else {
            normals_ = unit_normals(scene.mesh, triangles);
            model_.buffers.resize(1);
            model_.buffers[0].data.reserve(buffer_bytes());
            for (const MeshPart& part : parts_) add_part(part);
        }
        for (const Light& light : scene.lights) add_light(light);
    }

    const tinygltf::Model& model() const { return model_; }
    const GlbSummary& summary() const { return summary_; }

  private:
    const SegmentReflectance& segment(uint32_t label) const {
        static const SegmentReflectance kNone;
        return label < reflectance_->segments.size() ? reflectance_->segments[label] : kNone;
    }

    bool has_gloss(const MeshPart& part) const { return reflectance_ && segment(part.label).gloss; }

    uint64_t buffer_bytes() const {
        std::vector<GlbPartSize> sizes;
        for (const MeshPart& part : parts_) {
            GlbPartSize size{part.vertices.size(), part.triangles.size()};
            if (reflectance_) size.vertex_bytes += sizeof(glm::vec3);
            if (has_gloss(part)) size.vertex_bytes += sizeof(glm::vec3) + sizeof(float);
            sizes.push_back(size);
        }
        return glb_buffer_bytes(sizes);
    }

    std::string name_of(uint32_t label) const {
        if (label == 0) return kSurface;
        const bool named = label < scene_.segment_names.size() && !scene_.segment_names[label].empty();
        return named ? scene_.segment_names[label] : "segment " + std::to_string(label);
    }

    void add_root(const GlbInfo& info) {
        const glm::dquat turn = glm::normalize(info.y_up_from_world);
        tinygltf::Node root;
        root.name = info.name;
        root.rotation = {turn.x, turn.y, turn.z, turn.w};
        if (info.world_offset_m != glm::dvec3(0))
            root.extras = Value(Value::Object{{"world_offset_m", array_of(info.world_offset_m)}});
        model_.nodes.push_back(std::move(root));
        tinygltf::Scene scene;
        scene.name = info.name;
        scene.nodes = {0};
        model_.scenes.push_back(std::move(scene));
        model_.defaultScene = 0;
        model_.asset.version = "2.0";
        model_.asset.generator = "Patina " + info.version;
    }

    /// Below the root.
    tinygltf::Node& add_node(const std::string& name) {
        model_.nodes.front().children.push_back(static_cast<int>(model_.nodes.size()));
        tinygltf::Node& node = model_.nodes.emplace_back();
        node.name = name;
        return node;
    }

    void use_extension(const char* name) {
        auto& used = model_.extensionsUsed;
        if (std::ranges::find(used, name) == used.end()) used.emplace_back(name);
    }

    void add_part(const MeshPart& part) {
        tinygltf::Primitive primitive;
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
        primitive.material = static_cast<int>(model_.materials.size());
        primitive.attributes["POSITION"] = add_positions(model_, gathered(scene_.mesh.positions_m, part));
        primitive.attributes["NORMAL"] = add_vertices(model_, "NORMAL", gathered(normals_, part));
        tinygltf::Material material;
        material.name = name_of(part.label);
        material.pbrMetallicRoughness.metallicFactor = 0;
        material.pbrMetallicRoughness.roughnessFactor = 1;
        if (reflectance_) {
            add_reflectance(part, primitive, material);
        } else {
            add_colors(primitive, gathered(scene_.mesh.colors, part));
        }
        primitive.indices = add_indices(model_, part.triangles, part.vertices.size());
        model_.materials.push_back(std::move(material));

        add_node(name_of(part.label)).mesh = static_cast<int>(model_.meshes.size());
        tinygltf::Mesh mesh;
        mesh.name = name_of(part.label);
        mesh.primitives.push_back(std::move(primitive));
        model_.meshes.push_back(std::move(mesh));
        summary_.vertices += part.vertices.size();
        summary_.triangles += part.triangles.size();
    }

    void add_colors(tinygltf::Primitive& primitive, const std::vector<glm::vec3>& linear) {
        std::vector<GltfColor> colors(linear.size());
        std::ranges::transform(linear, colors.begin(), encode);
        primitive.attributes["COLOR_0"] = add_vertices(model_, "COLOR_0", colors);
        summary_.clamped_colors += static_cast<uint64_t>(std::ranges::count_if(linear, std::not_fn(displayable)));
    }

    std::vector<glm::vec3> albedo_of(const MeshPart& part) {
        const auto& mean = segment(part.label).kd;
        std::vector<glm::vec3> albedo;
        albedo.reserve(part.vertices.size());
        for (const uint32_t vertex : part.vertices) {
            const glm::vec4 known = reflectance_->kd[vertex];
            summary_.unknown_albedo += known.a == 0 && !mean;
            const glm::vec3 fallback = mean ? *mean : glm::min(scene_.mesh.colors[vertex], 1.0f);
            albedo.push_back(known.a > 0 ? glm::vec3(known) : fallback);
        }
        return albedo;
    }

    void add_reflectance(const MeshPart& part, tinygltf::Primitive& primitive, tinygltf::Material& material) {
        const SegmentReflectance& own = segment(part.label);
        const std::vector<glm::vec3> albedo = albedo_of(part);
        // A segment without a material has no highlight at all, which is what ks = 0 becomes.
        const GltfMaterial shown = gltf_material(own.gloss.value_or(WardGloss{}), own.kd.value_or(glm::vec3(1)));
        primitive.attributes["_KD"] = add_vertices(model_, "_KD", albedo);
        set_material(shown, material);
        if (!shown.metal) {
            std::vector<glm::vec3> base(albedo.size());
            std::ranges::transform(albedo, base.begin(), [&](glm::vec3 kd) { return base_color_of(shown, kd); });
            add_colors(primitive, base);
        }
        if (!own.gloss) return;
        const size_t count = part.vertices.size();
        primitive.attributes["_KS"] = add_vertices(model_, "_KS", std::vector<glm::vec3>(count, own.gloss->ks));
        primitive.attributes["_WARD_ALPHA"] =
            add_vertices(model_, "_WARD_ALPHA", std::vector<float>(count, own.gloss->alpha));
        material.extras = ward_extras(*own.gloss);
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
        const int index = static_cast<int>(model_.lights.size());
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
        model_.lights.push_back(std::move(lamp));
        use_extension(kLights);
    }

    const GlbScene& scene_;
    const MeshReflectance* reflectance_;
    std::vector<MeshPart> parts_;
    std::vector<glm::vec3> normals_;  ///< of the whole mesh, unit length
    tinygltf::Model model_;
    GlbSummary summary_;
};

void write_model(const std::filesystem::path& path, const tinygltf::Model& model) {
    constexpr bool kPretty = false, kBinary = true;
    sensor::NewFile file(path);
    sensor::NewFileStream bytes(file);
    std::ostream stream(&bytes);
    const bool written = tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, stream, kPretty, kBinary);
    bytes.expect_written();
    if (!written || !stream) throw Error(path, ": the scene cannot be written");
    file.close();
}

}  // namespace

uint64_t glb_buffer_bytes(std::span<const GlbPartSize> parts) {
    constexpr uint64_t kMost = std::numeric_limits<uint32_t>::max() - kJsonAllowance;
    uint64_t bytes = 0, vertices = 0, triangles = 0;
    for (const GlbPartSize& part : parts) {
        // Cut off at kMost, beyond which the answer is no and products would overflow.
        const uint64_t some_vertices = std::min(part.vertices, kMost), some_triangles = std::min(part.triangles, kMost);
        const uint64_t index_bytes = some_vertices <= kMostVerticesOfShortIndices ? 2 : 4;
        bytes += some_vertices * part.vertex_bytes + (some_triangles * 3 * index_bytes + 3) / 4 * 4;
        vertices += some_vertices;
        triangles += some_triangles;
    }
    if (bytes > kMost) {
        throw Error("a GLB file holds at most ", kMost, " bytes, but ", vertices, " vertices and ", triangles,
                    " triangles need ", bytes);
    }
    return bytes;
}

GlbSummary write_glb(const std::filesystem::path& path, const GlbScene& scene, const GlbInfo& info) {
    check_scene(path, scene);
    const std::vector<Triangle> triangles = drawable_triangles(scene.mesh);
    const GlbBuilder builder(scene, info, triangles);
    write_model(path, builder.model());
    GlbSummary summary = builder.summary();
    summary.degenerate_triangles = scene.mesh.triangles.size() - triangles.size();
    return summary;
}

}  // namespace patina
