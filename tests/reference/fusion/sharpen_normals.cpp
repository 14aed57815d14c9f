#include "tests/reference/fusion/sharpen_normals.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace patina::reference {

namespace {

/// A point near another one, and its normal where that is known.
struct Neighbour {
    glm::dvec3 away_m;
    glm::dvec3 normal;
};

struct Neighbourhood {
    std::vector<Neighbour> points;
    double least_cosine = 1;  // between the pixel's normal and theirs; 0 at most where one is not known
};

/// The eight points around a pixel, on a circle of `reach` pixels.
Neighbourhood look_around(const SeenSurface& seen, glm::ivec2 pixel, int reach) {
    const glm::dvec4 own = seen.position_m.at(pixel.x, pixel.y);
    const int diagonal = (7 * reach + 5) / 10;
    Neighbourhood found;
    for (const glm::ivec2 side : {glm::ivec2(1, 0), {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}) {
        const glm::ivec2 at = pixel + side * (side.x != 0 && side.y != 0 ? diagonal : reach);
        const bool inside = seen.position_m.extent().contains(at.x, at.y);
        const glm::dvec3 normal = inside ? seen.normal.at(at.x, at.y) : glm::dvec3(0);
        found.least_cosine = std::min(found.least_cosine, glm::dot(normal, seen.normal.at(pixel.x, pixel.y)));
        if (!inside || seen.position_m.at(at.x, at.y).w <= 0) continue;
        found.points.push_back({glm::dvec3(seen.position_m.at(at.x, at.y)) - glm::dvec3(own), normal});
    }
    return found;
}

double points_on_plane(const Neighbourhood& around, glm::dvec3 normal, double tolerance_m) {
    double count = 0;
    for (const Neighbour& point : around.points) {
        const double off = glm::dot(normal, point.away_m) / tolerance_m;
        count += std::max(1 - off * off, 0.0);
    }
    return count;
}

glm::dvec3 face_of(const Neighbourhood& around, glm::dvec3 own, double tolerance_m) {
    if (around.least_cosine >= 0.7) return own;  // a curved face's at most
    glm::dvec3 best = own;
    double most = own == glm::dvec3(0) ? 0 : std::max(points_on_plane(around, own, tolerance_m) + 0.5, 2.0);
    for (const Neighbour& point : around.points) {
        if (point.normal == glm::dvec3(0)) continue;
        if (std::abs(glm::dot(point.normal, point.away_m)) >= tolerance_m) continue;
        const double count = points_on_plane(around, point.normal, tolerance_m);
        if (count <= most) continue;
        most = count;
        best = point.normal;
    }
    return best;
}

/// How many of the points lie within a quarter of a voxel, and 2 % of their distance, of a plane whose normal is
/// theirs.
int points_of_flat_face(const Neighbourhood& around, glm::dvec3 normal, double voxel_m) {
    return static_cast<int>(std::count_if(around.points.begin(), around.points.end(), [&](const Neighbour& point) {
        const double off_m = std::abs(glm::dot(normal, point.away_m));
        return off_m < voxel_m / 4 + 0.02 * glm::length(point.away_m) && glm::dot(normal, point.normal) > 0.998;
    }));
}

/// The normal that at least three of the points share, and more of them than have the pixel's own; else `face`.
glm::dvec3 flat_face_of(const Neighbourhood& around, glm::dvec3 own, glm::dvec3 face, double voxel_m) {
    int most = std::max(points_of_flat_face(around, own, voxel_m), 2);
    for (const Neighbour& point : around.points) {
        const Neighbourhood alone{{point}, 1};
        if (points_of_flat_face(alone, point.normal, voxel_m) == 0) continue;
        const int count = points_of_flat_face(around, point.normal, voxel_m);
        if (count <= most) continue;
        most = count;
        face = point.normal;
    }
    return face;
}

glm::dvec3 smoothed(const Neighbourhood& around, glm::dvec3 face, bool flat, double tolerance_m) {
    if (face == glm::dvec3(0)) return face;
    const auto is_near = [&](const Neighbour& point, double off_m) {
        return std::abs(glm::dot(face, point.away_m)) < off_m;
    };
    const auto agreeing = std::count_if(around.points.begin(), around.points.end(), [&](const Neighbour& point) {
        return is_near(point, tolerance_m) && glm::dot(point.normal, face) > 0.94;
    });
    // Half rough with three points that agree.
    const double rough = flat ? 0 : agreeing <= 2 ? 1 : agreeing == 3 ? 0.5 : 0;
    const double least = glm::mix(0.94, 0.5, rough);
    glm::dvec3 sum = face;
    for (const Neighbour& point : around.points) {
        if (!is_near(point, glm::mix(1.0, 3.0, rough) * tolerance_m)) continue;
        sum += std::max(glm::dot(point.normal, face) - least, 0.0) / (1 - least) * point.normal;
    }
    return glm::normalize(sum);
}

}  // namespace

Image<glm::dvec3> sharpen_normals(const SeenSurface& seen, double focal_px, double voxel_m) {
    Image<glm::dvec3> sharp(seen.position_m.extent());
    for (uint32_t y = 0; y < sharp.extent().height; ++y) {
        for (uint32_t x = 0; x < sharp.extent().width; ++x) {
            const double depth = seen.position_m.at(x, y).w;
            const double pixel_m = std::max(depth, 1e-3) / focal_px;
            const int reach = std::max(static_cast<int>(std::floor(1.5 * voxel_m / pixel_m + 0.5)), 1);
            const double tolerance_m = 0.35 * reach * pixel_m;
            const Neighbourhood around = look_around(seen, glm::ivec2(x, y), reach);
            const glm::dvec3 own = seen.normal.at(x, y);
            glm::dvec3 face = depth > 0 ? face_of(around, own, tolerance_m) : own;
            bool flat = false;
            if (depth > 0 && around.least_cosine < 0.999) {
                const int far = std::max(static_cast<int>(std::floor(5 * voxel_m / pixel_m + 0.5)), reach + 1);
                const Neighbourhood farther = look_around(seen, glm::ivec2(x, y), far);
                face = flat_face_of(farther, own, face, voxel_m);
                flat = points_of_flat_face(farther, face, voxel_m) >= 3;
            }
            sharp.at(x, y) = smoothed(around, face, flat, tolerance_m);
        }
    }
    return sharp;
}

}  // namespace patina::reference
