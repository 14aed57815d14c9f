"""Renders a room by Cycles as a recording with truth, in the format that 'patina run' reads:

  blender --background --factory-startup --python-exit-code 1 --python tools/rooms/render.py -- ROOM OUT
          [--sky FILE.hdr] [--frames N] [--extent WxH] [--samples N] [--truth-every N] [--seed N]

ROOM is kitchen, bedroom, bedroom_sun or living_room. Cycles shares no code with Patina: lamps with an extent, a sky
behind a window, four bounces, gloss that mirrors the room. Every other frame is also in OUT/lighting, at a 64th of the
exposure.
Needs Debian's packages blender, python3-numpy and python3-opencv.
"""
import argparse
import importlib
import json
import math
import os
import pathlib
import re
import sys
import tempfile

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import bpy  # noqa: E402
import cv2  # noqa: E402
import mathutils  # noqa: E402
import numpy  # noqa: E402

from room import Room  # noqa: E402
from sequence import Sequence, filtered, trajectory, write_exr  # noqa: E402

LOW_EXPOSURE = 1 / 64  # of the recording's
PASSES = {"color": "Image", "kd": "DiffCol", "ks": "GlossCol"}
DATA = {"depth": "Depth", "normal": "Normal", "label": "IndexOB"}


def parse_arguments():
    parser = argparse.ArgumentParser(prog="tools/rooms/render.py")
    parser.add_argument("room", choices=("kitchen", "bedroom", "bedroom_sun", "living_room"))
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--sky", type=pathlib.Path, help="picture of a sky, equirectangular, Radiance HDR")
    parser.add_argument("--frames", type=int, default=80)
    parser.add_argument("--extent", default="320x264")
    parser.add_argument("--samples", type=int, default=64, help="paths a pixel")
    parser.add_argument("--truth-every", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args(sys.argv[sys.argv.index("--") + 1:])
    extent = re.fullmatch(r"([1-9]\d*)x([1-9]\d*)", options.extent)
    if not extent:
        parser.error(f"--extent: '{options.extent}' is not WxH")
    options.width, options.height = int(extent[1]), int(extent[2])
    for name in ("frames", "samples", "truth_every"):
        if getattr(options, name) < 1:
            parser.error(f"--{name.replace('_', '-')}: {getattr(options, name)} is not above 0")
    if options.sky and not options.sky.is_file():
        parser.error(f"--sky: there is no file {options.sky}")
    options.unfinished = options.out.with_name(options.out.name + ".unfinished")
    for folder in (options.out, options.unfinished):
        if folder.exists():
            parser.error(f"{folder} exists")
    return options


def set_up(options):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = options.width, options.height
    scene.render.resolution_percentage = 100
    cycles = scene.cycles
    cycles.use_denoising = cycles.use_adaptive_sampling = False
    cycles.max_bounces = 5
    cycles.diffuse_bounces = cycles.glossy_bounces = 4
    cycles.caustics_reflective = False  # too rare to be sampled: they are single bright pixels
    cycles.sample_clamp_indirect = 4
    cycles.pixel_filter_type = "BOX"
    layer = scene.view_layers[0]
    for name in ("z", "normal", "diffuse_color", "glossy_color", "object_index"):
        setattr(layer, f"use_pass_{name}", True)
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit, camera.sensor_width = "HORIZONTAL", 36
    focal_px = 365 / 512 * options.width
    camera.lens, camera.clip_start = focal_px / options.width * 36, 0.02
    thing = bpy.data.objects.new("camera", camera)
    scene.collection.objects.link(thing)
    scene.camera = thing
    return {"width": options.width, "height": options.height, "fx": focal_px, "fy": focal_px,
            "cx": (options.width - 1) / 2, "cy": (options.height - 1) / 2}


def write_passes_to(folder):
    scene = bpy.context.scene
    scene.use_nodes = True
    nodes, links = scene.node_tree.nodes, scene.node_tree.links
    nodes.clear()
    layers, files = nodes.new("CompositorNodeRLayers"), nodes.new("CompositorNodeOutputFile")
    files.base_path = str(folder)
    files.format.file_format, files.format.color_depth, files.format.exr_codec = "OPEN_EXR", "32", "NONE"
    files.file_slots.clear()
    for name, source in (PASSES | DATA).items():
        files.file_slots.new(name)
        links.new(layers.outputs[source], files.inputs[name])


def rendered(folder, names, samples, filter_width, seed):
    cycles = bpy.context.scene.cycles
    cycles.samples, cycles.filter_width, cycles.seed = samples, filter_width, seed
    bpy.context.scene.frame_set(1)
    bpy.ops.render.render()
    images = {}
    for name in names:
        image = cv2.imread(str(folder / f"{name}0001.exr"), cv2.IMREAD_UNCHANGED)
        images[name] = image[..., 2::-1].astype(float) if image.ndim == 3 else image.astype(float)
    return images


def along(path, share):
    """Catmull-Rom through the places and the points looked at; share is 0 to 1 of the whole path."""
    position = share * (len(path) - 1)
    first = min(int(position), len(path) - 2)
    t = position - first
    points = [path[min(max(first + k, 0), len(path) - 1)] for k in (-1, 0, 1, 2)]
    weights = (-t + 2 * t * t - t ** 3, 2 - 5 * t * t + 3 * t ** 3, t + 4 * t * t - 3 * t ** 3, -t * t + t ** 3)
    return [sum((0.5 * w * mathutils.Vector(point[which]) for w, point in zip(weights, points)), mathutils.Vector())
            for which in (0, 1)]


def pose_of(place, target, sway):
    """Camera to world, x right, y down, z forward, rolled by sway."""
    forward = (target - place).normalized()
    right = forward.cross(mathutils.Vector((0, 0, 1))).normalized()
    right.rotate(mathutils.Quaternion(forward, sway))
    pose = numpy.eye(4)
    pose[:3, 0], pose[:3, 1], pose[:3, 2], pose[:3, 3] = right, forward.cross(right), forward, place
    return pose


def pose_at(path, index, frames):
    place, target = along(path, index / max(frames - 1, 1))
    return pose_of(place, target, 0.03 * math.sin(0.7 * index))


def truth_channels(room, shown, data):
    label = numpy.round(data["label"] if data["label"].ndim == 2 else data["label"][..., 0]).astype(int)
    depth = data["depth"] if data["depth"].ndim == 2 else data["depth"][..., 0]
    alpha = numpy.array([0.5] + [material.alpha for _, material in room.things])[label]
    channels = {"alpha": alpha, "label": label, "depth": numpy.where(depth < 50, depth, 0), "valid": label > 0}
    for name, values, letters in (("kd", shown["kd"], "RGB"), ("ks", shown["ks"], "RGB"),
                                  ("rgb", shown["color"], "RGB"), ("normal", data["normal"], "XYZ")):
        for i, letter in enumerate(letters):
            channels[f"{name}.{letter}"] = values[..., i]
    return channels


def take(scratch, room, pose, exposure, options, index):
    """A picture and what is true in it."""
    camera = bpy.context.scene.camera
    camera.matrix_world = mathutils.Matrix(pose.tolist()) @ mathutils.Matrix.Diagonal((1, -1, -1, 1))
    data = rendered(scratch, DATA, 1, 0.01, options.seed)
    shown = rendered(scratch, PASSES, options.samples, 1.0, options.seed + index)
    shown["color"] *= exposure
    channels = truth_channels(room, shown, data)
    label = channels["label"]
    depth = numpy.maximum(channels["depth"], 0.1)
    smooth = filtered(shown["color"], shown["kd"] + shown["ks"], depth, data["normal"], label)
    return numpy.where(label[..., None] > 0, smooth, shown["color"]), channels


def write_truth(truth, room, poses, exposure):
    (truth / "trajectory.txt").write_text(trajectory(poses))
    lamps = [lamp | {"intensity": [value * exposure for value in lamp["intensity"]]} for lamp in room.lamps]
    (truth / "lights.json").write_text(json.dumps({"lights": lamps}, indent=1))
    (truth / "materials.json").write_text(json.dumps({"materials": [
        {"id": index, "name": name, "kd": "texture" if callable(material.kd) else material.kd, "ks": material.ks,
         "alpha": material.alpha} for index, (name, material) in enumerate(room.things, 1)]}, indent=1))


def main():
    options = parse_arguments()
    described = importlib.import_module(options.room)
    room = Room()
    described.build(room, options.sky and options.sky.resolve())
    camera = set_up(options)
    truth = options.unfinished / "truth"
    (truth / "frames").mkdir(parents=True)
    (truth / "labels").mkdir()
    recording = Sequence(options.unfinished, options.room, camera, 1.0, options.seed)
    low = Sequence(options.unfinished / "lighting", options.room, camera, LOW_EXPOSURE, options.seed + 1)
    with tempfile.TemporaryDirectory() as scratch:
        write_passes_to(scratch)
        for index in range(options.frames):
            pose = pose_at(described.PATH, index, options.frames)
            color, channels = take(pathlib.Path(scratch), room, pose, described.EXPOSURE, options, index)
            recording.add(color, channels["depth"], pose)
            if index % 2 == 0:
                low.add(color, channels["depth"], pose)
            cv2.imwrite(str(truth / f"labels/{index:06}.png"), channels["label"].astype(numpy.uint16))
            if index % options.truth_every == 0:
                write_exr(truth / f"frames/{index:06}.exr", channels)
            print(f"frame {index + 1} of {options.frames}", flush=True)
    recording.finish()
    low.finish()
    write_truth(truth, room, recording.poses, described.EXPOSURE)
    options.unfinished.rename(options.out)


main()
