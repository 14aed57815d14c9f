#include "tests/reference/scenes/scene_shapes.h"

#include <cmath>
#include <initializer_list>

namespace patina::reference {
namespace {

using glm::dvec2;
using glm::dvec3;

dvec3 point_in(const RigidTransform& world_from_part, dvec3 world_m) {
    return dvec3(rigid_inverse(world_from_part) * glm::dvec4(world_m, 1));
}

dvec3 direction_in(const RigidTransform& world_from_part, dvec3 direction) {
    return glm::transpose(glm::dmat3(world_from_part)) * direction;
}

struct Surfaces {
    const RigidTransform& m;
    std::vector<Primitive> out{};

    void operator()(const scenes::RectangleShape& s) {
        out.push_back(Face{dvec3(m[3]), dvec3(m[0]) * s.half_size_m.x, dvec3(m[1]) * s.half_size_m.y});
    }
    void operator()(const scenes::BoxShape& s) {
        const auto half_edge = [&](int i) { return dvec3(m[i]) * s.half_size_m[i]; };
        const auto add = [&](int across, int u, int v) {
            for (const double sign : {-1.0, 1.0})
                out.push_back(Face{dvec3(m[3]) + sign * half_edge(across), half_edge(u), half_edge(v)});
        };
        add(0, 1, 2);
        add(1, 0, 2);
        add(2, 0, 1);
    }
    void operator()(const scenes::SphereShape& s) { out.push_back(Ball{m, s.radius_m}); }
    void operator()(const scenes::CylinderShape& s) {
        out.push_back(Tube{m, s.radius_m, s.half_height_m});
        for (const double sign : {-1.0, 1.0}) out.push_back(Disc{m, sign * s.half_height_m, s.radius_m});
    }
    void operator()(const scenes::MeshShape& s) {
        const scenes::TriangleMesh& mesh = *s.mesh;
        for (const glm::uvec3& t : mesh.triangles) {
            Triangle triangle{};
            for (int i = 0; i < 3; ++i) {
                Corner& corner = triangle.corners[i];
                corner.position_m = dvec3(m * glm::dvec4(dvec3(mesh.positions_m[t[i]]), 1));
                if (!mesh.normals.empty()) corner.normal = glm::normalize(glm::dmat3(m) * dvec3(mesh.normals[t[i]]));
                if (!mesh.texture_coordinates.empty()) corner.uv = dvec2(mesh.texture_coordinates[t[i]]);
            }
            out.push_back(triangle);
        }
    }
};

/// The least positive of the distances that `holds`.
template <class Holds>
std::optional<double> nearest(std::initializer_list<double> distances, Holds holds) {
    std::optional<double> best;
    for (const double t : distances)
        if (t > 0 && (!best || t < *best) && holds(t)) best = t;
    return best;
}

struct Intersect {
    dvec3 origin_m, direction;

    std::optional<double> operator()(const Face& face) const {
        const dvec3 across = glm::cross(face.half_edge_u, face.half_edge_v);
        const double t = glm::dot(across, face.center_m - origin_m) / glm::dot(across, direction);
        return nearest({t}, [&](double at) {
            const dvec3 offset = origin_m + at * direction - face.center_m;
            const auto share = [&](dvec3 half_edge) {
                return glm::dot(offset, half_edge) / glm::dot(half_edge, half_edge);
            };
            return std::abs(share(face.half_edge_u)) <= 1 && std::abs(share(face.half_edge_v)) <= 1;
        });
    }
    std::optional<double> operator()(const Disc& disc) const {
        const dvec3 o = point_in(disc.world_from_part, origin_m), d = direction_in(disc.world_from_part, direction);
        return nearest({(disc.y_m - o.y) / d.y},
                       [&](double t) { return std::hypot(o.x + t * d.x, o.z + t * d.z) <= disc.radius_m; });
    }
    std::optional<double> operator()(const Tube& tube) const {
        const dvec3 o = point_in(tube.world_from_part, origin_m), d = direction_in(tube.world_from_part, direction);
        const double a = d.x * d.x + d.z * d.z, half_b = o.x * d.x + o.z * d.z;
        const double c = o.x * o.x + o.z * o.z - tube.radius_m * tube.radius_m;
        const double root = std::sqrt(half_b * half_b - a * c);
        return nearest({(-half_b - root) / a, (-half_b + root) / a},
                       [&](double t) { return std::abs(o.y + t * d.y) <= tube.half_height_m; });
    }
    std::optional<double> operator()(const Ball& ball) const {
        const dvec3 offset = origin_m - dvec3(ball.world_from_part[3]);
        const double half_b = glm::dot(offset, direction);
        const double c = glm::dot(offset, offset) - ball.radius_m * ball.radius_m;
        const double root = std::sqrt(half_b * half_b - c);
        return nearest({-half_b - root, -half_b + root}, [](double) { return true; });
    }
    /// Möller and Trumbore.
    std::optional<double> operator()(const Triangle& triangle) const {
        const dvec3 a = triangle.corners[0].position_m;
        const dvec3 ab = triangle.corners[1].position_m - a, ac = triangle.corners[2].position_m - a;
        const dvec3 p = glm::cross(direction, ac);
        const double determinant = glm::dot(ab, p);
        const dvec3 offset = origin_m - a, q = glm::cross(offset, ab);
        const double u = glm::dot(offset, p) / determinant, v = glm::dot(direction, q) / determinant;
        return nearest({glm::dot(ac, q) / determinant}, [&](double) { return u >= 0 && v >= 0 && u + v <= 1; });
    }
};

struct SpotAt {
    dvec3 point_m, viewer_m;

