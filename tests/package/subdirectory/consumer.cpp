// Fuses three frames of a wall one metre ahead and prints how far away the surface is.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include <patina/reconstruction.h>

int main() try {
    const patina::Intrinsics camera{{64, 48}, 60, 60, 31.5, 23.5};
    const std::vector<uint16_t> depth(camera.extent.area(), 1000);
    const std::vector<glm::u8vec3> color(camera.extent.area(), glm::u8vec3(128));
    patina::ReconstructionOptions options;
    options.lighting.lights = {{glm::dvec3(0), glm::dvec3(2)}};
    patina::Device device;
    patina::Reconstruction reconstruction(device, options);
    for (int i = 0; i < 3; ++i)
        reconstruction.add({.depth = {.pixels = depth, .camera = camera}, .color = {color, camera}});
    const patina::Scene scene = reconstruction.finish();
    const auto is_wall = [](glm::vec3 position_m) { return std::abs(position_m.z - 1) < 0.01f; };
    const bool right = !scene.mesh.positions_m.empty() && std::ranges::all_of(scene.mesh.positions_m, is_wall);
    std::cout << scene.mesh.triangles.size() << " triangles, " << scene.reflectance.segments.size() << " segments\n";
    return right && !scene.reflectance.segments.empty() ? 0 : 1;
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
