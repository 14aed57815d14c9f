"""Makes a recording of what Cycles rendered: noise of depth and colour, 8 bits, and the truth beside it, as
docs/guide/recording.md and docs/guide/synth.md describe such folders."""
import json
import struct

import cv2
import numpy

DEPTH_SIGMA_M = 0.0007  # at one metre; grows with the square of depth
READ_SIGMA = 0.002  # of linear values
SHOT_SIGMA = 0.01  # where they are 1; grows with their square root


def quantised(linear):
    linear = numpy.clip(linear, 0, 1)
    encoded = numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return numpy.round(255 * encoded).astype(numpy.uint8)


def with_noise(color, random):
    sigma = numpy.hypot(READ_SIGMA, SHOT_SIGMA * numpy.sqrt(numpy.clip(color, 0, 1)))
    return color + random.normal(size=color.shape) * sigma


def noisy_depth(depth, random):
    noisy = depth + random.normal(size=depth.shape) * DEPTH_SIGMA_M * depth * depth
    return numpy.where((depth > 0.3) & (depth < 8), numpy.round(noisy * 1000), 0).astype(numpy.uint16)


def filtered(color, albedo, depth, normal, label, radius=3):
    """A joint bilateral filter of what the albedo is multiplied with, against the noise of path tracing."""
    shading = color / numpy.maximum(albedo, 0.02)
    around = cv2.medianBlur(shading.astype(numpy.float32), 5)
    single = shading.mean(2) > 1.5 * around.mean(2) + 0.05  # paths that met a lamp by chance
    shading = numpy.where(single[..., None], around, shading)
    level = numpy.log1p(shading)
    total, weights = numpy.zeros_like(shading), numpy.zeros(depth.shape + (1,))
    for dy in range(-radius, radius + 1):
        for dx in range(-radius, radius + 1):
            def moved(image):
                return numpy.roll(image, (dy, dx), (0, 1))
            weight = ((moved(label) == label) * numpy.exp(-0.5 * ((moved(depth) - depth) / (0.02 * depth)) ** 2) *
                      numpy.clip((moved(normal) * normal).sum(2), 0, 1) ** 32)[..., None]
            weight = weight * numpy.exp(-((moved(level) - level) ** 2).mean(2, keepdims=True) / 0.02)
            total += weight * moved(shading)
            weights += weight
    return total / weights * numpy.maximum(albedo, 0.02)


def write_exr(path, channels):
    """Channels of 32-bit floats, one array each, uncompressed, by scanlines."""
    names = sorted(channels)
    height, width = channels[names[0]].shape

    def attribute(name, kind, data):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data
    listed = b"".join(name.encode() + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for name in names) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = struct.pack("<ii", 20000630, 2) + b"".join((
        attribute("channels", "chlist", listed), attribute("compression", "compression", b"\0"),
        attribute("dataWindow", "box2i", window), attribute("displayWindow", "box2i", window),
        attribute("lineOrder", "lineOrder", b"\0"), attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
        attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
        attribute("screenWindowWidth", "float", struct.pack("<f", 1)))) + b"\0"
    rows = numpy.stack([channels[name] for name in names], 1).astype("<f4")  # height x channel x width
    size = rows[0].nbytes
    first = len(header) + 8 * height
    with open(path, "wb") as file:
        file.write(header)
        file.write((first + (size + 8) * numpy.arange(height, dtype="<u8")).tobytes())
        for y in range(height):
            file.write(struct.pack("<ii", y, size) + rows[y].tobytes())


class Sequence:
    """A sequence folder that frames are added to. Poses are 4 x 4 arrays, camera to world."""

    def __init__(self, folder, name, camera, exposure, seed):
        self.folder, self.name, self.camera, self.exposure = folder, name, camera, exposure
        self.random = numpy.random.default_rng(seed)
        self.poses = []
        (folder / "color").mkdir(parents=True)
        (folder / "depth").mkdir()

    def add(self, color, depth, pose):
        index = len(self.poses)
        encoded = quantised(with_noise(color * self.exposure, self.random))
        cv2.imwrite(str(self.folder / f"color/{index:06}.png"), encoded[..., ::-1])
        cv2.imwrite(str(self.folder / f"depth/{index:06}.png"), noisy_depth(depth, self.random))
        self.poses.append(pose)
        return index

    def finish(self):
        intrinsics = self.camera | {"distortion": [0] * 5}
        (self.folder / "sequence.json").write_text(json.dumps({
            "format": "patina-sequence", "version": 1, "name": self.name, "fps": 10, "frames": len(self.poses),
            "color": intrinsics | {"exposure_s": 0.01 * self.exposure, "gain": 1},
            "depth": intrinsics | {"metres_per_unit": 0.001, "max_metres": 8},
            "depth_to_color": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}, indent=1))
        (self.folder / "trajectory.txt").write_text(trajectory(self.poses))


def trajectory(poses):
    """TUM format: time, place, quaternion x y z w."""
    lines = []
    for index, pose in enumerate(poses):
        vector = cv2.Rodrigues(pose[:3, :3])[0].ravel()
        angle = numpy.linalg.norm(vector)
        axis = vector / angle if angle > 0 else vector
        values = (index / 10, *pose[:3, 3], *(axis * numpy.sin(angle / 2)), numpy.cos(angle / 2))
        lines.append(" ".join(f"{value:.9g}" for value in values))
    return "\n".join(lines) + "\n"
