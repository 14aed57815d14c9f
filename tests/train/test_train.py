"""Tests of tools/train. Run by ctest where python3-torch is installed, or: python3 tests/train/test_train.py"""

import json
import os
import pathlib
import struct
import sys
import tempfile
import types
import unittest

import numpy as np
import torch

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tools" / "train"))

import example_file  # noqa: E402
import examples  # noqa: E402
import hemi_network  # noqa: E402
import tensor_file  # noqa: E402
import train  # noqa: E402
import validate  # noqa: E402
from example_file import CHANNELS, HEADER, LABEL, MAGIC, SAMPLES, SIDE, ExampleFile, ExampleFileError  # noqa: E402

VALUES = SAMPLES * SIDE * SIDE * CHANNELS
EXAMPLE_BYTES = LABEL.itemsize + 2 * (VALUES + 1)


def example_bytes(label, images):
    return label.tobytes() + images.astype("<f2").tobytes() + bytes(2)


def made_up_file(path, count, seed=1, **changes):
    """Examples all of whose parameters and pixels are one number each; a header with some changes."""
    random = np.random.default_rng(seed)
    header = {"magic": MAGIC, "version": 1, "generator": 1, "seed": seed, "examples": count,
              "example_bytes": EXAMPLE_BYTES, "samples": SAMPLES, "side": SIDE, "channels": CHANNELS, "map": 0}
    header.update(changes)
    with open(path, "wb") as file:
        file.write(HEADER.pack(*header.values()))
        for _ in range(count):
            label = np.zeros((), dtype=LABEL)
            label["w"] = random.uniform(0, 1)
            label["kd"], label["ks"], label["alpha"] = random.uniform(0.1, 1), 0.1, 0.2
            file.write(example_bytes(label, np.full(VALUES, label["w"][0])))


class WithFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)


class ExampleFiles(WithFolder):
    def expect_error(self, text):
        with self.assertRaisesRegex(ExampleFileError, text) as caught:
            ExampleFile(self.path("a.hemi")).labels()
        message = str(caught.exception)
        self.assertIn("a.hemi", message)
        self.assertNotIn("\n", message)

    def test_what_was_written_is_read(self):
        made_up_file(self.path("a.hemi"), 3)
        file = ExampleFile(self.path("a.hemi"))
        self.assertEqual((len(file), file.seed, file.map), (3, 1, "parabolic"))
        self.assertEqual(file.images().shape, (3, SAMPLES, SIDE * SIDE, CHANNELS))
        np.testing.assert_allclose(file.images()[2, 7, 9, 1], file.labels()["w"][2, 0], rtol=1e-3)

    def test_a_truncated_file_is_refused(self):
        made_up_file(self.path("a.hemi"), 2)
        os.truncate(self.path("a.hemi"), HEADER.size + 2 * EXAMPLE_BYTES - 1)
        self.expect_error(f"2 examples of {EXAMPLE_BYTES} bytes take")
        os.truncate(self.path("a.hemi"), 10)
        self.expect_error("the header takes 64 bytes, the file has 10")

    def test_a_missing_file_is_refused(self):
        self.expect_error("No such file")

    def test_a_header_that_is_none_is_refused(self):
        for changes, text in (({"magic": b"PNG"}, "begins with"), ({"version": 2}, "version is 2, it must be 1"),
                              ({"samples": 24}, "samples is 24, it must be 25"), ({"side": 16}, "side is 16"),
                              ({"channels": 4}, "channels is 4"), ({"map": 2}, "map is 2"),
                              ({"examples": 5}, "5 examples")):
            with self.subTest(text):
                made_up_file(self.path("a.hemi"), 1, **changes)
                self.expect_error(text)

    def test_labels_that_are_not_finite_are_refused(self):
        made_up_file(self.path("a.hemi"), 2)
        with open(self.path("a.hemi"), "r+b") as file:
            file.seek(HEADER.size + EXAMPLE_BYTES + 8)
            file.write(struct.pack("<f", float("nan")))
        self.expect_error("w of example 1 is not finite")


