#include "export/segment_names.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include "engine/core/luminance.h"
#include "engine/core/srgb.h"
#include "export/gltf_material.h"

namespace patina {

namespace {

constexpr double kFlat = 0.85;           // length of the sum of area vectors over the area
constexpr double kLeastShare = 0.05;     // of the surface
constexpr double kLeastArea_m2 = 1;      // or so much
constexpr double kFloorHeight_m = 0.15;  // floors of two rooms, and carpets
constexpr double kBehind_m = 0.15, kMostBehind = 0.1;
const double kTilt = std::sin(glm::radians(15.0));
constexpr float kGlossyAlpha = 0.25f, kGlossyF0 = 0.01f;

/// What the patches of a segment have in common.
struct Shape {
    double area_m2 = 0;
    glm::dvec3 sum_m2{0};     ///< of the area vectors
    glm::dvec3 moment_m3{0};  ///< of centres times areas

    void add(const Patch& patch) {
        const double own_m2 = glm::length(glm::dvec3(patch.area_m2));
        area_m2 += own_m2;
        sum_m2 += glm::dvec3(patch.area_m2);
        moment_m3 += own_m2 * glm::dvec3(patch.center_m);
    }
    bool flat() const { return area_m2 > 0 && glm::length(sum_m2) >= kFlat * area_m2; }
    glm::dvec3 normal() const { return glm::normalize(sum_m2); }
    glm::dvec3 center_m() const { return moment_m3 / area_m2; }
};

enum Kind { kFloor, kCeiling, kWall, kObject };
constexpr std::array kKindNames{"floor", "ceiling", "wall"};

class Surroundings {
  public:
    Surroundings(std::span<const Patch> patches, const Upright& upright, size_t segments)
        : patches_(patches), upright_(upright), shapes_(segments) {
        for (const Patch& patch : patches) {
            all_.add(patch);
            if (patch.label < segments) shapes_[patch.label].add(patch);
        }
    }
    double area_of(size_t label) const { return shapes_[label].area_m2; }

    Kind kind_of(size_t label) const {
        const Shape& shape = shapes_[label];
        if (!shape.flat() || shape.area_m2 < std::min(kLeastShare * all_.area_m2, kLeastArea_m2)) return kObject;
        const double up = glm::dot(shape.normal(), upright_.up());
        const double level = std::sqrt(1 - kTilt * kTilt);
        if (up >= level) return std::abs(upright_.height_of(shape.center_m())) <= kFloorHeight_m ? kFloor : kObject;
        if (std::abs(up) > kTilt && up > -level) return kObject;
        if (share_behind(shape) > kMostBehind) return kObject;
        return up <= -level ? kCeiling : kWall;
    }

  private:
    /// Of the surface, what lies behind a plane.
    double share_behind(const Shape& plane) const {
        const glm::dvec3 normal = plane.normal(), center_m = plane.center_m();
        double behind_m2 = 0;
        for (const Patch& patch : patches_) {
            if (glm::dot(glm::dvec3(patch.center_m) - center_m, normal) < -kBehind_m)
                behind_m2 += glm::length(glm::dvec3(patch.area_m2));
        }
        return behind_m2 / all_.area_m2;
    }

