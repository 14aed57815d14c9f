#include "export/write_glb.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include <glm/gtc/quaternion.hpp>
#include <tiny_gltf.h>

#include "engine/core/error.h"
#include "export/drawable_mesh.h"
#include "export/glb_extras.h"
#include "export/glb_file.h"
#include "export/gltf_arrays.h"
#include "export/gltf_material.h"
#include "export/mesh_parts.h"
#include "export/page_picture.h"

namespace patina {
namespace {

using Triangle = std::array<uint32_t, 3>;
using Value = tinygltf::Value;

constexpr const char* kSpecular = "KHR_materials_specular";
constexpr const char* kIor = "KHR_materials_ior";
constexpr const char* kLights = "KHR_lights_punctual";
constexpr double kInnerCosine = 0.75;  // of a spot that has the power of a flat lamp, and its intensity along the axis
constexpr const char* kSurface = "surface";

GltfColor encode(glm::vec3 linear) {
    const auto channel = [](float v) {
        return static_cast<uint16_t>(std::lround(std::clamp(v, 0.0f, 1.0f) * 65535.0f));
    };
    return {channel(linear.r), channel(linear.g), channel(linear.b), 65535};
}

bool displayable(glm::vec3 linear) { return linear == glm::clamp(linear, 0.0f, 1.0f); }

/// A mesh with what it reflects, and its normals.
struct Piece {
    const Mesh& mesh;
    const MeshReflectance* reflectance;  ///< null: it has colours alone
    std::vector<glm::vec3> normals;      ///< unit length
    // Where it lies in a texture; null: in none.
    const std::vector<glm::vec2>* places_px = nullptr;  ///< by vertex
    const std::vector<Extent2D>* pages = nullptr;
    std::span<const uint8_t> filled{};                 ///< by vertex; empty: nothing is
    const std::vector<glm::vec4>* tangents = nullptr;  ///< by vertex; null where the texture has no detail

    const SegmentReflectance& segment(uint32_t label) const {
        static const SegmentReflectance kNone;
        return label < reflectance->segments.size() ? reflectance->segments[label] : kNone;
    }
};

}  // namespace

struct GlbWriter::State {
    static constexpr uint32_t kNoPage = UINT32_MAX;

    /// What becomes a node with a mesh and materials: one for each page of the texture that it lies in.
    struct Segment {
        tinygltf::Material material;
        float base_over_kd = 1;
        std::map<uint32_t, std::vector<tinygltf::Primitive>> primitives;  ///< by page; kNoPage: in none
    };

    State(const std::filesystem::path& at, const GlbOptions& how) : path(at), options(how), file(at) {}

    /// `page`: of the texture; kNoPage: the piece lies in none.
    void add(const Piece& piece, const MeshPart& part, uint32_t page);
    void add_textured(const TexturedSurface& surface, const std::vector<Extent2D>& extents, bool has_detail);
    void add_page(const TextureLayout& layout, const TexturePage& page, uint32_t number);
    void add_detail(const Image<glm::vec3>& detail, uint32_t number);
    void add_seen(const Image<TexelState>& states, uint32_t number);
    GlbSummary finish(const GlbInfo& info);

    std::filesystem::path path;
    GlbOptions options;
    GlbFile file;
    tinygltf::Model model;
    GltfArrays arrays{model, file};
    std::map<uint32_t, Segment> segments;  ///< by label
    std::optional<int> first_detail;       ///< texture with the detail of the first page
    GlbSummary summary;

  private:
    static std::string name_of(uint32_t label, const GlbInfo& info) {
        if (label == 0) return kSurface;
        const bool named = label < info.segment_names.size() && !info.segment_names[label].empty();
        return named ? info.segment_names[label] : "object " + std::to_string(label);
    }