class Batches(WithFolder):
    def batches(self, position=(0, 0, 0), rank=0, ranks=1):
        result = examples.Batches(self.folder, 2, 4, 5, "parabolic", rank, ranks)
        result.position = position
        return result

    def setUp(self):
        super().setUp()
        for number in (1, 2):
            made_up_file(examples.shard_path(self.folder, number), 10, seed=number)

    def test_symmetries_are_those_of_a_square(self):
        self.assertEqual(len({tuple(way) for way in examples.SYMMETRIES}), 8)
        middle = SIDE * SIDE // 2
        for way in examples.SYMMETRIES:
            self.assertEqual(sorted(way), list(range(SIDE * SIDE)))
            self.assertEqual(way[middle], middle)
            self.assertIn(way[0], (0, SIDE - 1, SIDE * (SIDE - 1), SIDE * SIDE - 1))

    def test_images_are_turned_each_on_its_own(self):
        image = np.arange(SIDE * SIDE, dtype=np.float32)
        images = np.broadcast_to(image[:, None], (1, 400, SIDE * SIDE, CHANNELS))
        turned = examples.turned(images, np.random.default_rng(1))
        self.assertEqual({tuple(each[:, 1]) for each in turned[0]}, {tuple(way) for way in examples.SYMMETRIES})

    def test_an_interrupted_pass_goes_on(self):
        source = self.batches()
        stream = iter(source)
        for _ in range(6):  # of 2 + 2 a pass
            next(stream)
        resumed = iter(self.batches(source.position))
        for _ in range(5):
            images, w, random = next(stream)
            again_images, again_w, again_random = next(resumed)
            np.testing.assert_array_equal(images, again_images)
            np.testing.assert_array_equal(w, again_w)
            self.assertEqual(random.integers(1 << 30), again_random.integers(1 << 30))

    def test_waiting_for_a_file_ends_when_asked_to(self):
        os.remove(examples.shard_path(self.folder, 1))
        source = self.batches()
        source.stop.append(True)
        with self.assertRaises(examples.Stopped):
            next(iter(source))
        self.assertEqual(source.position, (0, 0, 0))

    def test_processes_share_the_files(self):
        seen = [next(iter(self.batches(rank=rank, ranks=2)))[1] for rank in (0, 1)]
        for rank, w in enumerate(seen):
            labels = ExampleFile(examples.shard_path(self.folder, rank + 1)).labels()["w"]
            self.assertTrue(all(any(np.array_equal(row, known) for known in labels) for row in w))
        with self.assertRaisesRegex(ExampleFileError, "too few"):
            next(iter(self.batches(rank=2, ranks=3)))

    def test_files_of_another_map_are_refused(self):
        made_up_file(examples.shard_path(self.folder, 1), 10, map=1)
        with self.assertRaisesRegex(ExampleFileError, "map is orthogonal, the network is for parabolic"):
            next(iter(self.batches()))


class Network(WithFolder):
    def test_has_as_many_parameters_as_documented(self):
        network = hemi_network.HemiNetwork()
        self.assertEqual(sum(values.numel() for values in network.parameters()), 71895)

    def test_the_order_of_samples_does_not_matter_nor_do_copies(self):
        torch.manual_seed(1)
        network = hemi_network.HemiNetwork()
        images = torch.rand(2, SAMPLES, SIDE, SIDE, CHANNELS)
        torch.testing.assert_close(network(images), network(images[:, torch.randperm(SAMPLES)]))
        one = images[:, :1]
        torch.testing.assert_close(network(one), network(one.expand(-1, SAMPLES, -1, -1, -1)))

    def test_the_loss_is_that_of_the_paper(self):
        weights = hemi_network.loss_weights(0.1, 0.3)
        estimate, truth = torch.tensor([[1.0, 2, 3, 4, 5, 6, 7]]), torch.zeros(1, 7)
        by_hand = 0.1 * ((0.3 * 1) ** 2 + 2**2 + 3**2) + 4**2 + 5**2 + 6**2 + 7**2
        self.assertAlmostEqual(float(hemi_network.loss(estimate, truth, weights)), by_hand, places=4)

    def test_materials_come_back_from_perceptual_parameters(self):
        # L*, a*, b*, c and d of (kd, ks, alpha) by hand.
        w = [[0.49496, 0, 0, 0.0, 0.0, 0.0, 0.9], [0.50105, 0.39651, 0.18995, 0, 0, 0, 2]]
        kd, ks, alpha = hemi_network.material_of(w)
        np.testing.assert_allclose(kd, [[0.18] * 3, [0.5, 0.1, 0.1]], atol=2e-4)
        np.testing.assert_allclose(ks, 0, atol=1e-6)
        np.testing.assert_allclose(alpha, [0.1, 0.01])
        grey = 1.16 * np.cbrt(0.193) - 0.16
        _, ks, alpha = hemi_network.material_of([[grey, 0, 0, 0.08702, 0.08702, 0.08702, 0.93]])
        np.testing.assert_allclose(ks, 0.066, atol=1e-4)
        np.testing.assert_allclose(alpha, 0.07)

    def test_tensors_survive_their_file(self):
        path = self.path("a.safetensors")
        network = hemi_network.HemiNetwork()
        tensor_file.write_tensors(path, network.tensors(), {"network": hemi_network.description("parabolic")})
        tensors, metadata = tensor_file.read_tensors(path)
        self.assertEqual(tensors.keys(), network.tensors().keys())
        for name, values in network.tensors().items():
            np.testing.assert_array_equal(tensors[name], values)
        self.assertEqual(json.loads(metadata["network"])["input"], [SAMPLES, SIDE, SIDE, CHANNELS])
        with self.assertRaisesRegex(ValueError, "b is not finite"):
            tensor_file.write_tensors(path, {"b": np.array([np.inf])}, {})
        self.assertEqual(os.listdir(self.folder), ["a.safetensors"])


