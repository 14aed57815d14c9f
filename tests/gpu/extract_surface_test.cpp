#include "passes/surface/extract_surface.h"
#include <chrono>
#include <iostream>
#include <map>
#include "tests/gpu/fusion_rig.h"
#include "tests/gpu/gpu_test.h"
namespace patina {
namespace {
const Intrinsics kCamera{{320, 240}, 300, 300, 159.5, 119.5, {}};
std::vector<RigidTransform> orbit(glm::dvec3 target_m, double distance_m, int views) {
    std::vector<RigidTransform> poses;
    for (int i = 0; i < views; ++i) {
        const double height = 0.9 * (2.0 * (i + 0.5) / views - 1.0);
        const double radius = std::sqrt(1 - height * height), angle = 2.399963 * i;
        poses.push_back(reference::look_at(
            target_m + distance_m * glm::dvec3(radius * std::cos(angle), height, radius * std::sin(angle)), target_m));
    }
    return poses;
}
class T : public GpuTest {};
TEST_F(T, Quick) {
    FusionRig rig(device(), runner());
    const auto scene = reference::sphere({0, 0, 0}, 0.3);
    for (const RigidTransform& pose : orbit({0, 0, 0}, 1.2, 40)) rig.fuse(kCamera, pose, reference::render_depth(scene, kCamera, pose, 4.0));
    for (auto access : {MapAccess::kStorage, preferred_map_access(device().caps(), rig.map())}) {
      Mesh mesh;
      runner().wait(); runner().clear_timings();
      for (int i = 0; i < 15; ++i) {
        auto t0 = std::chrono::steady_clock::now();
        mesh = extract_surface(runner(), rig.map(), {{}, access});
        std::cout << std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - t0).count() << " ";
      }
      std::cout << "\n" << rig.counters().high_water << " blocks, V " << mesh.positions_m.size() << " T " << mesh.triangles.size() << "\n";
      for (const auto& t : runner().pass_timings()) { auto s = t.samples_ms; std::sort(s.begin(), s.end()); std::cout << t.name << " " << s.front() << " " << s[s.size()/2] << "\n"; }
      std::map<std::pair<uint32_t,uint32_t>, int> e;
      for (auto& t : mesh.triangles) for (int i = 0; i < 3; ++i) { uint32_t a = t[i], b = t[(i+1)%3]; e[{std::min(a,b),std::max(a,b)}] += a < b ? 1 : 100; }
      int bad = 0; for (auto& [k, n] : e) bad += n != 101;
      double vol = 0; for (auto& t : mesh.triangles) vol += glm::dot(glm::dvec3(mesh.positions_m[t[0]]), glm::cross(glm::dvec3(mesh.positions_m[t[1]]), glm::dvec3(mesh.positions_m[t[2]]))) / 6;
      std::cout << "bad edges " << bad << " euler " << int(mesh.positions_m.size()) - int(e.size()) + int(mesh.triangles.size()) << " volume " << vol << " of " << 4.18879 * .027 << "\n";
    }
}
}
}
