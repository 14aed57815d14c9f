#!/usr/bin/env python3
"""Carries a box round before a wall, and prints how many observed voxels a reconstruction has in use in the end.

    PYTHONPATH=PREFIX/lib/python3/dist-packages tools/bench/carried_box.py [FRAMES]

Three reconstructions: as the settings are by default, without giving observations back, and one that sees the wall,
then the box in its last place, which tells how many voxels the surface has.
"""
import sys

import numpy as np

import patina

CAMERA = patina.Intrinsics(width=160, height=120, fx=150, fy=150, cx=79.5, cy=59.5)
WALL_M, HALF_M = 2.2, 0.15
COLOR = np.full((120, 160, 3), 128, np.uint8)
X, Y = np.meshgrid((np.arange(160) - 79.5) / 150, (np.arange(120) - 59.5) / 150)


def depth_of(center_m):
    """Metres along the optical axis: the nearer of the wall and the box, whose axes are the camera's.

    The wall leans: along a border of voxels, the least noise would have it in either layer of them."""
    near, far = np.full(X.shape, 0.0), np.full(X.shape, np.inf)
    for slope, middle in zip((X, Y, np.ones_like(X)), center_m):
        with np.errstate(divide="ignore"):
            planes = np.stack([(middle - HALF_M) / slope, (middle + HALF_M) / slope])
        near, far = np.maximum(near, planes.min(0)), np.minimum(far, planes.max(0))
    wall = WALL_M / (1 - 0.1 * X - 0.05 * Y)
    return np.where((near < far) & (far > 0), np.minimum(near, wall), wall).astype(np.float32)


def center_of(frame):
    """Once round in 250 frames, on a circle that leans away from the camera."""
    turn = 2 * np.pi * frame / 250
    return 0.55 * np.cos(turn), 0.3 * np.sin(turn), 1.5 + 0.25 * np.sin(turn)


AWAY = (0.0, 0.0, 9.0)  # behind the wall


def observed_voxels(device, places, **settings):
    given = patina.Settings()
    for key, value in settings.items():
        given[key.replace("__", ".")] = value
    lamps = [patina.Light((0.5, -0.5, 0), (4, 4, 4))]
    reconstruction = patina.Reconstruction(device, given, lamps, materials="fit")
    for frame, center_m in enumerate(places):
        reconstruction.add(depth_of(center_m), COLOR, CAMERA, np.eye(4), timestamp=frame / 30)
    reconstruction.wait()
    return next(pool["used"] for pool in reconstruction.statistics()["pools"] if pool["name"] == "observed voxels")


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    device = patina.Device()
    places = [center_of(frame) for frame in range(count)]
    by_default = observed_voxels(device, places)
    kept = observed_voxels(device, places, reflectance__reclaim_every=0)
    surface = observed_voxels(device, [AWAY] * 64 + places[-1:] * 64)
    print(f"{count} frames on {device.name}: {by_default} observed voxels in use, {by_default / surface:.2f} times the "
          f"surface's {surface}; {kept} ({kept / surface:.2f}) without giving back")


if __name__ == "__main__":
    main()
