"""The Python module as it is installed."""
import numpy as np
import pytest

import patina

CAMERA = patina.Intrinsics(width=64, height=48, fx=60, fy=60, cx=31.5, cy=23.5)
DEPTH = np.full((48, 64), 1000, np.uint16)
COLOR = np.full((48, 64, 3), 128, np.uint8)


@pytest.fixture(scope="module")
def device():
    return patina.Device()


def wall(device, depth=DEPTH, **options):
    reconstruction = patina.Reconstruction(device, **options)
    for _ in range(3):
        assert reconstruction.add(depth, COLOR, CAMERA, np.eye(4)).fused
    return reconstruction


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


def test_light_gives_albedo(device):
    scene = wall(device, lights=[patina.Light((0, 0, 0), (1, 1, 1))]).finish()
    assert scene.lights[0].intensity == (1, 1, 1)
    assert scene.kd.shape == (len(scene.positions), 4)


def test_arrays_outlive_their_scene(device):
    positions = wall(device).finish().positions
    assert np.isfinite(positions).all()


def test_wrong_arrays_are_named(device):
    reconstruction = patina.Reconstruction(device)
    with pytest.raises(patina.Error, match=r"the depth array is \(2, 3\) uint16, but its camera has 48 x 64 pixels"):
        reconstruction.add(np.zeros((2, 3), np.uint16), COLOR, CAMERA)
    with pytest.raises(patina.Error, match=r"depth is uint16 \(units\) or float32 \(metres\)"):
        reconstruction.add(DEPTH.astype(np.float64), COLOR, CAMERA)
    with pytest.raises(patina.Error, match="not in C order"):
        reconstruction.add(np.asfortranarray(DEPTH), COLOR, CAMERA)
    with pytest.raises(patina.Error, match="no rigid transform"):
        reconstruction.add(DEPTH, COLOR, CAMERA, 2 * np.eye(4))


def test_settings_are_set_by_key(device):
    settings = patina.Settings()
    settings["map.voxel_m"] = 0.01
    assert float(settings["map.voxel_m"]) == pytest.approx(0.01)
    with pytest.raises(patina.Error, match="did you mean 'map.voxel_m'"):
        settings["map.voxle_m"] = 0.01
    coarse, fine = wall(device, settings=settings).finish(), wall(device).finish()
    assert len(coarse.triangles) < 0.5 * len(fine.triangles)


def test_a_session_makes_a_scene(device, tmp_path):
    session = patina.Session(device, "synthetic:cubes", frames=2, lighting="none")
    steps = 0
    while session.step():
        steps += 1
        assert session.last.fused
    assert steps == session.info["frames"] == 2
    session.finish().save(tmp_path)
    assert (tmp_path / "scene.glb").stat().st_size > 10000
    assert (tmp_path / "trajectory.txt").exists()


def test_errors_are_sentences(device):
    with pytest.raises(patina.Error, match="/nowhere does not exist"):
        patina.Session(device, "/nowhere")
    with pytest.raises(patina.Error, match="labels is 'x', must be one of: geometry, off, truth"):
        patina.Session(device, "synthetic:cubes", labels="x")
