#pragma once

#include "tools/report/run_record.h"

namespace patina::test {

/// A record with something in every field.
inline RunRecord full_record() {
    RunRecord record;
    record.version = "0.1.0";
    record.device = {"llvmpipe (LLVM 15.0.6, 256 bits)", "software", "1.3.230", "Mesa 22.3.6"};
    record.seed = 42;
    record.settings = {{"voxel_mm", 5}, {"truncation_vox", 4.0}, {"note", "a < b & \"c\""}};
    record.sequence.name = "red <kitchen>";
    record.sequence.format = "7-scenes";
    record.sequence.frames = 300;
    record.sequence.color.extent = record.sequence.depth.extent = {640, 480};
    record.sequence.has_poses = true;
    record.frames = {
        299, 298, {{17, "frame-000017.color.png is truncated: 512 of 8192 bytes"}, {20, "its pose is <NaN>"}}};
    record.voxel_pool = {18342, 65536, 12};
    record.memory = {{"voxel blocks", 134217728, 18342, 65536}, {"transient images", 31457280, 5, 8}};
    record.totals = {{"triangles", 1234567}, {"vertices", 620000}};
    record.warnings = {"the voxel pool was full: 12 block requests were refused"};
    record.passes = {{"input.filter_depth", 298, 1.1, 1.25, 2.5},
                     {"fusion.integrate", 298, 3.2, 4.75, 61.0},
                     {"fusion.raycast", 298, 20.5, 24.125, 30.25}};
    record.times_s = {{"total", 61.25}, {"reading", 3.5}};
    return record;
}

}  // namespace patina::test
