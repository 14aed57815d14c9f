"""Reads the files of labelled HemiImages that `patina synth-hemi` writes (format: docs/guide/training.md)."""

import os
import struct

import numpy as np

HEADER = struct.Struct("<8sIIQIIIIII16x")
LABEL = np.dtype(
    [("w", "<f4", 7), ("kd", "<f4", 3), ("ks", "<f4", 3), ("alpha", "<f4"), ("normal_error_degrees", "<f4"),
     ("windows", "<u4")]
)
MAGIC = b"PATHEMI\0"
VERSION = 1
MAPS = ("parabolic", "orthogonal")
SAMPLES, SIDE, CHANNELS = 25, 15, 3


class ExampleFileError(Exception):
    """One sentence that names the file and what is wrong with it."""


class ExampleFile:
    """Labels and images of a file, read from disk when they are asked for."""

    def __init__(self, path):
        self.path = str(path)
        try:
            size = os.path.getsize(path)
            with open(path, "rb") as file:
                head = file.read(HEADER.size)
        except OSError as error:
            raise ExampleFileError(f"{self.path} cannot be read: {error.strerror}") from error
        self._parse(head)
        self._check_size(size)
        values = SAMPLES * SIDE * SIDE * CHANNELS
        example = np.dtype([("label", LABEL), ("images", "<f2", (values,)), ("pad", "<f2", (values % 2,))])
        self._check("example_bytes", self.example_bytes, example.itemsize)
        self._examples = np.memmap(path, dtype=example, mode="r", offset=HEADER.size, shape=self.count)

    def _parse(self, head):
        if len(head) < HEADER.size:
            raise ExampleFileError(f"{self.path}: the header takes {HEADER.size} bytes, the file has {len(head)}")
        (magic, version, self.generator, self.seed, self.count, self.example_bytes, samples, side, channels,
         map_number) = HEADER.unpack(head)
        if magic != MAGIC:
            raise ExampleFileError(f"{self.path}: is no file of HemiImages: it begins with {magic!r}, not {MAGIC!r}")
        self._check("version", version, VERSION)
        self._check("samples", samples, SAMPLES)
        self._check("side", side, SIDE)
        self._check("channels", channels, CHANNELS)
        if map_number >= len(MAPS):
            raise ExampleFileError(f"{self.path}: map is {map_number}, known are 0 to {len(MAPS) - 1}")
        self.map = MAPS[map_number]

    def _check(self, field, value, wanted):
        if value != wanted:
            raise ExampleFileError(f"{self.path}: {field} is {value}, it must be {wanted}")

    def _check_size(self, size):
        wanted = HEADER.size + self.count * self.example_bytes
        if size != wanted:
            raise ExampleFileError(
                f"{self.path}: has {size} bytes, {self.count} examples of {self.example_bytes} bytes take {wanted}"
            )

    def __len__(self):
        return self.count

    def labels(self):
        """All labels, a structured array of LABEL. Raises ExampleFileError when one is not finite."""
        labels = np.array(self._examples["label"])
        for field in ("w", "kd", "ks", "alpha"):
            finite = np.isfinite(labels[field]).reshape(len(labels), -1).all(axis=1)
            if not finite.all():
                raise ExampleFileError(f"{self.path}: {field} of example {int(np.argmin(finite))} is not finite")
        return labels

    def images(self):
        """All images: float16 [example][sample][pixel][channel], linear RGB, pixels row by row."""
        images = np.array(self._examples["images"])
        return images.reshape(len(self), SAMPLES, SIDE * SIDE, CHANNELS)
