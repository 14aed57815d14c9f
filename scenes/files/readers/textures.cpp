#include "scenes/files/readers/textures.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "scenes/description/texture.h"
#include "scenes/files/readers/values.h"

namespace patina::scenes {
namespace {

constexpr uint64_t kLargestPicture_px = 4096;

Image<glm::vec3> read_pattern(const std::string& name, const sensor::JsonValue& value) {
    value.expect_keys({"colors", "count", "seed", "size"});
    PatternSettings settings;
    for (const sensor::JsonValue& color : value.at("colors").elements())
        settings.colors.emplace_back(read_rgb(color, 1));
    if (const auto count = value.find("count")) {
        const std::vector<sensor::JsonValue> elements = count->elements_of(2);
        settings.count = {elements[0].positive_integer(), elements[1].positive_integer()};
    }
    if (const auto seed = value.find("seed")) settings.seed = static_cast<uint32_t>(seed->whole_number(UINT32_MAX));
    if (const auto size = value.find("size")) {
        size->positive_integer();
        settings.size_px = static_cast<uint32_t>(size->whole_number(kLargestPicture_px));
    }
    return located(value, [&] { return draw_pattern(pattern_named(name), settings); });
}

/// The picture moved right and down by whole texels; what leaves it on one side enters on the other.
Image<glm::vec3> rolled(const Image<glm::vec3>& picture, glm::ivec2 by) {
    const glm::ivec2 size(picture.extent().width, picture.extent().height);
    Image<glm::vec3> moved(picture.extent());
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const glm::uvec2 to((glm::ivec2(x, y) + by) % size);
            moved.at(to.x, to.y) = picture.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
        }
    }
    return moved;
}

/// The picture with its top left corner at `offset` in (u, v), to the nearest texel.
Image<glm::vec3> with_offset(const Image<glm::vec3>& picture, glm::dvec2 offset, glm::dvec2 repeat) {
    const glm::dvec2 texels = glm::fract(offset / repeat) * glm::dvec2(picture.extent().width, picture.extent().height);
    return rolled(picture, glm::ivec2(glm::round(texels)));
}

Image<glm::vec3> read_texture_file(const sensor::JsonValue& name) {
    const std::filesystem::path file = beside_file(name);
    return located(name, [&] { return read_texture(file); });
}

}  // namespace

Texture read_texture(const sensor::JsonValue& value) {
    std::vector<std::string> kinds = pattern_names();
    kinds.emplace_back("file");
    const auto [kind, source] = read_kind(value, kinds, {"repeat", "offset"});
    Texture texture;
    Image<glm::vec3> picture = kind == "file" ? read_texture_file(source) : read_pattern(kind, source);
    if (const auto repeat = value.find("repeat")) {
        const std::vector<sensor::JsonValue> elements = repeat->elements_of(2);
        texture.repeat = {read_positive(elements[0]), read_positive(elements[1])};
    }
    if (const auto offset = value.find("offset")) {
        const std::vector<sensor::JsonValue> elements = offset->elements_of(2);
        const auto at = [&](size_t i) { return elements[i].number_within(-kLargestValue, kLargestValue); };
        picture = with_offset(picture, {at(0), at(1)}, texture.repeat);
    }
    texture.kd = std::make_shared<const Image<glm::vec3>>(std::move(picture));
    return texture;
}

}  // namespace patina::scenes
