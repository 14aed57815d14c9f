"""Sessions: choices, callbacks, interruption."""
import _thread
import operator
import os
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import patina
from wall import LAMP

CUBES = "synthetic:" + os.environ.get("PATINA_CUBES", "cubes")  # ctest names a scene of a quarter of the pixels


def passes_of(session):
    while session.step():
        pass
    return {timing["name"] for timing in session.statistics()["passes"]}


def test_a_session_makes_a_scene(device, tmp_path):
    session = patina.Session(device, CUBES, frames=2, lighting="none")
    steps = 0
    while session.step():
        steps += 1
        assert session.last.fused
    assert steps == session.info["frames"] == 2
    session.finish().save(tmp_path)
    assert (tmp_path / "scene.glb").stat().st_size > 10000
    assert (tmp_path / "trajectory.txt").exists()


def test_what_became_of_a_frame_stays(device):
    session = patina.Session(device, CUBES, frames=2, lighting="none")
    assert session.last is None
    session.step()
    first = session.last
    pose = first.world_from_camera
    session.step()
    np.testing.assert_array_equal(first.world_from_camera, pose)
    assert not np.array_equal(session.last.world_from_camera, pose)


def test_lights_are_given_in_every_way(device, tmp_path):
    lighting = patina.Lighting([LAMP], ambient=(0.25, 0.5, 0.75))
    file = tmp_path / "lamps"
    patina.write_lighting(file, lighting)
    assert patina.read_lighting(file).ambient == (0.25, 0.5, 0.75)
    assert patina.read_lighting(file).lights[0].axis == (0, 0, 0)
    patina.write_lighting(file, patina.Lighting([patina.Light((1, 2, 3), (1, 1, 1), axis=(0, 0, -1))]))
    assert patina.read_lighting(file).lights[0].axis == (0, 0, -1)
    patina.write_lighting(file, lighting)
    for given in (lighting, patina.LightsFromFile(file), patina.LightsFromFile(str(file))):
        found = patina.Session(device, CUBES, frames=1, lighting=given).lighting
        assert found.ambient == lighting.ambient
        assert [lamp.position for lamp in found.lights] == [LAMP.position]
    json = tmp_path / "lights.json"
    patina.write_lighting(json, lighting)
    assert len(patina.Session(device, CUBES, frames=1, lighting=json).lighting.lights) == 1
    assert patina.Session(device, CUBES, frames=1, lighting=patina.NoLights()).lighting.lights == []
    # A word that is no .json names a sequence.
    for sequence in (str(tmp_path / "nothing"), patina.LightsFromSequence(tmp_path / "nothing")):
        with pytest.raises(patina.Error, match="nothing does not exist"):
            patina.Session(device, CUBES, frames=1, lighting=sequence)
    with pytest.raises(TypeError):
        patina.Session(device, CUBES, lighting=3)


def test_gains_are_estimated_where_asked_for(device):
    on = passes_of(patina.Session(device, CUBES, frames=2, lighting="none", gains="on"))
    off = passes_of(patina.Session(device, CUBES, frames=2, lighting="none", gains="off"))
    assert {name for name in on - off if "gain" in name}
    assert not {name for name in off if "gain" in name}


def test_held_out_frames_are_not_fused(device):
    session = patina.Session(device, CUBES, frames=2, lighting="none", hold_out=2)
    while session.step():
        pass
    held_out = session.finish()
    session = patina.Session(device, CUBES, frames=1, lighting="none")
    while session.step():
        pass
    alone = session.finish()
    assert np.array_equal(held_out.positions, alone.positions) and np.array_equal(held_out.colors, alone.colors)
    with pytest.raises(patina.Error, match="every frame is held out"):
        patina.Session(device, CUBES, frames=2, lighting="none", hold_out=1)
    with pytest.raises(patina.Error, match="the albedo of white surfaces is 2, it must be above 0 and at most 1"):
        patina.Session(device, CUBES, frames=2, white_albedo=2)


