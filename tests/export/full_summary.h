#pragma once

#include "tools/report/run_summary.h"

namespace patina::test {

/// A summary with something in every field.
inline RunSummary full_summary() {
    RunSummary summary;
    summary.version = "0.1.0";
    summary.device = {"llvmpipe (LLVM 15.0.6, 256 bits)", "software", "1.3.230", "Mesa 22.3.6"};
    summary.seed = 42;
    summary.settings = {{"voxel_mm", 5}, {"truncation_vox", 4.0}, {"note", "a < b & \"c\""}};
    summary.sequence.name = "red <kitchen>";
    summary.sequence.format = "7-scenes";
    summary.sequence.frames = 300;
    summary.sequence.color.extent = summary.sequence.depth.extent = {640, 480};
    summary.sequence.has_poses = true;
    summary.frames = {
        299, 298, {{17, "frame-000017.color.png is truncated: 512 of 8192 bytes"}, {20, "its pose is <NaN>"}}};
    summary.voxel_pool = {18342, 65536, 12};
    summary.memory = {{"voxel blocks", 134217728, 18342, 65536}, {"transient images", 31457280, 5, 8}};
    summary.totals = {{"triangles", 1234567}, {"vertices", 620000}};
    summary.warnings = {"the voxel pool was full: 12 block requests were refused"};
    summary.passes = {{"input.filter_depth", 298, 1.1, 1.25, 2.5},
                      {"fusion.integrate", 298, 3.2, 4.75, 61.0},
                      {"fusion.raycast", 298, 20.5, 24.125, 30.25}};
    summary.times_s = {{"total", 61.25}, {"reading", 3.5}};
    return summary;
}

}  // namespace patina::test
