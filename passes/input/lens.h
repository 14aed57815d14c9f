#pragma once

#include <span>

#include "engine/graph/frame_graph.h"
#include "patina/camera.h"
#include "shared/input/lens.h"

namespace patina {

/// The camera as the undistorting shaders take it. Throws Error, in the name of `pass`, unless its focal lengths are
/// positive and all its numbers finite.
gpu::Lens lens_of(const Intrinsics& camera, const char* pass);

/// Uploads a picture's pixels as whole 32-bit words. Throws Error, in the name of `pass`, when there are not
/// `extent.area()` pixels.
template <class Pixel>
graph::BufferId upload_picture(graph::FrameGraph& frame, const char* pass, Extent2D extent,
                               std::span<const Pixel> pixels) {
    if (pixels.size() != extent.area()) {
        throw Error("the pass '", pass, "' got ", pixels.size(), " pixels for a picture of ", extent);
    }
    // A picture may end within a word; shaders read whole ones.
    const graph::BufferId words = frame.create_buffer(text(pass, ".source"), (pixels.size_bytes() + 3) / 4 * 4);
    return frame.upload_bytes(words, 0, std::as_bytes(pixels), true);
}

}  // namespace patina
