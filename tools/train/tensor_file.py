"""Reads and writes safetensors files: the header's length in 8 bytes, a header in JSON, raw little-endian data."""

import json
import os
import struct

import numpy as np


def write_tensors(path, tensors, metadata):
    """`tensors`: arrays by name, stored as F32; `metadata`: strings by key. The file appears whole or not at all."""
    header, blobs, offset = {"__metadata__": metadata}, [], 0
    for name, values in tensors.items():
        values = np.asarray(values, dtype="<f4")
        if not np.isfinite(values).all():
            raise ValueError(f"{path}: {name} is not finite")
        blob = values.tobytes()
        header[name] = {"dtype": "F32", "shape": list(values.shape), "data_offsets": [offset, offset + len(blob)]}
        offset += len(blob)
        blobs.append(blob)
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 8)
    partial = f"{path}.partial-{os.getpid()}"
    with open(partial, "wb") as file:
        file.write(struct.pack("<Q", len(text)) + text + b"".join(blobs))
    os.replace(partial, path)


def read_tensors(path):
    """(tensors, metadata) of a file that write_tensors() wrote."""
    with open(path, "rb") as file:
        data = file.read()
    (length,) = struct.unpack_from("<Q", data)
    header = json.loads(data[8 : 8 + length])
    metadata = header.pop("__metadata__", {})
    tensors = {}
    for name, entry in header.items():
        begin, end = entry["data_offsets"]
        values = np.frombuffer(data[8 + length + begin : 8 + length + end], dtype="<f4")
        tensors[name] = values.reshape(entry["shape"])
    return tensors, metadata