    void add_root(const GlbInfo& info) {
        const glm::dquat turn = glm::normalize(info.upright.y_up_from_world);
        tinygltf::Node root;
        root.name = info.name;
        root.rotation = {turn.x, turn.y, turn.z, turn.w};
        if (info.upright.floor_m != 0) root.translation = {0, -info.upright.floor_m, 0};
        if (info.world_offset_m != glm::dvec3(0))
            root.extras = Value(Value::Object{{"world_offset_m", array_of(info.world_offset_m)}});
        model.nodes.push_back(std::move(root));
        tinygltf::Scene scene;
        scene.name = info.name;
        scene.nodes = {0};
        scene.extras = scene_extras(info);
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

    /// The number of the segment's material for a page.
    int add_material(const std::string& name, const tinygltf::Material& material, uint32_t page) {
        tinygltf::Material& own = model.materials.emplace_back(material);
        own.name = page == kNoPage || page == 0 ? name : name + ", page " + std::to_string(page + 1);
        if (page != kNoPage) own.pbrMetallicRoughness.baseColorTexture.index = static_cast<int>(page);
        if (page != kNoPage && first_detail) own.normalTexture.index = *first_detail + static_cast<int>(page);
        return static_cast<int>(model.materials.size()) - 1;
    }

    void add_segment(uint32_t label, const std::string& name, Segment&& segment) {
        tinygltf::Node& node = add_node(name);
        node.mesh = static_cast<int>(model.meshes.size());
        if (label > 0) node.extras = Value(Value::Object{{"segment", Value(static_cast<int>(label))}});
        tinygltf::Mesh& mesh = model.meshes.emplace_back();
        mesh.name = name;
        for (auto& [page, primitives] : segment.primitives) {
            const int material = add_material(name, segment.material, page);
            for (tinygltf::Primitive& primitive : primitives) {
                primitive.material = material;
                mesh.primitives.push_back(std::move(primitive));
            }
        }
    }

    void set_look(const Piece& piece, uint32_t label, Segment& segment) {
        segment.material = material_of(piece, label);
        if (piece.reflectance) segment.base_over_kd = base_color_of(look_of(piece.segment(label)), glm::vec3(1)).r;
    }

    tinygltf::Material material_of(const Piece& piece, uint32_t label) {
        tinygltf::Material material;
        material.pbrMetallicRoughness.metallicFactor = 0;
        material.pbrMetallicRoughness.roughnessFactor = 1;
        if (!piece.reflectance) return material;
        const SegmentReflectance& own = piece.segment(label);
        const GltfMaterial look = look_of(own);
        set_material(look, material);
        material.extras = ward_extras(own, look.observed);
        return material;
    }

    /// A segment without a material has no highlight at all, which is what ks = 0 becomes.
    GltfMaterial look_of(const SegmentReflectance& segment) const {
        return gltf_material(segment.gloss.value_or(WardGloss{}), segment.kd.value_or(glm::vec3(1)), options.fresnel);
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

    void add_places(const Piece& piece, const MeshPart& part, uint32_t page, tinygltf::Primitive& primitive) {
        const Extent2D extent = piece.pages->at(page);
        std::vector<glm::vec2> places = gathered(*piece.places_px, part);
        for (glm::vec2& place : places) place /= glm::vec2(extent.width, extent.height);
        primitive.attributes["TEXCOORD_0"] = arrays.add_vertices("TEXCOORD_0", places);
        if (piece.tangents)
            primitive.attributes["TANGENT"] = arrays.add_vertices("TANGENT", gathered(*piece.tangents, part));
    }

    void add_reflectance(const Piece& piece, const MeshPart& part, tinygltf::Primitive& primitive) {
        const SegmentReflectance& own = piece.segment(part.label);
        const std::vector<glm::vec3> albedo = albedo_of(piece, part);
        const GltfMaterial shown = look_of(own);
        if (!shown.metal && !piece.places_px) {
            std::vector<glm::vec3> base(albedo.size());
            std::ranges::transform(albedo, base.begin(), [&](glm::vec3 kd) { return base_color_of(shown, kd); });
            add_colors(primitive, base);
        }
        if (options.raw_attributes) add_raw(own, albedo, primitive);
    }

    void add_raw(const SegmentReflectance& own, const std::vector<glm::vec3>& albedo, tinygltf::Primitive& primitive) {
        primitive.attributes["_KD"] = arrays.add_vertices("_KD", albedo);
        if (!own.gloss) return;
        const size_t count = albedo.size();
        primitive.attributes["_KS"] = arrays.add_vertices("_KS", std::vector<glm::vec3>(count, own.gloss->ks));
        primitive.attributes["_WARD_ALPHA"] =
            arrays.add_vertices("_WARD_ALPHA", std::vector<float>(count, own.gloss->alpha));
    }

    void add_filled(const Piece& piece, const MeshPart& part, tinygltf::Primitive& primitive) {
        if (piece.filled.empty()) return;
        PATINA_ASSERT(piece.filled.size() == piece.mesh.positions_m.size(), piece.filled.size(), " flags of ",
                      piece.mesh.positions_m.size(), " vertices");
        std::vector<float> filled;
        for (const uint32_t vertex : part.vertices) filled.push_back(piece.filled[vertex]);
        primitive.attributes["_FILLED"] = arrays.add_vertices("_FILLED", filled);
    }

    void set_material(const GltfMaterial& shown, tinygltf::Material& material) {
        tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
        pbr.roughnessFactor = double{shown.roughness};
        if (shown.metal) {
            pbr.metallicFactor = 1;
            pbr.baseColorFactor = {shown.base_color.r, shown.base_color.g, shown.base_color.b, 1};
            return;
        }
        if (needs_specular(shown)) {
            material.extensions[kSpecular] =
                Value(Value::Object{{"specularFactor", Value(double{shown.specular})},
                                    {"specularColorFactor", array_of(glm::dvec3(shown.specular_color))}});
            use_extension(kSpecular);
            if (shown.ior == GltfMaterial{}.ior) return;
        }
        material.extensions[kIor] = Value(Value::Object{{"ior", Value(double{shown.ior})}});
        use_extension(kIor);
    }

    void add_light(const Light& light, double candela_per_intensity) {
        const double strongest = std::max({light.intensity.r, light.intensity.g, light.intensity.b});
        const glm::dvec3 color = strongest > 0 ? light.intensity / strongest : glm::dvec3(1);
        const int index = static_cast<int>(model.lights.size());
        tinygltf::Light lamp;
        lamp.name = "light " + std::to_string(index + 1);
        lamp.type = is_flat(light) ? "spot" : "point";
        if (is_flat(light)) {
            lamp.spot.innerConeAngle = std::acos(kInnerCosine);
            lamp.spot.outerConeAngle = std::numbers::pi / 2;
        }
        lamp.color = {color.r, color.g, color.b};
        lamp.intensity = strongest * candela_per_intensity;
        Value::Object extras{{"calibrated", Value(false)}};
        if (light.radius_m > 0) extras["radius_m"] = Value(light.radius_m);
        lamp.extras = Value(std::move(extras));
        tinygltf::Node& node = add_node(lamp.name);
        node.translation = {light.position_m.x, light.position_m.y, light.position_m.z};
        if (is_flat(light)) {
            const glm::dquat turn(glm::dvec3(0, 0, -1), glm::normalize(light.axis));
            node.rotation = {turn.x, turn.y, turn.z, turn.w};
        }
        node.extensions[kLights] = Value(Value::Object{{"light", Value(index)}});
        model.lights.push_back(std::move(lamp));
        use_extension(kLights);
    }
};

void GlbWriter::State::add(const Piece& piece, const MeshPart& part, uint32_t page) {
    const auto [segment, is_new] = segments.try_emplace(part.label);
    if (is_new) set_look(piece, part.label, segment->second);
    const bool metal = segment->second.material.pbrMetallicRoughness.metallicFactor == 1;
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.attributes["POSITION"] = arrays.add_positions(gathered(piece.mesh.positions_m, part));
    primitive.attributes["NORMAL"] = arrays.add_vertices("NORMAL", gathered(piece.normals, part));
    if (metal) page = kNoPage;  // it has one colour
    if (page != kNoPage) add_places(piece, part, page, primitive);
    if (piece.reflectance) {
        add_reflectance(piece, part, primitive);
    } else if (page == kNoPage) {
        add_colors(primitive, gathered(piece.mesh.colors, part));
    }
    if (options.raw_attributes) add_filled(piece, part, primitive);
    primitive.indices = arrays.add_indices(part.triangles, part.vertices.size());
    segment->second.primitives[page].push_back(std::move(primitive));
    summary.vertices += part.vertices.size();
    summary.triangles += part.triangles.size();
}

void GlbWriter::State::add_page(const TextureLayout& layout, const TexturePage& page, uint32_t number) {
    const auto factor_of = [this](uint32_t label) {
        const auto segment = segments.find(label);
        return segment == segments.end() ? 1.0f : segment->second.base_over_kd;
    };
    const PagePicture shown = page_picture(page, layout.boxes, number, factor_of);
    const EncodedPicture picture = encoded(shown.picture);
    const auto seen = static_cast<uint64_t>(std::ranges::count(page.states.pixels(), TexelState::kSeen));
    const auto filled = static_cast<uint64_t>(std::ranges::count(page.states.pixels(), TexelState::kFilled));
    tinygltf::Image image;
    image.name = "base color, page " + std::to_string(number + 1);
    image.mimeType = picture.mime_type;
    image.bufferView = arrays.add_bytes(image.name.c_str(), std::as_bytes(std::span(picture.bytes)));
    const double share = static_cast<double>(seen) / static_cast<double>(std::max<uint64_t>(seen + filled, 1));
    image.extras = Value(Value::Object{{"texel_m", Value(layout.texel_m)}, {"seen", Value(share)}});
    tinygltf::Texture texture;
    texture.source = static_cast<int>(model.images.size());
    texture.sampler = 0;
    model.images.push_back(std::move(image));
    model.textures.push_back(std::move(texture));
    summary.seen_texels += seen;
    summary.filled_texels += filled;
    summary.clamped_texels += shown.clamped;
}

void GlbWriter::State::add_detail(const Image<glm::vec3>& detail, uint32_t number) {
    const EncodedPicture picture = encoded_as_png(detail_picture(detail));
    tinygltf::Image image;
    image.name = "detail, page " + std::to_string(number + 1);
    image.mimeType = picture.mime_type;
    image.bufferView = arrays.add_bytes(image.name.c_str(), std::as_bytes(std::span(picture.bytes)));
    tinygltf::Texture texture;
    texture.source = static_cast<int>(model.images.size());
    texture.sampler = 0;
    if (!first_detail) first_detail = static_cast<int>(model.textures.size());
    model.images.push_back(std::move(image));
    model.textures.push_back(std::move(texture));
}

/// No material shows it: extras of the page's picture name it.
void GlbWriter::State::add_seen(const Image<TexelState>& states, uint32_t number) {
    const EncodedPicture picture = seen_mask(states);
    tinygltf::Image image;
    image.name = "seen, page " + std::to_string(number + 1);
    image.mimeType = picture.mime_type;
    image.bufferView = arrays.add_bytes(image.name.c_str(), std::as_bytes(std::span(picture.bytes)));
    auto extras = model.images[number].extras.Get<Value::Object>();
    extras["seen_image"] = Value(static_cast<int>(model.images.size()));
    model.images[number].extras = Value(std::move(extras));
    model.images.push_back(std::move(image));
}

/// A triangle's vertices are of one segment and in one page.
void GlbWriter::State::add_textured(const TexturedSurface& surface, const std::vector<Extent2D>& extents,
                                    bool has_detail) {
    const MeshReflectance* reflectance = surface.reflectance.kd.empty() ? nullptr : &surface.reflectance;
    check_mesh(path, surface.mesh);
    if (reflectance) check_reflectance(path, surface.mesh, *reflectance);
    const std::vector<Triangle> triangles = drawable_triangles(surface.mesh);
    summary.degenerate_triangles += surface.mesh.triangles.size() - triangles.size();
    if (triangles.empty()) return;
    const Piece piece{surface.mesh, reflectance,    unit_normals(surface.mesh, triangles),   &surface.place_px,
                      &extents,     surface.filled, has_detail ? &surface.tangents : nullptr};
    const auto count = static_cast<uint32_t>(extents.size());
    std::vector<uint32_t> places;
    for (size_t i = 0; i < surface.pages.size(); ++i)
        places.push_back((reflectance ? reflectance->labels[i] : 0) * count + surface.pages[i]);
    for (MeshPart& part : parts_by_label(static_cast<uint32_t>(places.size()), triangles, places)) {
        const uint32_t page = part.label % count;
        part.label /= count;
        add(piece, part, page);
    }
}

GlbSummary GlbWriter::State::finish(const GlbInfo& info) {
    add_root(info);
    if (segments.empty()) add_node(kSurface);
    for (auto& [label, segment] : segments) add_segment(label, name_of(label, info), std::move(segment));
    for (const Light& light : info.lights) add_light(light, info.candela_per_intensity);
    file.finish(model);
    return summary;
}

GlbWriter::GlbWriter(const std::filesystem::path& path, const GlbOptions& options)
    : state_(std::make_unique<State>(path, options)) {}

GlbWriter::~GlbWriter() = default;

void GlbWriter::add(const Mesh& mesh, const MeshReflectance* reflectance, std::span<const uint8_t> filled) {
    if (reflectance && reflectance->kd.empty()) reflectance = nullptr;
    check_mesh(state_->path, mesh);
    if (reflectance) check_reflectance(state_->path, mesh, *reflectance);
    const std::vector<Triangle> triangles = drawable_triangles(mesh);
    state_->summary.degenerate_triangles += mesh.triangles.size() - triangles.size();
    if (triangles.empty()) return;
    const Piece piece{mesh, reflectance, unit_normals(mesh, triangles), nullptr, nullptr, filled};
    const std::span<const uint32_t> labels =
        reflectance ? std::span<const uint32_t>(reflectance->labels) : std::span<const uint32_t>();
    for (const MeshPart& part : parts_by_label(static_cast<uint32_t>(mesh.positions_m.size()), triangles, labels))
        state_->add(piece, part, State::kNoPage);
}

void GlbWriter::add_textured(const TextureLayout& layout, const std::vector<TexturePage>& pages) {
    const auto has_detail = [](const TexturePage& page) { return page.detail.extent().area() > 0; };
    const bool detailed = !pages.empty() && std::ranges::all_of(pages, has_detail);
    for (const TexturedSurface& surface : layout.pieces) state_->add_textured(surface, layout.pages, detailed);
    if (pages.empty()) return;
    tinygltf::Sampler sampler;
    sampler.minFilter = TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
    sampler.magFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
    sampler.wrapS = sampler.wrapT = TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    state_->model.samplers.push_back(std::move(sampler));
    for (uint32_t number = 0; number < pages.size(); ++number) state_->add_page(layout, pages[number], number);
    for (uint32_t number = 0; detailed && number < pages.size(); ++number)
        state_->add_detail(pages[number].detail, number);
    for (uint32_t number = 0; number < pages.size(); ++number) {
        const auto& states = pages[number].states;
        if (std::ranges::count(states.pixels(), TexelState::kFilled) > 0) state_->add_seen(states, number);
    }
    state_->summary.texture_pages = pages.size();
    state_->summary.detail_pages = detailed ? pages.size() : 0;
    state_->summary.texel_m = layout.texel_m;
}

GlbSummary GlbWriter::finish(const GlbInfo& info) { return state_->finish(info); }

GlbSummary write_glb(const std::filesystem::path& path, const GlbScene& scene, const GlbInfo& info,
                     const GlbOptions& options) {
    GlbWriter writer(path, options);
    writer.add(scene.mesh, scene.reflectance);
    return writer.finish(info);
}

}  // namespace patina
