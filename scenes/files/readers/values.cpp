#include "scenes/files/readers/values.h"

#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include "engine/core/error.h"
#include "scenes/description/path.h"

namespace patina::scenes {
namespace {

RigidTransform read_rotation(const sensor::JsonValue& value) {
    value.expect_keys({"axis", "degrees"});
    return placed(glm::dvec3(0), read_direction(value.at("axis")), read_degrees(value.at("degrees")));
}

}  // namespace

glm::dvec3 read_vector(const sensor::JsonValue& value) {
    const std::vector<sensor::JsonValue> elements = value.elements_of(3);
    glm::dvec3 vector(0);
    for (int i = 0; i < 3; ++i) vector[i] = elements[size_t(i)].number_within(-kLargestValue, kLargestValue);
    return vector;
}

glm::dvec3 read_direction(const sensor::JsonValue& value) {
    const glm::dvec3 direction = read_vector(value);
    if (!(glm::length(direction) > 1e-12)) value.fail("must not be zero");
    return glm::normalize(direction);
}

double read_positive(const sensor::JsonValue& value) {
    value.positive();
    return value.number_within(0, kLargestValue);
}

glm::dvec3 read_rgb(const sensor::JsonValue& value, double most) {
    if (!value.is_array()) return glm::dvec3(value.number_within(0, most));
    const std::vector<sensor::JsonValue> elements = value.elements_of(3);
    glm::dvec3 rgb(0);
    for (int i = 0; i < 3; ++i) rgb[i] = elements[size_t(i)].number_within(0, most);
    return rgb;
}

double read_degrees(const sensor::JsonValue& value) {
    return glm::radians(value.number_within(-kLargestValue, kLargestValue));
}

RigidTransform read_placement(const sensor::JsonValue& value) {
    RigidTransform placement(1.0);
    if (const auto position = value.find("position")) placement = glm::translate(placement, read_vector(*position));
    if (const auto rotations = value.find("rotations")) {
        for (const sensor::JsonValue& rotation : rotations->elements()) placement = placement * read_rotation(rotation);
    }
    return placement;
}

std::filesystem::path beside_file(const sensor::JsonValue& name) {
    if (name.string().empty()) name.fail("must name a file");
    return std::filesystem::path(name.file()).parent_path() / name.string();
}

std::pair<std::string, sensor::JsonValue> read_kind(const sensor::JsonValue& value,
                                                    const std::vector<std::string>& kinds,
                                                    const std::vector<std::string>& others) {
    std::vector<std::string> known = kinds;
    known.insert(known.end(), others.begin(), others.end());
    value.expect_keys(known);
    std::vector<std::pair<std::string, sensor::JsonValue>> found;
    std::string list;
    for (const std::string& kind : kinds) {
        list += (list.empty() ? "" : ", ") + kind;
        if (const auto member = value.find(kind)) found.emplace_back(kind, *member);
    }
    if (found.size() != 1) value.fail(text("must have exactly one of ", list, ", not ", found.size()));
    return found.front();
}

}  // namespace patina::scenes
