#!/usr/bin/python3
"""Fuses a whole recording in Patina's format with Open3D's VoxelBlockGrid on the CPU: memory and time of a large scene.

usage: tools/bench/open3d_tour.py RECORDING [--voxel-m 0.01] [--blocks 50000] [--frames N]

Needs Debian's python3-open3d. Geometry and colours alone: Open3D has no reflectance.
"""

import argparse
import json
import resource
import statistics
import time
from pathlib import Path

import numpy as np
import open3d as o3d
import open3d.core as o3c


def poses(folder):
    """world_from_camera of each frame, 4 x 4."""
    rows = np.loadtxt(folder / "trajectory.txt")
    for _, tx, ty, tz, x, y, z, w in rows:
        pose = np.eye(4)
        pose[:3, :3] = [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
        pose[:3, 3] = tx, ty, tz
        yield pose


def intrinsics(camera):
    return o3c.Tensor([[camera["fx"], 0, camera["cx"]], [0, camera["fy"], camera["cy"]], [0, 0, 1]], o3c.float64)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("recording", type=Path)
    parser.add_argument("--voxel-m", type=float, default=0.01)
    parser.add_argument("--blocks", type=int, default=50000)
    parser.add_argument("--frames", type=int, default=None)
    options = parser.parse_args()
    info = json.loads((options.recording / "sequence.json").read_text())
    scale = 1 / info["depth"]["metres_per_unit"]
    depth_camera, color_camera = intrinsics(info["depth"]), intrinsics(info["color"])
    device = o3c.Device("CPU:0")
    grid = o3d.t.geometry.VoxelBlockGrid(
        attr_names=("tsdf", "weight", "color"),
        attr_dtypes=(o3c.float32, o3c.uint16, o3c.uint16),
        attr_channels=((1), (1), (3)),
        voxel_size=options.voxel_m,
        block_resolution=8,
        block_count=options.blocks,
        device=device,
    )
    times_ms = []
    for index, pose in enumerate(poses(options.recording)):
        if index == options.frames:
            break
        name = f"{index:06d}.png"
        depth = o3d.t.io.read_image(str(options.recording / "depth" / name)).to(device)
        color = o3d.t.io.read_image(str(options.recording / "color" / name)).to(device)
        start = time.perf_counter()
        extrinsic = o3c.Tensor(np.linalg.inv(pose), o3c.float64)
        blocks = grid.compute_unique_block_coordinates(depth, depth_camera, extrinsic, scale, 6.0, 4.0)
        grid.integrate(blocks, depth, color, depth_camera, color_camera, extrinsic, scale, 6.0, 4.0)
        times_ms.append(1000 * (time.perf_counter() - start))
    used = grid.hashmap().size()
    start = time.perf_counter()
    mesh = grid.extract_triangle_mesh(3.0)
    tenth = max(len(times_ms) // 10, 1)
    print(f"frames {len(times_ms)}, blocks {used}, triangles {mesh.triangle.indices.shape[0]}")
    print(f"ms a frame, median: first tenth {statistics.median(times_ms[:tenth]):.1f}, "
          f"last tenth {statistics.median(times_ms[-tenth:]):.1f}; mesh {time.perf_counter() - start:.1f} s")
    print(f"peak resident {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6:.2f} GB")


if __name__ == "__main__":
    main()