class Validation(unittest.TestCase):
    def test_errors_are_those_of_the_materials(self):
        truth = np.zeros(4, dtype=LABEL)
        truth["ks"] = np.array([0, 0.1, 0.2, 0.3])[:, None]
        truth["alpha"] = [0.1, 0.2, 0.3, 0.4]
        found = validate.errors(truth["kd"] + 0.05, truth["ks"] + [0, 0.1, 0.2], truth["alpha"] + [9, 0, 0.1, 0.2],
                                truth)
        np.testing.assert_allclose(found["kd"], 0.05, rtol=1e-5)
        np.testing.assert_allclose(found["ks"], [0, 0.1, 0.2], atol=1e-6)
        self.assertAlmostEqual(found["alpha"], 0.1, places=5, msg="the first has no gloss")


class Training(WithFolder):
    def options(self, work, total, precision="f32"):
        return types.SimpleNamespace(
            data=self.folder, shards=2, validation=examples.shard_path(self.folder, 3), work=self.path(work),
            export=None, examples=total, batch=4, least_samples=2, rate=3e-3, seed=1, map="parabolic", lambda_d=0.1,
            lambda_l=0.3, average=0.5, checkpoint_every=5, validate_every=5, threads=1,
            precision=precision)

    def trained(self, work, interrupt=None, precision="f32"):
        os.makedirs(self.path(work), exist_ok=True)
        training = train.Training(self.options(work, 120, precision))
        training.resume()
        stop_at = interrupt or training.steps()
        batches = iter(training.batches)
        while training.step < stop_at:
            training.learn(*next(batches))
        training.save()
        return training

    def setUp(self):
        super().setUp()
        for number in (1, 2, 3):
            made_up_file(examples.shard_path(self.folder, number), 20, seed=number)

    def test_an_interrupted_training_ends_as_if_it_had_not_been(self):
        whole = self.trained("whole")
        self.trained("parts", interrupt=13)
        parts = self.trained("parts")
        for name, values in whole.mean.items():
            self.assertTrue(torch.equal(values, parts.mean[name]), name)

    def test_it_learns(self):
        fresh = train.Training(self.options("fresh", 120))
        for precision in ("f32", "bf16"):
            with self.subTest(precision):
                training = self.trained(f"learns in {precision}", precision=precision)
                self.assertLess(training.loss_of(training.estimates()), 0.5 * fresh.loss_of(fresh.estimates()))

    def test_exports_what_its_own_check_asks_for(self):
        training = self.trained("exports")
        training.options.export = self.path("exported.safetensors")
        train.finish(training)
        tensors, metadata = tensor_file.read_tensors(training.options.export)
        network = hemi_network.HemiNetwork()
        network.load_state_dict({name: torch.from_numpy(values.copy()) for name, values in tensors.items()})
        np.testing.assert_allclose(train.check_outputs(network), json.loads(metadata["check"]), rtol=1e-6)
        self.assertEqual(json.loads(metadata["training"])["examples_seen"], 120)
        for name in ("report.txt", "ks.svg", "alpha.svg"):
            self.assertTrue(os.path.exists(os.path.join(training.options.work, name)), name)


if __name__ == "__main__":
    torch.set_num_threads(1)
    unittest.main()
