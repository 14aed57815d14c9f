#pragma once

#include <glm/glm.hpp>
#include <tiny_gltf.h>

#include "export/write_glb.h"
#include "patina/scene.h"

namespace patina {

/// What glTF has no place for, as `extras`.

tinygltf::Value array_of(glm::dvec3 v);

/// What is known of a segment's gloss, as it is; `observed`: of its glTF material.
tinygltf::Value ward_extras(const SegmentReflectance& segment, bool observed);

/// Of the scene: the photometric scale of its lamps, suns, and the environment beside it.
tinygltf::Value scene_extras(const GlbInfo& info);

}  // namespace patina
