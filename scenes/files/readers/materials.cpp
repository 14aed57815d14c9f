#include "scenes/files/readers/materials.h"

#include <array>

#include "scenes/files/readers/textures.h"
#include "scenes/files/readers/values.h"

namespace patina::scenes {
namespace {

/// The names that a map has, for messages.
template <class Value>
std::string names_of(const std::map<std::string, Value>& map) {
    std::string names;
    for (const auto& [name, value] : map) names += (names.empty() ? "" : ", ") + name;
    return names.empty() ? "none" : names;
}

template <class Value>
const Value& named(const sensor::JsonValue& name, const char* kind, const std::map<std::string, Value>& map) {
    const auto found = map.find(name.string());
    if (found == map.end()) name.fail(text("must name one of the scene's ", kind, ": ", names_of(map)));
    return found->second;
}

/// A surface that reflects more than it receives is no material.
void check_albedo(const sensor::JsonValue& value, glm::dvec3 kd, glm::dvec3 ks) {
    constexpr std::array kChannels{"red", "green", "blue"};
    constexpr double kRounding = 1e-6;
    for (int c = 0; c < 3; ++c) {
        if (kd[c] + ks[c] <= 1 + kRounding) continue;
        throw Error(value.where(), ": kd + ks is ", kd[c], " + ", ks[c], " in ", kChannels[size_t(c)],
                    ", must be at most 1");
    }
}

/// By channel.
glm::dvec3 largest_kd(const Image<glm::vec3>& picture) {
    glm::vec3 largest(0);
    for (const glm::vec3 kd : picture.pixels()) largest = glm::max(largest, kd);
    return glm::dvec3(largest);
}

double read_alpha(const sensor::JsonValue& value) {
    const double alpha = value.number();
    if (!(alpha > 0 && alpha <= 1)) value.fail("must be above 0 and at most 1");
    return alpha;
}

}  // namespace

MaterialReader::MaterialReader(const sensor::JsonValue& root) {
    if (const auto textures = root.find("textures")) {
        for (const auto& [name, value] : textures->members()) {
            const Texture texture = read_texture(value);
            textures_.emplace(name, NamedTexture{texture, largest_kd(*texture.kd)});
        }
    }
    if (const auto materials = root.find("materials")) {
        for (const auto& [name, value] : materials->members()) materials_.emplace(name, read_inline(value));
    }
}

ObjectMaterial MaterialReader::read(const sensor::JsonValue& value) const {
    return value.is_string() ? named(value, "materials", materials_) : read_inline(value);
}

ObjectMaterial MaterialReader::read_inline(const sensor::JsonValue& value) const {
    value.expect_keys({"kd", "ks", "alpha"});
    ObjectMaterial result;
    glm::dvec3 most_kd(0);
    if (const sensor::JsonValue kd = value.at("kd"); kd.is_string()) {
        const NamedTexture& texture = named(kd, "textures", textures_);
        result.texture = texture.texture;
        most_kd = texture.largest_kd;
    } else {
        result.material.kd = most_kd = read_rgb(kd, 1);
    }
    result.material.ks = read_rgb(value.at("ks"), 1);
    result.material.alpha = read_alpha(value.at("alpha"));
    check_albedo(value, most_kd, result.material.ks);
    return result;
}

}  // namespace patina::scenes
