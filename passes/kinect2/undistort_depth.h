#pragma once

#include "passes/kinect2/decode_settings.h"
#include "passes/kinect2/tables.h"

namespace patina::kinect2 {

/// Both of the pinhole camera HostTables::depth, mirrored back.
struct UndistortedImages {
    graph::ImageId depth_m;   ///< 512 x 424 r32f; 0 where there is no reading or the sensor did not see the pixel
    graph::ImageId infrared;  ///< 512 x 424 r32f, 0 to 65535; 0 where the sensor did not see the pixel
};

/// Removes the lens distortion from what add_unwrap_phases returned: each pixel takes the nearest one of the sensor,
/// since between a near and a far surface there is nothing. Drops readings outside of the settings' range and, with
/// `drop_edges`, those that lie between a near and a far surface or whose amplitude is negative (libfreenect2,
/// filterPixelStage2). The sensor's border pixels have to be in range alone. Throws Error unless the range is positive
/// and finite.
UndistortedImages add_undistort_depth(graph::FrameGraph& frame, const TableIds& tables, graph::ImageId readings,
                                      const DecodeSettings& settings);

}  // namespace patina::kinect2
