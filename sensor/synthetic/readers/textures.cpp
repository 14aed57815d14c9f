#include "sensor/synthetic/readers/textures.h"

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sensor/synthetic/readers/values.h"
#include "sensor/synthetic/texture.h"

namespace patina::sensor {
namespace {

uint32_t read_count(const JsonValue& value) { return static_cast<uint32_t>(value.whole_number(UINT32_MAX)); }

glm::dvec2 read_pair(const JsonValue& value) {
    const std::vector<double> numbers = value.numbers(2);
    return {numbers[0], numbers[1]};
}

glm::uvec2 read_counts(const JsonValue& value) {
    if (!value.is_array()) return glm::uvec2(read_count(value));
    const std::vector<JsonValue> elements = value.elements();
    if (elements.size() != 2) value.fail("must be one count or two, across and down");
    return {read_count(elements[0]), read_count(elements[1])};
}

PatternSettings read_settings(const JsonValue& value) {
    value.expect_keys({"colors", "count", "seed", "size"});
    PatternSettings settings;
    for (const JsonValue& color : value.at("colors").elements()) settings.colors.emplace_back(read_rgb(color, 1));
    if (const auto count = value.find("count")) settings.count = read_counts(*count);
    if (const auto seed = value.find("seed")) settings.seed = read_count(*seed);
    if (const auto size = value.find("size")) settings.size_px = read_count(*size);
    return settings;
}

/// The picture that the member `kind` describes.
Image<glm::vec3> read_picture(const std::string& kind, const JsonValue& value) {
    return located(value, [&] {
        if (kind == "file") return read_texture(beside_file(value));
        return draw_pattern(pattern_named(kind), read_settings(value));
    });
}

/// The picture moved right and down by whole texels, what leaves it on one side entering on the other.
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

}  // namespace

Texture read_texture(const JsonValue& value) {
    std::vector<std::string_view> kinds(pattern_names().begin(), pattern_names().end());
    kinds.push_back("file");
    std::vector<std::string_view> keys = kinds;
    keys.insert(keys.end(), {"repeat", "offset"});
    value.expect_keys(keys);
    const auto [kind, settings] = read_kind(value, kinds);
    Image<glm::vec3> picture = read_picture(kind, settings);
    Texture texture;
    const JsonValue repeat = value.at("repeat");
    texture.repeat = read_pair(repeat);
    if (!(std::min(texture.repeat.x, texture.repeat.y) > 0)) repeat.fail("must be two lengths above 0");
    if (const auto offset = value.find("offset")) {
        const glm::dvec2 parts = glm::fract(read_pair(*offset) / texture.repeat);
        picture = rolled(picture,
                         glm::ivec2(glm::round(parts * glm::dvec2(picture.extent().width, picture.extent().height))));
    }
    texture.kd = std::make_shared<const Image<glm::vec3>>(std::move(picture));
    return texture;
}

}  // namespace patina::sensor
