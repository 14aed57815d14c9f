#include "tests/reference/input/unproject_depth.h"

#include <cmath>

namespace patina::reference {

namespace {

/// One view of a depth picture, in camera coordinates.
struct View {
    const Image<float>& depth_m;
    const Intrinsics& camera;
    const DepthJump& jump;

    double depth(int x, int y) const {
        if (!depth_m.extent().contains(x, y)) return 0;
        return depth_m.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
    }

    glm::dvec3 point(int x, int y) const {
        const double z = depth(x, y);
        return {(x - camera.cx) / camera.fx * z, (y - camera.cy) / camera.fy * z, z};
    }

    bool on_one_surface(int x, int y, int dx, int dy) const {
        const double z = depth(x, y), neighbor = depth(x + dx, y + dy);
        return neighbor > 0 && std::abs(neighbor - z) <= jump.floor_m + jump.relative * z;
    }

    glm::dvec3 normal(int x, int y) const {
        for (const auto& [dx, dy] : {std::pair(-1, 0), {1, 0}, {0, -1}, {0, 1}}) {
            if (!on_one_surface(x, y, dx, dy)) return glm::dvec3(0);
        }
        const glm::dvec3 n =
            glm::normalize(glm::cross(point(x + 1, y) - point(x - 1, y), point(x, y + 1) - point(x, y - 1)));
        return glm::dot(n, point(x, y)) < 0 ? n : -n;
    }
};

}  // namespace

Surface unproject_depth(const Image<float>& depth_m, const Intrinsics& camera, const RigidTransform& world_from_camera,
                        const DepthJump& jump) {
    const Extent2D extent = depth_m.extent();
    const View view{depth_m, camera, jump};
    Surface surface{Image<glm::vec4>(extent, glm::vec4(0)), Image<glm::vec4>(extent, glm::vec4(0))};
    for (uint32_t v = 0; v < extent.height; ++v) {
        for (uint32_t u = 0; u < extent.width; ++u) {
            const int x = static_cast<int>(u), y = static_cast<int>(v);
            if (view.depth(x, y) == 0) continue;
            surface.position_m.at(u, v) = glm::vec4(world_from_camera * glm::dvec4(view.point(x, y), 1));
            surface.normal.at(u, v) = glm::vec4(world_from_camera * glm::dvec4(view.normal(x, y), 0));
        }
    }
    return surface;
}

}  // namespace patina::reference
