"""A wall one metre ahead, seen by a small camera."""
import numpy as np

import patina

CAMERA = patina.Intrinsics(width=64, height=48, fx=60, fy=60, cx=31.5, cy=23.5)
DEPTH = np.full((48, 64), 1000, np.uint16)
COLOR = np.full((48, 64, 3), 128, np.uint8)
LAMP = patina.Light((0, 0, 0), (1, 1, 1))


def wall(device, depth=DEPTH, color=COLOR, **options):
    reconstruction = patina.Reconstruction(device, **options)
    for _ in range(3):
        assert reconstruction.add(depth, color, CAMERA, np.eye(4)).fused
    return reconstruction
