"""Geometry with materials from RGB-D streams, on any Vulkan device. Lengths are metres, poses 4 x 4 arrays."""
from os import PathLike
from typing import Any, Optional, Sequence, Union

import numpy as np
from numpy.typing import NDArray

class Error(RuntimeError): ...

def device_names() -> list[str]: ...

class Device:
    def __init__(self, selector: str = "", validation: bool = False) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def driver(self) -> str: ...

class Intrinsics:
    def __init__(self, width: int, height: int, fx: float, fy: float, cx: float, cy: float,
                 distortion: Sequence[float] = ...) -> None: ...
    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float

class Light:
    def __init__(self, position: Sequence[float], intensity: Sequence[float], radius: float = 0.0) -> None: ...
    position: tuple[float, float, float]
    intensity: tuple[float, float, float]
    radius: float

class Settings:
    def __init__(self) -> None: ...
    def load(self, file: Union[str, PathLike[str]]) -> None: ...
    def __setitem__(self, key: str, value: Union[str, float, int, bool]) -> None: ...
    def __getitem__(self, key: str) -> Optional[str]: ...

class FrameResult:
    fused: bool
    reason: str
    state: str
    world_from_camera: NDArray[np.float64]

class Scene:
    name: str
    positions: NDArray[np.float32]
    normals: NDArray[np.float32]
    colors: NDArray[np.float32]
    triangles: NDArray[np.uint32]
    kd: NDArray[np.float32]
    labels: NDArray[np.uint32]
    segments: list[dict[str, Any]]
    trajectory: NDArray[np.float64]
    lights: list[Light]
    ambient: tuple[float, float, float]
    def save_glb(self, file: Union[str, PathLike[str]]) -> None: ...
    def save(self, folder: Union[str, PathLike[str]]) -> None: ...

class Reconstruction:
    def __init__(self, device: Device, settings: Optional[Settings] = None, lights: Sequence[Light] = ...,
                 ambient: Sequence[float] = ...) -> None: ...
    def add(self, depth: NDArray[Any], color: NDArray[Any], camera: Intrinsics,
            world_from_camera: Optional[NDArray[np.float64]] = None, color_camera: Optional[Intrinsics] = None,
            color_from_depth: Optional[NDArray[np.float64]] = None, timestamp: float = 0.0,
            metres_per_unit: float = 0.001, max_metres: float = 8.0) -> FrameResult: ...
    def view(self, camera: Intrinsics, world_from_camera: NDArray[np.float64]) -> dict[str, NDArray[Any]]: ...
    def wait(self) -> None: ...
    def finish(self) -> Scene: ...

class Session:
    def __init__(self, device: Device, sequence: str, *, frames: int = 0, lighting: str = "", labels: str = "geometry",
                 materials: str = "auto", poses: str = "auto", settings: Optional[Settings] = None,
                 seed: Optional[int] = None) -> None: ...
    def step(self) -> bool: ...
    @property
    def last(self) -> Optional[FrameResult]: ...
    @property
    def info(self) -> dict[str, Any]: ...
    def view(self, camera: Intrinsics, world_from_camera: NDArray[np.float64]) -> dict[str, NDArray[Any]]: ...
    def shortfalls(self) -> list[str]: ...
    def finish(self) -> Scene: ...
