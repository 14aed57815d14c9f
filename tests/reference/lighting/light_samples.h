#pragma once

#include <array>
#include <set>
#include <span>

#include <glm/glm.hpp>

#include "tests/reference/fusion/volume.h"
#include "tests/reference/observation/collect_observations.h"

namespace patina::reference {

/// What the observations of a voxel say about the light there.
struct LightSample {
    glm::dvec3 diffuse{0};    ///< the mean colour of the two fifths that are darkest
    glm::dvec3 to_viewer{0};  ///< from where the brightest one was seen
    double excess = 0;        ///< what that is brighter by than the observation three tenths from the darkest on
    double least_excess = 0;  ///< of a highlight
};
LightSample light_sample(std::span<const SeenColor> seen);

/// What a lamp of intensity 1 gives a surface.
struct TrialLight {
    double received = 0;          ///< cosine / (pi r^2) where nothing is in between; 0 where the lamp stands too low
    double least_distance_m = 0;  ///< of the surface to the way in between; below zero: the way leads through it
};
/// The way begins 4 voxels above the surface, after 16 voxels at most, lifted if it rises too slowly; it ends 15 cm, or
/// three tenths of it, before the lamp.
TrialLight try_light(const Volume& volume, glm::dvec3 point_m, glm::dvec3 normal, glm::dvec3 lamp_m);

/// How far (metres) a ray goes through cells of the surroundings that show the sky, of those more than one and a half
/// cells above the surface that it leaves. By small steps, up to `reach_m`.
double sky_on_way_m(const std::set<std::array<int, 3>>& sky, double cell_m, glm::dvec3 point_m, glm::dvec3 normal,
                    glm::dvec3 direction, double reach_m);

}  // namespace patina::reference
