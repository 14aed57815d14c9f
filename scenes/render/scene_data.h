#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "scenes/description/scene.h"
#include "shared/scenes/scene.h"

namespace patina::scenes {

/// A scene as shaders/synthetic takes it, in host memory; see shared/scenes/scene.h.
struct SceneData {
    gpu::SceneInfo info{};
    std::vector<gpu::SceneNode> nodes;  ///< those of the parts' tree, then of the triangles'; in every order
    std::vector<glm::vec4> shapes;  ///< in the order of the leaves: kTriangleTexels per triangle, then gpu::ScenePart
    std::vector<gpu::SceneTriangle> triangles;  ///< in the order of the leaves
    std::vector<gpu::SceneObject> objects;
    std::vector<glm::vec4> texels;  ///< the pictures of kd, object by object
    std::vector<gpu::SceneLight> lights;
};

/// Packs a scene and builds its trees. Throws Error naming the object that has neither kd nor texture, an alpha outside
/// (0, 1], an id that is 0, above 65535 or another's, a texture without texels, or a mesh whose lists do not fit
/// together; and for more triangles, nodes or texels than the largest portable image holds.
SceneData pack_scene(const SyntheticScene& scene);

}  // namespace patina::scenes
