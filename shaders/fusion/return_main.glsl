// Takes a place for a block that comes back, and enters its key in the table. The includer declares, before it includes
// this, Keys, Blocks, BlockKeys, FreeList, Counters and Streamed as return_blocks.comp does, and RETURN_GRID, a
// VoxelGrid.
#include "lib/map/insert_key.glsl"

// A free place, kNoBlock where there is none.
uint take_place() {
    const uint free = atomicAdd(counters.free_blocks, 0xffffffffu);
    if (free - 1u >= RETURN_GRID.capacity) {  // also where there was none: the count wraps around
        atomicAdd(counters.free_blocks, 1u);
        return kNoBlock;
    }
    atomicMax(counters.high_water, RETURN_GRID.capacity - (free - 1u));
    return free_list[free - 1u];
}

void return_block(uint item) {
    const uint key = streamed[item].key;
    const Insertion at = insert_key(RETURN_GRID, key, true);
    uint block = kNoBlock;
    bool took_place = false;
    if (at.slot != kNoSlot) {
        block = at.fresh ? kNoBlock : blocks[at.slot];
        if (block == kNoBlock) {
            block = take_place();
            blocks[at.slot] = block;
            took_place = block != kNoBlock;
            if (took_place) {
                block_keys[block] = key;
                atomicAdd(counters.returned_blocks, 1u);
            }
        }
        if (at.fresh) atomicAdd(counters.table_keys, 1u);
    }
    if (block == kNoBlock) atomicAdd(counters.refused_blocks, 1u);
    streamed[item].block = block;
    streamed[item].fresh = took_place ? 1u : 0u;
}
