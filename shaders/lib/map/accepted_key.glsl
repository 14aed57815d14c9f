// Which new keys get a place in a pool that does not suffice for all (fusion/select_main.glsl): by their hash, so that
// it does not matter who came first.
#ifndef PATINA_LIB_ACCEPTED_KEY_GLSL
#define PATINA_LIB_ACCEPTED_KEY_GLSL
#include "shared/fusion/voxel_map.h"

uint accept_bin(uint hash) { return hash / (0xffffffffu / kAcceptBins + 1u); }
bool is_accepted(uint hash, uint accepted_bins) { return accept_bin(hash) < accepted_bins; }

#endif