    Spot flat(dvec3 normal, dvec2 uv) const { return {normal, normal, uv, point_m}; }

    Spot operator()(const Face& face) const {
        const dvec3 u = glm::normalize(face.half_edge_u), v = glm::normalize(face.half_edge_v);
        const dvec3 offset = point_m - face.center_m;
        return flat(glm::cross(u, v), {glm::dot(offset, u), glm::dot(offset, v)});
    }
    Spot operator()(const Disc& disc) const {
        const dvec3 p = point_in(disc.world_from_part, point_m);
        return flat(dvec3(disc.world_from_part[1]), {p.x, p.z});
    }
    Spot operator()(const Tube& tube) const {
        const dvec3 p = point_in(tube.world_from_part, point_m);
        const dvec3 outward = glm::dmat3(tube.world_from_part) * glm::normalize(dvec3(p.x, 0, p.z));
        return flat(outward, {tube.radius_m * std::atan2(p.x, p.z), p.y});
    }
    Spot operator()(const Ball& ball) const {
        const dvec3 p = point_in(ball.world_from_part, point_m) / ball.radius_m;
        return flat(glm::dmat3(ball.world_from_part) * glm::normalize(p),
                    ball.radius_m * dvec2(std::atan2(p.x, p.z), std::asin(glm::clamp(p.y, -1.0, 1.0))));
    }
    Spot operator()(const Triangle& triangle) const {
        const auto& [a, b, c] = triangle.corners;
        const auto twice_area = [](dvec3 p, dvec3 q, dvec3 r) { return glm::cross(q - p, r - p); };
        const dvec3 whole = twice_area(a.position_m, b.position_m, c.position_m);
        const auto share = [&](dvec3 q, dvec3 r) {
            return glm::dot(twice_area(point_m, q, r), whole) / glm::dot(whole, whole);
        };
        const dvec3 shares(share(b.position_m, c.position_m), share(c.position_m, a.position_m),
                           share(a.position_m, b.position_m));
        Spot spot = flat(glm::normalize(whole), shares.x * a.uv + shares.y * b.uv + shares.z * c.uv);
        if (a.normal == dvec3(0)) return spot;
        spot.normal = glm::normalize(shares.x * a.normal + shares.y * b.normal + shares.z * c.normal);
        const double side = glm::dot(spot.normal, viewer_m - point_m) > 0 ? 1 : -1;
        spot.smooth_m = dvec3(0);
        for (int i = 0; i < 3; ++i) {
            const Corner& corner = triangle.corners[i];
            const double above = side * glm::dot(point_m - corner.position_m, corner.normal);
            spot.smooth_m += shares[i] * (point_m - std::min(above, 0.0) * side * corner.normal);
        }
        return spot;
    }
};

}  // namespace

std::vector<Primitive> surfaces_of(const scenes::Part& part) {
    Surfaces surfaces{part.world_from_part};
    std::visit(surfaces, part.shape);
    return surfaces.out;
}

std::optional<double> intersect(const Primitive& surface, dvec3 origin_m, dvec3 direction) {
    return std::visit(Intersect{origin_m, direction}, surface);
}

Spot spot_at(const Primitive& surface, dvec3 point_m, dvec3 viewer_m) {
    return std::visit(SpotAt{point_m, viewer_m}, surface);
}

}  // namespace patina::reference
