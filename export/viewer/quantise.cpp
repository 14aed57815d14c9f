#include "export/viewer/quantise.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/core/error.h"
#include "engine/core/srgb.h"

namespace patina {

namespace {

uint16_t code_of(float part) { return static_cast<uint16_t>(std::lround(std::clamp(part, 0.0f, 1.0f) * 65535)); }

/// Cigolle et al., "A survey of efficient representations for independent unit vectors", 2014.
std::array<int16_t, 2> octahedral(glm::vec3 normal) {
    normal /= std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
    glm::vec2 folded(normal);
    if (normal.z < 0) {
        const glm::vec2 sign(normal.x < 0 ? -1.0f : 1.0f, normal.y < 0 ? -1.0f : 1.0f);
        folded = (1.0f - glm::abs(glm::vec2(normal.y, normal.x))) * sign;
    }
    const auto code = [](float v) { return static_cast<int16_t>(std::lround(std::clamp(v, -1.0f, 1.0f) * 32767)); };
    return {code(folded.x), code(folded.y)};
}

std::array<uint16_t, 2> color_codes(glm::vec3 linear) {
    const auto code = [](float v) {
        return static_cast<uint16_t>(std::lround(255 * srgb_encoded(double{std::clamp(v, 0.0f, 1.0f)})));
    };
    return {static_cast<uint16_t>(code(linear.r) << 8 | code(linear.g)), static_cast<uint16_t>(code(linear.b) << 8)};
}

void append(const ScenePart& part, const std::array<glm::vec3, 2>& box, ViewerGroup& group) {
    const auto first = static_cast<uint32_t>(group.vertices.size());
    const glm::vec3 size = glm::max(box[1] - box[0], glm::vec3(1e-6f));
    for (size_t i = 0; i < part.positions_m.size(); ++i) {
        const glm::vec3 at = (part.positions_m[i] - box[0]) / size;
        ViewerVertex vertex{{code_of(at.x), code_of(at.y), code_of(at.z)}, static_cast<uint16_t>(part.material)};
        vertex.normal = octahedral(part.normals[i]);
        vertex.look = part.places.empty()
                          ? color_codes(part.base[i])
                          : std::array<uint16_t, 2>{code_of(part.places[i].x), code_of(part.places[i].y)};
        group.vertices.push_back(vertex);
    }
    for (const auto& [a, b, c] : part.triangles) group.triangles.push_back({first + a, first + b, first + c});
}

}  // namespace

std::vector<ViewerGroup> quantised(const SceneParts& scene) {
    if (scene.materials.size() > 65536)
        throw Error("the HTML viewer shows at most 65536 materials, the scene has ", scene.materials.size());
    const std::array<glm::vec3, 2> box = bounds_of(scene);
    std::map<uint32_t, ViewerGroup> by_page;
    for (const ScenePart& part : scene.parts) {
        ViewerGroup& group = by_page[part.page];
        group.page = part.page;
        append(part, box, group);
    }
    std::vector<ViewerGroup> groups;
    for (auto& [page, group] : by_page) groups.push_back(std::move(group));
    return groups;
}

}  // namespace patina
