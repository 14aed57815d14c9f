#include "sensor/synthetic/readers/textures.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sensor/synthetic/readers/values.h"
#include "sensor/synthetic/texture.h"

namespace patina::sensor {
namespace {

constexpr uint64_t kLargestPicture_px = 4096;

Image<glm::vec3> read_pattern(const std::string& name, const JsonValue& value) {
    value.expect_keys({"colors", "count", "seed", "size"});
    PatternSettings settings;
    for (const JsonValue& color : value.at("colors").elements()) settings.colors.emplace_back(read_rgb(color, 1));
    if (const auto count = value.find("count")) {
        const std::vector<JsonValue> elements = count->elements_of(2);
        settings.count = {elements[0].positive_integer(), elements[1].positive_integer()};
    }
    if (const auto seed = value.find("seed")) settings.seed = static_cast<uint32_t>(seed->whole_number(UINT32_MAX));
    if (const auto size = value.find("size")) {
        size->positive_integer();
        settings.size_px = static_cast<uint32_t>(size->whole_number(kLargestPicture_px));
    }
    return located(value, [&] { return draw_pattern(pattern_named(name), settings); });
}

Image<glm::vec3> read_file(const JsonValue& name) {
    const std::filesystem::path file = beside_file(name);
    return located(name, [&] { return read_texture(file); });
}

}  // namespace

Texture read_texture(const JsonValue& value) {
    std::vector<std::string> kinds = pattern_names();
    kinds.emplace_back("file");
    const auto [kind, source] = read_kind(value, kinds, {"repeat"});
    Texture texture;
    texture.kd =
        std::make_shared<const Image<glm::vec3>>(kind == "file" ? read_file(source) : read_pattern(kind, source));
    if (const auto repeat = value.find("repeat")) {
        const std::vector<JsonValue> elements = repeat->elements_of(2);
        texture.repeat = {read_positive(elements[0]), read_positive(elements[1])};
    }
    return texture;
}

}  // namespace patina::sensor
