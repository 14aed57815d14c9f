#include "passes/fusion/raycast.h"

#include <algorithm>
#include <cmath>

#include "tests/gpu/fusion_rig.h"
#include "tests/gpu/gpu_test.h"

namespace patina {
namespace {

const Intrinsics kCamera{{320, 240}, 300, 300, 159.5, 119.5, {}};

struct Errors {
    std::vector<double> depth_m, normal_deg;
    size_t missed = 0, invented = 0;

    static double quantile(std::vector<double> values, double q) {
        std::sort(values.begin(), values.end());
        return values.empty() ? 0 : values[static_cast<size_t>(q * static_cast<double>(values.size() - 1))];
    }
};

Errors compare(const FusionRig::View& view, const reference::DistanceField& scene, const RigidTransform& pose) {
    const Image<float> truth = reference::render_depth(scene, kCamera, pose, 4.0);
    Errors errors;
    for (size_t i = 0; i < truth.pixels().size(); ++i) {
        const float expected = truth.pixels()[i];
        const glm::vec4 hit = view.position_m.pixels()[i];
        if (expected == 0 || hit.w == 0) {
            errors.missed += expected != 0;
            errors.invented += hit.w != 0;
            continue;
        }
        errors.depth_m.push_back(std::abs(hit.w - expected));
        const glm::dvec3 normal(view.normal.pixels()[i]),
            expected_normal = reference::normal_at(scene, glm::dvec3(hit));
        // Not the arc cosine: it turns a rounding of 2^-11 in a half float into two degrees.
        const double sine = glm::length(glm::cross(normal, expected_normal));
        errors.normal_deg.push_back(glm::degrees(std::atan2(sine, glm::dot(normal, expected_normal))));
    }
    return errors;
}

class RaycastTest : public GpuTest {};

TEST_F(RaycastTest, FusedSphereAndBoxAreFoundWhereTheyAre) {
    const std::pair<const char*, reference::DistanceField> scenes[] = {
        {"sphere", reference::sphere({0, 0, 0}, 0.3)}, {"box", reference::box({0, 0, 0}, {0.2, 0.25, 0.3})}};
    for (const auto& [name, scene] : scenes) {
        FusionRig rig(device(), runner());
        for (const RigidTransform& pose : reference::orbit({0, 0, 0}, 1.2, 40)) {
            rig.fuse(kCamera, pose, reference::render_depth(scene, kCamera, pose, 4.0));
        }
        for (const MapAccess access : {MapAccess::kStorage, preferred_map_access(device().caps(), rig.map())}) {
            const RigidTransform pose = reference::orbit({0, 0, 0}, 1.0, 7)[3];
            const Errors errors = compare(rig.raycast(kCamera, pose, access), scene, pose);
            SCOPED_TRACE(name);
            EXPECT_LE(Errors::quantile(errors.depth_m, 0.5), 0.0005);
            EXPECT_LE(Errors::quantile(errors.depth_m, 0.99), 0.0025);
            EXPECT_LE(Errors::quantile(errors.normal_deg, 0.5), 2.0);
            // Edges and limbs are rounded by a fraction of a pixel.
            EXPECT_LE(errors.missed + errors.invented, errors.depth_m.size() / 100);
        }
    }
}

}  // namespace
}  // namespace patina
