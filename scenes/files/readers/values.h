#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "engine/core/error.h"
#include "patina/camera.h"
#include "sensor/files/json_file.h"

namespace patina::scenes {

/// Beyond this a length, in metres, or a light's intensity is taken for a mistake; its float and its square are finite.
inline constexpr double kLargestValue = 1e6;

/// Three numbers of magnitude up to kLargestValue: a position or an axis.
glm::dvec3 read_vector(const sensor::JsonValue& value);

/// The same, not 0 0 0, as a vector of unit length.
glm::dvec3 read_direction(const sensor::JsonValue& value);

/// A number above 0 and up to kLargestValue: a length, a duration.
double read_positive(const sensor::JsonValue& value);

/// An RGB triple of numbers from 0 to `most`, or one number for all three.
glm::dvec3 read_rgb(const sensor::JsonValue& value, double most);

/// Numbers of degrees, as radians.
double read_degrees(const sensor::JsonValue& value);

/// The members "position" and "rotations" of an object or part, both optional: the rotations are multiplied in their
/// order, so that the last one is applied first, and then moved to the position.
RigidTransform read_placement(const sensor::JsonValue& value);

/// Runs `read`; what it throws gets the value's file and key path in front.
template <class Read>
auto located(const sensor::JsonValue& value, Read read) {
    try {
        return read();
    } catch (const Error& error) {
        throw Error(value.where(), ": ", error.what());
    }
}

/// A file named inside a JSON file, relative to the latter's folder.
std::filesystem::path beside_file(const sensor::JsonValue& name);

/// The one member among `kinds` that an object has, as {"box", ...}, beside those in `others`. Throws Error when it has
/// none, several, or any other.
std::pair<std::string, sensor::JsonValue> read_kind(const sensor::JsonValue& value,
                                                    const std::vector<std::string>& kinds,
                                                    const std::vector<std::string>& others = {});

}  // namespace patina::scenes
