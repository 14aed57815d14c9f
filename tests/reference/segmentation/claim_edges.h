#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "patina/camera.h"
#include "patina/image.h"

namespace patina::reference {

/// A frame's surface that falls into components.
struct ComponentPicture {
    Intrinsics camera;
    Image<uint32_t> component;                ///< key; 0: none
    Image<float> depth_m;                     ///< 0: nothing
    Image<glm::dvec3> normal;                 ///< in the camera's axes
    Image<std::optional<glm::ivec2>> chroma;  ///< in steps of 1 / 4095
};

struct ClaimRules {
    double claim_m = 0.006, claim_sigmas = 3;
    double noise_floor_m = 0.001, noise_per_m = 0.00025;
    double chroma_weight_m = 0.05;  ///< a difference of chromaticity counts as so much distance from a plane
    double jump_m = 0.01, steepest_degrees = 80;  ///< of a surface's depth, a pixel apart
    double same_hue = 0.08;                       ///< chromaticities across the direction from grey, over a fold
    int reach_px = 6;
    uint32_t min_pixels = 60;
};

/// Pixels between two components, and the sums of the chromaticities on both sides, the smaller key's first.
struct ContactSum {
    uint32_t pixels = 0;
    glm::ivec2 low{0}, high{0};

    bool operator==(const ContactSum&) const = default;
};

struct Claims {
    Image<uint32_t> component;
    std::map<std::pair<uint32_t, uint32_t>, ContactSum> contacts;  ///< the smaller key first
};

/// Gives each pixel without a component of min_pixels the one, of those nearest to the left, right, top and bottom, on
/// whose tangent plane it lies, and of several the one whose plane and colour are nearest; else one of its hue that it
/// folds away from.
Claims claim_edges(const ComponentPicture& picture, const ClaimRules& rules = {});

/// What remains of components, by their smallest key, after those that touch in a strong hue of their own were joined.
struct FoldRules {
    double strong_chroma = 0.12, same_hue_degrees = 2.5, same_saturation = 0.1, least_weight = 1;
};
bool is_fold(const ContactSum& contact, const FoldRules& rules = {});

/// The smallest element that each element is connected with by some of the pairs.
std::map<uint32_t, uint32_t> joined(const std::set<std::pair<uint32_t, uint32_t>>& pairs);

}  // namespace patina::reference
