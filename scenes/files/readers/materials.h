#pragma once

#include <map>
#include <optional>
#include <string>

#include "scenes/description/scene.h"
#include "sensor/files/json_file.h"

namespace patina::scenes {

/// What an object is made of: a Ward material without id and name, and its texture if kd varies.
struct ObjectMaterial {
    sensor::Material material;
    std::optional<Texture> texture{};
};

/// The members "textures" and "materials" of a scene file, for its objects to name.
class MaterialReader {
  public:
    /// Reads all of them. Throws Error for each that is wrong, used or not.
    explicit MaterialReader(const sensor::JsonValue& root);

    /// A material by name, or one described in place.
    ObjectMaterial read(const sensor::JsonValue& value) const;

  private:
    struct NamedTexture {
        Texture texture;
        glm::dvec3 largest_kd;
    };

    ObjectMaterial read_inline(const sensor::JsonValue& value) const;

    std::map<std::string, NamedTexture> textures_;
    std::map<std::string, ObjectMaterial> materials_;
};

}  // namespace patina::scenes
