#include <cstdio>

#include "engine/core/error.h"
#include "tools/figure/hare.h"
#include "tools/figure/write_ply.h"

/// Makes the figure of the scene `bunnies`: patina_figure assets/scenes/figure.ply
int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: %s OUT.ply\n", argv[0]);
        return 2;
    }
    try {
        const patina::scenes::TriangleMesh mesh = patina::figure::make_hare();
        patina::figure::write_ply(argv[1], mesh);
        std::printf("%s: %zu vertices, %zu triangles\n", argv[1], mesh.positions_m.size(), mesh.triangles.size());
    } catch (const patina::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
