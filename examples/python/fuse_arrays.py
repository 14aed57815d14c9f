"""Fuses arrays of one's own: a wall that is one metre away, seen by a camera of 64 x 48 pixels."""
import numpy as np

import patina

camera = patina.Intrinsics(width=64, height=48, fx=60, fy=60, cx=31.5, cy=23.5)
depth_mm = np.full((48, 64), 1000, np.uint16)
color = np.full((48, 64, 3), 128, np.uint8)
reconstruction = patina.Reconstruction(patina.Device())
for _ in range(3):
    reconstruction.add(depth_mm, color, camera, world_from_camera=np.eye(4))
scene = reconstruction.finish()
view = reconstruction.view(camera, np.eye(4))
print(len(scene.triangles), "triangles at", float(np.median(scene.positions[:, 2])), "m")
print("the pixel in the middle is", float(view["position"][24, 32, 3]), "m away")
