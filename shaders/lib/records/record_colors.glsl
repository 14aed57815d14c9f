// Loads the color words of records (lib/records/observations.glsl unpacks them), four at a time. The includer declares
//   layout(std430, binding = n) readonly buffer Colors { uvec4 quads[]; } colors[kMaxVoxelChunks];
// or defines, before it includes this, COLOR_QUAD(C, i): uvec4, quad i of the literal chunk C.
#ifndef PATINA_LIB_RECORD_COLORS_GLSL
#define PATINA_LIB_RECORD_COLORS_GLSL
#include "lib/map/voxel_chunks.glsl"
#include "shared/observation/observations.h"

#ifndef COLOR_QUAD
#define COLOR_QUAD(C, i) colors[C].quads[i]
#endif

// Observations 4 * quad to 4 * quad + 3; quad < kRecordQuads. Which of them count says observation_count().
uvec4 load_colors(uint chunk_shift, uint record, uint quad) {
    const uint index = index_in_chunk(chunk_shift, record) * kRecordQuads + quad;
    uvec4 words;
#define LOAD_COLORS(C) words = COLOR_QUAD(C, index)
    WITH_CHUNK(chunk_shift, record, LOAD_COLORS)
    return words;
}
uint load_color(uint chunk_shift, uint record, uint item) {
    return load_colors(chunk_shift, record, item / 4u)[item % 4u];
}

#endif
