"""Arrays in and out: without a copy, and wrong ones are an error."""
import gc

import numpy as np
import pytest

import patina
from wall import CAMERA, COLOR, DEPTH, LAMP, wall


def misaligned(array):
    raw = np.zeros(array.nbytes + 1, np.uint8)[1:].view(array.dtype).reshape(array.shape)
    raw[...] = array
    return raw


METRES = np.full((48, 64), 1, np.float32)
WIDE = np.full((48, 128), 1000, np.uint16)
WRONG_DEPTHS = {
    "fortran": (np.asfortranarray(DEPTH), "the depth array is not in C order"),
    "transposed": (np.full((64, 48), 1000, np.uint16).T, "the depth array is not in C order"),
    "columns backwards": (DEPTH[:, ::-1], "the depth array is not in C order"),
    "rows backwards": (DEPTH[::-1], "the depth array is not in C order"),
    "every second": (WIDE[:, ::2], "the depth array is not in C order"),
    "part of rows": (WIDE[:, :64], "the depth array is not in C order"),
    "broadcast": (np.broadcast_to(np.uint16(1000), (48, 64)), "the depth array is not in C order"),
    "misaligned": (misaligned(METRES), "the depth array is not aligned"),
    "other bytes first": (DEPTH.astype(">u2"), r"depth is uint16 \(units\) or float32 \(metres\), not \(48, 64\) >u2"),
    "signed": (DEPTH.astype(np.int16), "depth is uint16"),
    "double": (DEPTH.astype(np.float64), "depth is uint16"),
    "objects": (DEPTH.astype(object), "depth is uint16"),
    "empty": (np.zeros((0, 0), np.uint16), r"the depth array is \(0, 0\) uint16, but its camera has 48 x 64 pixels"),
    "flat": (DEPTH.ravel(), r"the depth array is \(3072\) uint16"),
    "with channels": (DEPTH[..., None], r"the depth array is \(48, 64, 1\) uint16"),
    "a number": (np.array(1, np.uint16), r"the depth array is \(\) uint16"),
    "a list": (DEPTH.tolist(), "depth is a numpy array, not list"),
    "nothing": (None, "depth is a numpy array, not NoneType"),
}
WRONG_COLORS = {
    "grey": (COLOR[..., 0].copy(), r"the colour array is \(48, 64\) uint8, but its camera has 48 x 64 pixels of 3"),
    "four channels": (np.zeros((48, 64, 4), np.uint8), r"the colour array is \(48, 64, 4\) uint8"),
    "channels backwards": (COLOR[..., ::-1], "the colour array is not in C order"),
    "misaligned": (misaligned(COLOR.astype(np.float32)), "the colour array is not aligned"),
    "double": (COLOR.astype(np.float64), r"colour is uint8 \(sRGB\) or float32 \(linear\)"),
    "flags": (COLOR > 0, r"colour is uint8 \(sRGB\) or float32 \(linear\)"),
}


def scaled(value, row, column):
    pose = np.eye(4)
    pose[row, column] = value
    return pose


WRONG_POSES = {
    "not a number": (scaled(np.nan, 0, 0), "holds values that are not finite"),
    "far away": (scaled(np.inf, 0, 3), "holds values that are not finite"),
    "scaled": (2 * np.eye(4), "is no rigid transform: its rotation is off by 3"),
    "mirrored": (np.diag([1.0, 1, -1, 1]), "is no rigid transform"),
    "projective": (scaled(1, 3, 0), "is no rigid transform: its last row is not 0 0 0 1"),
    "three rows": (np.eye(4)[:3], r"is a 4 x 4 array, not \(3, 4\) float64"),
    "empty": (np.zeros((0, 4)), r"is a 4 x 4 array, not \(0, 4\) float64"),
}


@pytest.fixture(scope="module")
def reconstruction(device):
    return wall(device)


@pytest.mark.parametrize("name", WRONG_DEPTHS)
def test_a_wrong_depth_is_an_error(reconstruction, name):
    depth, message = WRONG_DEPTHS[name]
    with pytest.raises(patina.Error, match=message):
        reconstruction.add(depth, COLOR, CAMERA, np.eye(4))


@pytest.mark.parametrize("name", WRONG_COLORS)
def test_a_wrong_colour_is_an_error(reconstruction, name):
    color, message = WRONG_COLORS[name]
    with pytest.raises(patina.Error, match=message):
        reconstruction.add(DEPTH, color, CAMERA, np.eye(4))


