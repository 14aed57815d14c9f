// A folder in, scene.glb out: embed SEQUENCE SCENE.glb [FRAMES]
#include <cstdlib>
#include <iostream>

#include <patina/session.h>

int main(int argc, char** argv) try {
    if (argc < 3) throw patina::Error("usage: embed SEQUENCE SCENE.glb [FRAMES]");
    patina::SessionOptions options;
    options.sequence = argv[1];
    options.frames = argc > 3 ? static_cast<uint32_t>(std::atoi(argv[3])) : 0;
    patina::Device device;
    patina::Session session(device, options);
    while (session.step()) std::cout << (session.last()->fused ? '.' : 'x') << std::flush;
    const patina::Scene scene = session.finish();
    scene.save_glb(argv[2]);
    std::cout << '\n' << scene.mesh.triangles.size() << " triangles\n";
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
