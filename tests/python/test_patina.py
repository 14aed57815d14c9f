"""The Python module as it is installed."""
import numpy as np
import pytest

import patina
from wall import CAMERA, COLOR, DEPTH, LAMP, wall


def test_a_wall_is_where_the_depth_says(device):
    scene = wall(device).finish()
    assert len(scene.triangles) > 1000
    assert scene.positions.shape == scene.normals.shape == scene.colors.shape
    assert scene.triangles.max() < len(scene.positions)
    assert abs(np.median(scene.positions[:, 2]) - 1) < 0.002
    assert np.median(scene.normals[:, 2]) < -0.99
    assert scene.trajectory.shape == (3, 4, 4)
    np.testing.assert_array_equal(scene.trajectory[0], np.eye(4))


def test_metres_and_units_give_the_same_wall(device):
    units, metres = wall(device).finish(), wall(device, depth=np.full((48, 64), 1, np.float32)).finish()
    np.testing.assert_allclose(np.median(units.positions, axis=0), np.median(metres.positions, axis=0), atol=1e-4)


def test_a_view_holds_arrays_of_the_cameras_size(device):
    view = wall(device).view(CAMERA, np.eye(4))
    assert view["position"].shape == (48, 64, 4)
    assert abs(view["position"][24, 32, 3] - 1) < 0.002
    assert np.isclose(view["color"][24, 32, 0], 0.2158, atol=0.01)  # sRGB 128


def test_light_gives_segments_with_materials(device):
    scene = wall(device, lights=[LAMP]).finish()
    assert scene.lights[0].intensity == (1, 1, 1)
    assert scene.kd.shape == (len(scene.positions), 4)
    assert np.count_nonzero(scene.labels) > 0.5 * len(scene.positions)
    assert scene.segments and all("kd" in segment for segment in scene.segments)


def test_segments_can_be_left_out(device):
    scene = wall(device, lights=[LAMP], labels="off").finish()
    assert scene.kd[:, 3].max() == 1
    assert not scene.labels.any()


def test_a_frame_without_a_pose_is_tracked_or_an_error(device):
    with pytest.raises(patina.Error, match="the frame has no pose: give world_from_camera, or .* poses='track'"):
        patina.Reconstruction(device).add(DEPTH, COLOR, CAMERA)
    tracker = patina.Reconstruction(device, poses="track")
    assert tracker.tracks
    for _ in range(2):
        result = tracker.add(DEPTH, COLOR, CAMERA)
    np.testing.assert_allclose(result.world_from_camera[:3, :3], np.eye(3), atol=0.1)


def test_wrong_choices_are_sentences(device):
    with pytest.raises(patina.Error, match="poses is 'x', must be one of: auto, given, track, prior"):
        patina.Reconstruction(device, poses="x")
    with pytest.raises(patina.Error, match="materials of the truth belong to a sequence"):
        patina.Reconstruction(device, materials="truth")


def test_settings_are_set_by_key(device):
    settings = patina.Settings()
    settings["map.voxel_m"] = 0.01
    assert float(settings["map.voxel_m"]) == pytest.approx(0.01)
    with pytest.raises(patina.Error, match="did you mean 'map.voxel_m'"):
        settings["map.voxle_m"] = 0.01
    coarse, fine = wall(device, settings=settings).finish(), wall(device).finish()
    assert len(coarse.triangles) < 0.5 * len(fine.triangles)