@pytest.mark.parametrize("name", WRONG_POSES)
def test_a_wrong_pose_is_an_error(reconstruction, name):
    pose, message = WRONG_POSES[name]
    with pytest.raises(patina.Error, match="world_from_camera " + message):
        reconstruction.add(DEPTH, COLOR, CAMERA, pose)
    with pytest.raises(patina.Error, match="color_from_depth " + message):
        reconstruction.add(DEPTH, COLOR, CAMERA, np.eye(4), color_from_depth=pose)
    with pytest.raises(patina.Error, match="world_from_camera " + message):
        reconstruction.view(CAMERA, pose)


@pytest.mark.parametrize("camera, message", [
    (patina.Intrinsics(0, 0, 60, 60, 0, 0), "0 x 0"),
    (patina.Intrinsics(64, 48, 0, 60, 31.5, 23.5), "fx 0"),
    (patina.Intrinsics(64, 48, 60, float("nan"), 31.5, 23.5), "fy nan"),
    (patina.Intrinsics(64, 48, 60, 60, float("inf"), 23.5), "cx inf"),
])
def test_a_wrong_camera_is_an_error(reconstruction, camera, message):
    shape = (camera.height, camera.width)
    with pytest.raises(patina.Error, match=message):
        reconstruction.add(np.full(shape, 1000, np.uint16), np.zeros(shape + (3,), np.uint8), camera, np.eye(4))
    with pytest.raises(patina.Error, match=message):
        reconstruction.view(camera, np.eye(4))


def test_wrong_labels_are_an_error(reconstruction):
    with pytest.raises(patina.Error, match="labels are uint16, not"):
        reconstruction.add(DEPTH, COLOR, CAMERA, np.eye(4), labels=COLOR)
    with pytest.raises(patina.Error, match=r"the label array is \(2, 2\) uint16"):
        reconstruction.add(DEPTH, COLOR, CAMERA, np.eye(4), labels=np.zeros((2, 2), np.uint16))


def test_after_errors_frames_are_fused_as_before(reconstruction):
    assert reconstruction.add(DEPTH, COLOR, CAMERA, np.eye(4)).fused


def test_what_is_only_to_be_read_is_read(device):
    depth, color, pose = METRES.copy(), COLOR.copy(), np.eye(4)
    for array in (depth, color, pose):
        array.flags.writeable = False
    assert patina.Reconstruction(device).add(depth, color, CAMERA, pose).fused


def test_pixels_that_are_no_numbers_are_no_readings(device):
    depth = METRES.copy()
    depth[:, :32] = np.nan
    color = np.full((48, 64, 3), np.nan, np.float32)
    color[:, 32:] = 0.5
    scene = wall(device, depth, color).finish()
    assert scene.positions[:, 0].min() > -0.05
    assert np.isfinite(scene.positions).all() and np.isfinite(scene.colors).all()


def test_the_arrays_of_a_scene_are_its_memory(device):
    scene = wall(device, lights=[LAMP]).finish()
    for name in ("positions", "normals", "colors", "triangles", "kd", "labels"):
        array, again = getattr(scene, name), getattr(scene, name)
        assert array.size > 0, name
        assert array.base is scene, name
        assert array.__array_interface__["data"][0] == again.__array_interface__["data"][0], name
        assert np.shares_memory(array, again), name
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


def test_the_arrays_of_a_view_are_not_copied(device):
    view = wall(device, lights=[LAMP]).view(CAMERA, np.eye(4))
    assert {"position", "normal", "color", "label", "kd", "ks_alpha", "rgb", "light"} == set(view)
    for name, array in view.items():
        assert not array.flags.owndata and type(array.base).__name__ == "PyCapsule", name
    kept = view["position"][24]
    del view
    gc.collect()
    np.testing.assert_allclose(kept[:, 3], 1, atol=0.002)


def test_an_empty_scene_has_empty_arrays(device):
    scene = patina.Reconstruction(device).finish()
    assert scene.positions.shape == (0, 3) and scene.triangles.shape == (0, 3)
    assert scene.kd.shape == (0, 4) and scene.labels.shape == (0,)
    assert scene.trajectory.shape == (0, 4, 4) and scene.segments == []


def test_arrays_outlive_all_that_they_come_from():
    positions = wall(patina.Device()).finish().positions
    gc.collect()
    assert np.isfinite(positions).all() and len(positions) > 1000


def test_a_reconstruction_keeps_its_device():
    reconstruction = patina.Reconstruction(patina.Device())
    gc.collect()
    assert reconstruction.add(DEPTH, COLOR, CAMERA, np.eye(4)).fused
