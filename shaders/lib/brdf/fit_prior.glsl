// What the Ward fit expects of observations and of ks before it has seen any. Constants alone.
#ifndef PATINA_LIB_FIT_PRIOR_GLSL
#define PATINA_LIB_FIT_PRIOR_GLSL

const float kLeastDeviation = 0.1;  // of observations, for the prior's weight
// Observations of one voxel, and voxels beside each other, err together: so many count as one.
const float kCorrelated = 50.0;
// What polished dielectrics reflect; 67 measured materials (MERL, as fitted by Ngan, Durand and Matusik 2005) have
// 0.033 in the mean. The network's word on ks is no better where no highlight was seen.
const float kKsBefore = 0.04;
const float kKsDeviation = 0.15;

#endif
