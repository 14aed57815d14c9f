#include "export/viewer/write_viewer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "export/fewer_triangles.h"
#include "export/html.h"
#include "export/viewer/quantise.h"
#include "export/viewer/viewer_text.h"

namespace patina {

namespace {

using Json = nlohmann::ordered_json;

constexpr uint64_t kMostTriangles = 150'000;
constexpr int kPageQuality = 85;
constexpr uint32_t kLeastPage = 256;  // texels along an edge

constexpr uint64_t base64_bytes(uint64_t bytes) { return (bytes + 2) / 3 * 4; }

std::string replaced(std::string_view text, const std::vector<std::pair<std::string_view, std::string>>& values) {
    std::string result;
    while (!text.empty()) {
        const size_t open = text.find("{{"), close = text.find("}}", open);
        result += text.substr(0, open);
        if (close == std::string_view::npos) break;
        const std::string_view name = text.substr(open + 2, close - open - 2);
        const auto value = std::ranges::find(values, name, [](const auto& pair) { return pair.first; });
        PATINA_ASSERT(value != values.end(), "the page asks for '", name, "'");
        result += value->second;
        text.remove_prefix(close + 2);
    }
    return result;
}

template <class Vector>
Json list_of(const Vector& v) {
    return Json::array({v.x, v.y, v.z});
}

Json material_json(const PartMaterial& material) {
    Json json{{"name", material.name.empty() ? "surface" : material.name},
              {"label", material.label},
              {"kdOverBase", material.kd_over_base()},
              {"reflects", material.has_reflectance},
              {"observed", material.observed}};
    if (material.gloss) {
        json["ks"] = list_of(material.gloss->ks);
        json["alpha"] = material.gloss->alpha;
    }
    return json;
}

/// Where to look from at first: at the middle of the surface, in front of one that faces one way, else from above a
/// corner; so near that pieces far off need not be in sight.
Json start_json(const SceneParts& scene) {
    constexpr double kOneWay = 0.2;  // of the whole area
    constexpr double kSpread = 3.2;  // of the surface's root mean square: the whole of a closed room is in sight
    glm::dvec3 facing(0), sum_m(0);
    double area = 0, squares_m2 = 0;
    for (const ScenePart& part : scene.parts) {
        for (const auto& [a, b, c] : part.triangles) {
            const glm::dvec3 corner_m(part.positions_m[a]), second_m(part.positions_m[b]), third_m(part.positions_m[c]);
            const glm::dvec3 own = glm::cross(second_m - corner_m, third_m - corner_m);
            const glm::dvec3 center_m = (corner_m + second_m + third_m) / 3.0;
            facing += own;
            area += glm::length(own);
            sum_m += glm::length(own) * center_m;
            squares_m2 += glm::length(own) * glm::dot(center_m, center_m);
        }
    }
    Json start{{"yaw", 0.7}, {"pitch", 0.6}};
    if (area == 0) return start;
    const glm::dvec3 middle_m = sum_m / area;
    const auto [low, high] = bounds_of(scene);
    const double spread_m = std::sqrt(std::max(squares_m2 / area - glm::dot(middle_m, middle_m), 0.0));
    start["target"] = list_of(middle_m);
    start["distance"] = std::max(std::min(kSpread * spread_m, 0.9 * double{glm::distance(low, high)}), 1e-3);
    if (std::hypot(facing.x, facing.z) >= kOneWay * area) {
        start["yaw"] = std::atan2(facing.x, facing.z);
        start["pitch"] = 0.3;
    }
    return start;
}

/// Vertices and indices of all groups, one after the other; the machine's byte order is WebGL's.
struct Arrays {
    std::string bytes;
    Json groups = Json::array();
};

template <class Element>
size_t append(std::string& bytes, const std::vector<Element>& elements) {
    const size_t first = bytes.size();
    bytes.append(reinterpret_cast<const char*>(elements.data()), elements.size() * sizeof(Element));
    return first;
}

Arrays arrays_of(const std::vector<ViewerGroup>& groups) {
    Arrays arrays;
    for (const ViewerGroup& group : groups) {
        Json json{{"page", group.page == ScenePart::kNoPage ? Json() : Json(group.page)}};
        json["vertices"] = append(arrays.bytes, group.vertices);
        json["triangles"] = append(arrays.bytes, group.triangles);
        json["end"] = arrays.bytes.size();
        arrays.groups.push_back(std::move(json));
    }
    return arrays;
}

/// Pages as JPEG, at half the resolution again and again until they fit.
std::vector<EncodedPicture> fitted_pages(const std::vector<EncodedPicture>& pages, uint64_t most_bytes) {
    std::vector<EncodedPicture> fitted;
    std::vector<Image<SrgbPixel>> pictures;
    for (const EncodedPicture& page : pages) pictures.push_back(decoded(page));
    for (;;) {
        fitted.clear();
        uint64_t bytes = 0;
        uint32_t widest = 0;
        for (const Image<SrgbPixel>& picture : pictures) {
            fitted.push_back(encoded_as_jpeg(picture, kPageQuality));
            bytes += base64_bytes(fitted.back().bytes.size()) + 100;
            widest = std::max({widest, picture.extent().width, picture.extent().height});
        }
        if (bytes <= most_bytes || widest <= kLeastPage) return fitted;
        for (Image<SrgbPixel>& picture : pictures) {
            if (2 * std::max(picture.extent().width, picture.extent().height) > widest) picture = halved(picture);
        }
    }
}

std::string script_element(const char* type, const std::string& id, std::string_view more, std::string_view text) {
    return fmt::format("<script type=\"{}\" id=\"{}\"{}>{}</script>\n", type, id, more, text);
}

std::string pages_html(const std::vector<EncodedPicture>& pages) {
    std::string html;
    for (size_t i = 0; i < pages.size(); ++i) {
        const std::string_view bytes(reinterpret_cast<const char*>(pages[i].bytes.data()), pages[i].bytes.size());
        html += script_element("text/plain", fmt::format("page-{}", i),
                               fmt::format(" data-mime=\"{}\"", pages[i].mime_type), base64(bytes));
    }
    return html;
}

std::string shaders_html() {
    std::string fragment(viewer::kSurfaceFragment);
    constexpr std::string_view kPlace = "// WARD\n";
    fragment.replace(fragment.find(kPlace), kPlace.size(), viewer::kWard);
    return script_element("x-shader", "surface.vert", "", viewer::kSurfaceVertex) +
           script_element("x-shader", "surface.frag", "", fragment) +
           script_element("x-shader", "lamp.vert", "", viewer::kLampVertex) +
           script_element("x-shader", "lamp.frag", "", viewer::kLampFragment);
}

Json scene_json(const SceneParts& scene) {
    const auto [low, high] = bounds_of(scene);
    Json json{
        {"name", scene.name}, {"low", list_of(low)}, {"high", list_of(high)}, {"ambient", list_of(scene.ambient)}};
    json["materials"] = Json::array();
    for (const PartMaterial& material : scene.materials) json["materials"].push_back(material_json(material));
    json["lights"] = Json::array();
    for (const Light& light : scene.lights)
        json["lights"].push_back({{"position", list_of(light.position_m)},
                                  {"intensity", list_of(light.intensity)},
                                  {"axis", list_of(light.axis)}});
    json["start"] = start_json(scene);
    return json;
}

/// JSON within a script element: no "</" ends it.
std::string embedded(const Json& json) {
    std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    for (size_t at = text.find("</"); at != std::string::npos; at = text.find("</", at + 3)) text.insert(at + 1, "\\");
    return text;
}

/// Not more than half of the file, where there are pages too.
Arrays fitted_arrays(const SceneParts& scene, uint64_t most_bytes) {
    uint64_t triangles = std::min(scene.triangles(), kMostTriangles);
    for (int attempt = 0;; ++attempt) {
        Arrays arrays = arrays_of(quantised(with_fewer_triangles(scene, triangles)));
        if (base64_bytes(arrays.bytes.size()) <= most_bytes || attempt == 3) return arrays;
        triangles /= 2;
    }
}

}  // namespace

std::string viewer_html(const SceneParts& scene, const ViewerOptions& options) {
    const uint64_t text_bytes = viewer::kPage.size() + viewer::kStyle.size() + viewer::kScript.size();
    Json json = scene_json(scene);
    const std::string shaders = shaders_html();
    const uint64_t fixed = text_bytes + shaders.size() + json.dump().size() + 4096;
    const uint64_t room = options.most_bytes - std::min(fixed, options.most_bytes);
    const Arrays arrays = fitted_arrays(scene, scene.pages.empty() ? room : room * 6 / 10);
    json["groups"] = arrays.groups;
    const uint64_t left = room - std::min(base64_bytes(arrays.bytes.size()), room);
    const std::string pages = pages_html(fitted_pages(scene.pages, left));
    std::string html = replaced(viewer::kPage, {{"title", html_escaped(scene.name)},
                                                {"style", std::string(viewer::kStyle)},
                                                {"scene", embedded(json)},
                                                {"arrays", base64(arrays.bytes)},
                                                {"pages", pages},
                                                {"shaders", shaders},
                                                {"script", std::string(viewer::kScript)}});
    if (html.size() > options.most_bytes)
        throw Error("the HTML file would have ", html.size(), " bytes, at most ", options.most_bytes,
                    " are wanted; write scene.glb with fewer triangles (--triangles)");
    return html;
}

}  // namespace patina
