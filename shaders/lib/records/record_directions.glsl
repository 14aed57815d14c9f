// Loads the direction words of records (lib/records/observations.glsl unpacks them), four at a time. The includer
// declares
//   layout(std430, binding = n) readonly buffer Directions { uvec4 quads[]; } directions[kMaxVoxelChunks];
// or defines, before it includes this, DIRECTION_QUAD(C, i): uvec4, quad i of the literal chunk C.
#ifndef PATINA_LIB_RECORD_DIRECTIONS_GLSL
#define PATINA_LIB_RECORD_DIRECTIONS_GLSL
#include "lib/map/voxel_chunks.glsl"
#include "shared/observation/observations.h"

#ifndef DIRECTION_QUAD
#define DIRECTION_QUAD(C, i) directions[C].quads[i]
#endif

// Observations 4 * quad to 4 * quad + 3; quad < kRecordQuads. Which of them count says observation_count().
uvec4 load_directions(uint chunk_shift, uint record, uint quad) {
    const uint index = index_in_chunk(chunk_shift, record) * kRecordQuads + quad;
    uvec4 words;
#define LOAD_DIRECTIONS(C) words = DIRECTION_QUAD(C, index)
    WITH_CHUNK(chunk_shift, record, LOAD_DIRECTIONS)
    return words;
}
uint load_direction(uint chunk_shift, uint record, uint item) {
    return load_directions(chunk_shift, record, item / 4u)[item % 4u];
}

#endif
