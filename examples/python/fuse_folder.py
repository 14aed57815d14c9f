"""A folder in, scene.glb out: fuse_folder.py SEQUENCE SCENE.glb [FRAMES]"""
import sys

import patina

device = patina.Device()
session = patina.Session(device, sys.argv[1], frames=int(sys.argv[3]) if len(sys.argv) > 3 else 0)
while session.step():
    print(session.info["name"], session.last.fused, session.last.reason)
scene = session.finish()
scene.save_glb(sys.argv[2])
print(len(scene.triangles), "triangles,", len(scene.lights), "lights")