def test_wrong_choices_are_sentences(device):
    with pytest.raises(patina.Error, match="/nowhere does not exist"):
        patina.Session(device, Path("/nowhere"))
    with pytest.raises(patina.Error, match="labels is 'x', must be one of: geometry, off, truth"):
        patina.Session(device, CUBES, labels="x")
    with pytest.raises(patina.Error, match="gains is 'x', must be one of: auto, on, off"):
        patina.Session(device, CUBES, gains="x")
    with pytest.raises(patina.Error, match="/nowhere"):
        patina.Session(device, CUBES, lighting=patina.Lighting([LAMP]), network="/nowhere")
    with pytest.raises(patina.Error, match="the viewer needs lights"):
        patina.Session(device, CUBES, lighting="none", reflectance_for="the viewer")


def test_progress_is_called(device):
    calls = []
    session = patina.Session(device, CUBES, frames=2, lighting="none", progress=lambda *call: calls.append(call))
    while session.step():
        pass
    assert [call[:3] for call in calls] == [("frames", 1, 2), ("frames", 2, 2)]
    assert "blocks" in calls[0][3]


def test_whoever_stops_a_session_keeps_what_was_fused(device):
    stop = False
    session = patina.Session(device, CUBES, frames=3, lighting="none", stop=lambda: stop)
    assert session.step()
    stop = True
    with pytest.raises(patina.Interrupted, match="interrupted after 1 of 3 frames") as raised:
        session.step()
    assert isinstance(raised.value, patina.Error)
    stop = False
    assert len(session.finish().trajectory) == 1
    assert session.step()


class Odd(Exception):
    pass


def test_what_a_callback_raises_comes_out(device):
    def fail(*_):
        raise Odd("by the callback")

    session = patina.Session(device, CUBES, frames=2, lighting="none", progress=fail)
    with pytest.raises(Odd, match="by the callback"):
        session.step()
    # In the search for lights, which goes on without what else fails there.
    for callback in ("progress", "stop"):
        with pytest.raises(Odd, match="by the callback"):
            patina.Session(device, CUBES, frames=2, lighting="self", **{callback: fail})


def test_ctrl_c_ends_a_search_for_lights_between_two_frames(device):
    # No line of Python is run, where the interpreter would look for signals by itself.
    answers = iter([_thread.interrupt_main] + 10 * [bool])
    with pytest.raises(KeyboardInterrupt):
        patina.Session(device, CUBES, frames=4, lighting="self", stop=map(operator.call, answers).__next__)
    assert len(list(answers)) == 10  # not asked again


def ticks_within(work):
    """How often another thread runs in the middle half of the time that work() takes."""
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.0005)

    thread = threading.Thread(target=tick)
    thread.start()
    start = time.perf_counter()
    work()
    duration = time.perf_counter() - start
    done.set()
    thread.join()
    return sum(start + 0.25 * duration < at < start + 0.75 * duration for at in ticks)


def test_the_interpreter_is_free_while_the_device_works(device):
    sessions = []

    def open_one():
        sessions.append(patina.Session(device, CUBES, frames=5, lighting=patina.Lighting([LAMP])))

    def is_free(work, times=5):  # a busy machine may keep the other thread waiting, once
        return any(ticks_within(work) > 0 for _ in range(times))

    assert is_free(open_one)
    session = sessions[0]
    assert is_free(session.step)
    assert is_free(session.finish, 1)
    assert is_free(lambda: session.view(session.info["color"], np.eye(4)))


def test_a_session_goes_on_from_its_map(device, tmp_path):
    def session(**more):
        settings = patina.Settings()
        settings["map.voxel_m"] = 0.02
        return patina.Session(device, CUBES, frames=4, lighting="none", settings=settings, map=tmp_path / "map.sqlite",
                              **more)

    first = session()
    first.step()
    first.step()
    first.checkpoint()
    with pytest.raises(patina.Error, match="has not come to its end, after 2 frames"):
        session()
    onwards = session(resume=True, checkpoint_every=4)
    for each in (first, onwards):
        while each.step():
            pass
    assert onwards.statistics()["frames"] == 4
    np.testing.assert_array_equal(onwards.finish().positions, first.finish().positions)

    settings = patina.Settings()
    settings["map.voxel_m"] = 0.02
    further = patina.Session(device, CUBES, frames=2, lighting="none", settings=settings,
                             extends=tmp_path / "map.sqlite")
    while further.step():
        pass
    assert further.statistics()["frames"] == 6
    assert len(further.finish().trajectory) == 2
