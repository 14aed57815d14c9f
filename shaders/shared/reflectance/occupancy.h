// Which cells of a grid are in use, so that rays cross what is empty in few steps.
#ifndef PATINA_SHARED_OCCUPANCY_H
#define PATINA_SHARED_OCCUPANCY_H
#include "shared/interop.h"
INTEROP_BEGIN

INTEROP_CONST uint kOccupancyCubeWords = 0x10000u;  // 128^3 bits
INTEROP_CONST uint kOccupancyCellWords = 0x80000u;  // 32^3 cubes of 8^3 bits

// Bits, lib/map/occupancy.glsl says where. Cells far apart share one: what is said to be in use may be none.
struct Occupancy {
    uint cubes[kOccupancyCubeWords];  // of 8 cells along each side; those 128 cubes apart share a bit
    uint cells[kOccupancyCellWords];  // those 32 cubes apart share a bit
};

INTEROP_END
#endif