    std::span<const Patch> patches_;
    const Upright& upright_;
    std::vector<Shape> shapes_;
    Shape all_;
};

std::string gloss_name(const SegmentReflectance& segment) {
    if (!segment.gloss || !is_observed(*segment.gloss)) return "";
    const GltfMaterial material = gltf_material(*segment.gloss, segment.kd.value_or(glm::vec3(1)));
    if (material.metal) return "metal";
    const glm::vec3 f0 = f0_of(material);
    return std::max({f0.r, f0.g, f0.b}) >= kGlossyF0 && segment.gloss->alpha <= kGlossyAlpha ? "glossy" : "matt";
}

std::string object_name(size_t label, const SegmentReflectance& segment) {
    std::string name = "object " + std::to_string(label);
    const std::string gloss = gloss_name(segment);
    if (segment.kd && gloss != "metal") name += ", " + color_name(*segment.kd);
    return gloss.empty() ? name : name + ", " + gloss;
}

/// Of all kinds but objects, the labels from the largest on.
std::array<std::vector<size_t>, kObject> labels_by_kind(const Surroundings& surroundings, size_t segments) {
    std::array<std::vector<size_t>, kObject> labels;
    for (size_t label = 1; label < segments; ++label) {
        if (const Kind kind = surroundings.kind_of(label); kind != kObject) labels[kind].push_back(label);
    }
    for (auto& of_kind : labels) {
        std::ranges::stable_sort(of_kind, std::greater(), [&](size_t label) { return surroundings.area_of(label); });
    }
    return labels;
}

/// The hue's name, of a colour as sRGB encodes it; `hue` in degrees from red over green.
const char* hue_name(double hue) {
    constexpr std::pair<double, const char*> kEnds[] = {{16, "red"},   {42, "orange"}, {68, "yellow"},  {165, "green"},
                                                        {195, "cyan"}, {258, "blue"},  {292, "purple"}, {342, "pink"}};
    for (const auto& [end, name] : kEnds)
        if (hue < end) return name;
    return "red";
}

double hue_of(glm::dvec3 rgb, double chroma) {
    const double most = std::max({rgb.r, rgb.g, rgb.b});
    const double sixth = most == rgb.r   ? (rgb.g - rgb.b) / chroma
                         : most == rgb.g ? 2 + (rgb.b - rgb.r) / chroma
                                         : 4 + (rgb.r - rgb.g) / chroma;
    return sixth < 0 ? 60 * (sixth + 6) : 60 * sixth;
}

}  // namespace

std::string color_name(glm::vec3 linear) {
    const glm::dvec3 within = glm::clamp(glm::dvec3(linear), 0.0, 1.0);
    const glm::dvec3 rgb(srgb_encoded(within.r), srgb_encoded(within.g), srgb_encoded(within.b));
    const double most = std::max({rgb.r, rgb.g, rgb.b}), chroma = most - std::min({rgb.r, rgb.g, rgb.b});
    const double lightness = srgb_encoded(luminance(within));
    if (most < 0.15) return "black";
    if (chroma < 0.15 * most)
        return lightness < 0.25 ? "black" : lightness < 0.45 ? "dark grey" : lightness < 0.75 ? "grey" : "white";
    const std::string hue = hue_name(hue_of(rgb, chroma));
    if (hue == "orange" && lightness < 0.5) return "brown";
    if ((hue == "orange" || hue == "yellow") && chroma < 0.45 * most) return lightness < 0.5 ? "brown" : "beige";
    if (lightness < 0.25) return "dark " + hue;
    return chroma < 0.3 * most && lightness > 0.6 ? "pale " + hue : hue;
}

std::vector<std::string> names_of_segments(std::span<const SegmentReflectance> segments,
                                           std::span<const std::string> known, std::span<const Patch> patches,
                                           const Upright& upright) {
    std::vector<std::string> names(segments.size());
    for (size_t label = 1; label < segments.size(); ++label) names[label] = object_name(label, segments[label]);
    const auto labels = labels_by_kind(Surroundings(patches, upright, segments.size()), segments.size());
    for (size_t kind = 0; kind < labels.size(); ++kind) {
        const bool alone = labels[kind].size() == 1;
        for (size_t i = 0; i < labels[kind].size(); ++i)
            names[labels[kind][i]] = kKindNames[kind] + (alone ? "" : " " + std::to_string(i + 1));
    }
    std::set<std::string> used;
    for (size_t label = 1; label < segments.size(); ++label) {
        if (label < known.size() && !known[label].empty()) names[label] = known[label];
        if (!used.insert(names[label]).second) used.insert(names[label] += " (" + std::to_string(label) + ")");
    }
    return names;
}

}  // namespace patina
