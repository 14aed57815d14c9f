#pragma once

#include <filesystem>
#include <memory>

#include "patina/source.h"

namespace patina::sensor {

/// Whether the folder holds a file frame-NNNNNN.depth.png.
bool is_seven_scenes_sequence(const std::filesystem::path& folder);

/// Opens a folder in the layout of Microsoft's 7-Scenes: frame-NNNNNN.color.{png,jpg}, .depth.png (millimetres, 65535
/// invalid), .pose.txt (4 x 4, world_from_camera of the depth camera). Frames are in the order of their numbers, which
/// may have gaps; a frame's timestamp is its number / 30 s.
///
/// Without other intrinsics the cameras are those of 7-Scenes' Kinect, whose colour is not registered to depth: depth
/// has f = 585 and (cx, cy) = (320, 240), the values published with the data; colour has f = 528, (322.7, 236.8), and
/// lies at P_color = P_depth + (-0.0305, 0.0036, 0) m, fitted on depth edges against colour edges of 22 frames of the
/// scene "redkitchen" (residual 1-2 pixels). A 3 x 3 matrix in camera-intrinsics.txt or intrinsics.K.txt takes their
/// place; unless it is that Kinect's, it holds for both pictures, which are then registered, as in 3DMatch, which
/// shares this layout. Throws Error when no picture can be read, or the pictures' size fits no known intrinsics.
std::unique_ptr<Source> open_seven_scenes(const std::filesystem::path& folder);

}  // namespace patina::sensor
