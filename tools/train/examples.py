"""Batches of training examples from the numbered files of a folder."""

import os
import time

import numpy as np

from example_file import SIDE, ExampleFile, ExampleFileError


def symmetries():
    """The 8 ways to turn and mirror an image about its middle: [8][pixel], from where each pixel comes."""
    pixels = np.arange(SIDE * SIDE).reshape(SIDE, SIDE)
    ways = [np.rot90(image, turns) for image in (pixels, pixels.T) for turns in range(4)]
    return np.stack([way.reshape(-1) for way in ways])


SYMMETRIES = symmetries()


def turned(images, random):
    """Images [example][sample][pixel][channel], each turned and mirrored about the normal at random."""
    ways = SYMMETRIES[random.integers(len(SYMMETRIES), size=images.shape[:2])]
    return np.take_along_axis(images, ways[..., None], axis=2)


def shard_path(folder, number):
    return os.path.join(folder, f"{number:04}.hemi")


class Stopped(Exception):
    """The training was asked to stop."""


class Batches:
    """Endless batches (images, w) of the files 1 to `shards`, in passes: the first in order, the others shuffled. What
    comes does not depend on where the training was interrupted: `position` tells it."""

    def __init__(self, folder, shards, batch, seed, hemisphere_map, rank=0, ranks=1):
        self.folder, self.shards, self.batch, self.seed = folder, shards, batch, seed
        self.map, self.rank, self.ranks = hemisphere_map, rank, ranks
        self.position = (0, 0, 0)  # pass, file within it, batch within that
        self.stop = []  # not empty: nobody wants more

    def _wait_for(self, path, poll_s=1):
        """Opens a file as soon as it is there: it may still be in the making."""
        while not os.path.exists(path):
            if self.stop:
                raise Stopped
            time.sleep(poll_s)
        return ExampleFile(path)

    def _order(self, number):
        own = np.arange(1, self.shards + 1)[self.rank :: self.ranks]
        if len(own) == 0:
            raise ExampleFileError(f"{self.folder}: {self.shards} files are too few for {self.ranks} processes")
        return own if number == 0 else np.random.default_rng((self.seed, number, self.rank)).permutation(own)

    def __iter__(self):
        while True:
            number, index, begin = self.position
            for index, shard in list(enumerate(self._order(number)))[index:]:
                yield from self._of_file(number, index, int(shard), begin)
                begin = 0
            self.position = (number + 1, 0, 0)

    def _of_file(self, number, index, shard, begin):
        file = self._wait_for(shard_path(self.folder, shard))
        if file.map != self.map:
            raise ExampleFileError(f"{file.path}: map is {file.map}, the network is for {self.map}")
        images, w = file.images(), file.labels()["w"]
        order = np.random.default_rng((self.seed, number, shard)).permutation(len(file))
        for batch in range(begin, len(file) // self.batch):
            self.position = (number, index, batch + 1)
            chosen = order[batch * self.batch : (batch + 1) * self.batch]
            random = np.random.default_rng((self.seed, number, shard, batch))
            yield turned(images[chosen], random), w[chosen], random
