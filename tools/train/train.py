"""Trains HemiCNN on files that `patina synth-hemi` wrote and exports its weights (docs/guide/training.md).

One process trains on one device; `torchrun --nproc-per-node N train.py ...` on several. It goes on from its last
checkpoint, and stops early on SIGINT or SIGTERM with a checkpoint.
"""

import argparse
import json
import math
import os
import signal
import subprocess
import sys
import time

import numpy as np
import torch

import report
import validate
from example_file import MAPS, SAMPLES, SIDE, ExampleFile, ExampleFileError
from examples import Batches, Stopped
from hemi_network import HemiNetwork, description, loss, loss_weights
from tensor_file import write_tensors

WARM_UP = 300  # steps at most, over which the learning rate rises


def arguments():
    parser = argparse.ArgumentParser(description="Trains HemiCNN")
    add = parser.add_argument
    add("--data", required=True, help="folder of 0001.hemi, 0002.hemi, ...; waits for what is not there yet")
    add("--shards", type=int, required=True, help="how many files there are, or will be")
    add("--validation", required=True, help="file of examples that are never trained on")
    add("--work", required=True, help="folder for checkpoint, report and plots")
    add("--export", help="weight file to write at the end")
    add("--examples", type=int, default=3_000_000, help="that are seen in all, repetitions included")
    add("--batch", type=int, default=32, help="examples of a step and a process")
    add("--least-samples", type=int, default=8, help="a step looks at so many to 25 of an example's HemiImages")
    add("--rate", type=float, default=1e-3, help="learning rate at its highest; it falls with a cosine to a hundredth")
    add("--seed", type=int, default=1)
    add("--map", choices=MAPS, default="parabolic")
    add("--lambda-d", type=float, default=0.1, help="Eq. 5; Kim et al.: 1")
    add("--lambda-l", type=float, default=0.3, help="Eq. 5; Kim et al.: 1")
    add("--average", type=float, default=0.999, help="of the running mean of weights, which is what is exported")
    add("--checkpoint-every", type=int, default=500, help="steps")
    add("--validate-every", type=int, default=1000, help="steps, on a part of the validation file")
    add("--threads", type=int, default=1, help="of a process on a CPU")
    add("--precision", choices=("bf16", "f32"), default="bf16", help="of activations; weights and what is measured are "
        "f32. bf16 is three times as fast on CPUs that have AVX-512 BF16, and slow on those that do not")
    add("--export-only", action="store_true", help="report and export what the checkpoint holds; trains nothing")
    return parser.parse_args()


class Training:
    """Everything that a checkpoint holds, and what makes it go on."""

    def __init__(self, options):
        self.options = options
        self.ranks = int(os.environ.get("WORLD_SIZE", 1))
        self.rank = int(os.environ.get("RANK", 0))
        local = int(os.environ.get("LOCAL_RANK", 0))
        self.device = torch.device("cuda", local) if torch.cuda.is_available() else torch.device("cpu")
        if self.ranks > 1:
            torch.distributed.init_process_group("nccl" if self.device.type == "cuda" else "gloo")
        torch.manual_seed(options.seed)
        self.network = HemiNetwork().to(self.device)
        self.mean = {name: values.clone() for name, values in self.network.state_dict().items()}
        self.parallel = torch.nn.parallel.DistributedDataParallel(self.network) if self.ranks > 1 else self.network
        self.adam = torch.optim.Adam(self.network.parameters(), lr=options.rate)
        self.weights = loss_weights(options.lambda_d, options.lambda_l).to(self.device)
        self.batches = Batches(options.data, options.shards, options.batch, options.seed, options.map, self.rank,
                               self.ranks)
        self.validation = ExampleFile(options.validation)
        self.truth = self.validation.labels()
        self.held_out = self.validation.images()
        self.step = 0
        self.history = []  # [examples seen, training loss, validation loss, rate]
        self.checkpoint = os.path.join(options.work, "checkpoint.pt")

    @property
    def seen(self):
        return self.step * self.options.batch * self.ranks

    def steps(self):
        return -(-self.options.examples // (self.options.batch * self.ranks))

    def resume(self):
        if not os.path.exists(self.checkpoint):
            return
        state = torch.load(self.checkpoint, map_location=self.device)
        self.network.load_state_dict(state["network"])
        self.adam.load_state_dict(state["adam"])
        self.mean, self.step, self.history = state["mean"], state["step"], state["history"]
        self.batches.position = tuple(state["position"])
        print(f"goes on after {self.seen} examples", flush=True)

    def save(self):
        if self.rank != 0:
            return
        state = {"network": self.network.state_dict(), "adam": self.adam.state_dict(), "mean": self.mean,
                 "step": self.step, "history": self.history, "position": self.batches.position}
        torch.save(state, self.checkpoint + ".partial")
        os.replace(self.checkpoint + ".partial", self.checkpoint)

    def rate(self):
        share = min(self.step / self.steps(), 1)
        cosine = 0.01 + 0.99 * (0.5 + 0.5 * math.cos(math.pi * share))
        return self.options.rate * cosine * min((self.step + 1) / min(WARM_UP, 1 + self.steps() / 10), 1)

    def learn(self, images, w, random):
        """One step; its loss."""
        for group in self.adam.param_groups:
            group["lr"] = self.rate()
        # A small segment has fewer voxels than are drawn; and steps are faster.
        images = images[:, random.permutation(SAMPLES)[: random.integers(self.options.least_samples, SAMPLES + 1)]]
        images = torch.from_numpy(images).to(self.device).float().unflatten(2, (SIDE, SIDE))
        with torch.autocast(self.device.type, dtype=torch.bfloat16, enabled=self.options.precision == "bf16"):
            estimate = self.parallel(images).float()
        value = loss(estimate, torch.from_numpy(w).to(self.device), self.weights)
        self.adam.zero_grad(set_to_none=True)
        value.backward()
        self.adam.step()
        # Shorter at first, when the mean would be that of the start.
        share = max(1 - self.options.average, 1 / (self.step + 2))
        for name, values in self.network.state_dict().items():
            self.mean[name].lerp_(values, share)
        self.step += 1
        return float(value.detach())

    def averaged(self):
        """A network with the running mean of weights."""
        network = HemiNetwork().to(self.device)
        network.load_state_dict(self.mean)
        return network

    def estimates(self, most=None):
        return validate.estimates(self.averaged(), self.held_out[:most], self.device)

    def loss_of(self, w):
        return float(loss(torch.from_numpy(w), torch.from_numpy(self.truth["w"][: len(w)].copy()), self.weights.cpu()))


def commit():
    """Of the sources; '-dirty' when they were changed since."""
    try:
        text = subprocess.run(["git", "describe", "--always", "--dirty", "--abbrev=40"], capture_output=True,
                              text=True, check=True, cwd=os.path.dirname(os.path.abspath(__file__)))
        return text.stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"


def check_outputs(network, examples=2):
    """What the network makes of images that anyone can make up again: value i, of all in their order, is the upper 12
    bits of i * 2654435761 modulo 2^32, over 4096."""
    shape = (examples, SAMPLES, SIDE, SIDE, 3)
    values = (np.arange(np.prod(shape), dtype=np.uint64) * 2654435761 % 2**32 >> 20) / 4096
    with torch.no_grad():
        return network(torch.from_numpy(values.astype(np.float32).reshape(shape))).double().tolist()


def export(training, w):
    """Weights and how they came about."""
    options = training.options
    figures = validate.table(w, training.truth)[1]
    metadata = {
        "network": description(options.map),
        "commit": commit(),
        "data": json.dumps({"seeds": [1, options.shards], "generator": training.validation.generator,
                            "validation_seed": training.validation.seed,
                            "validation_examples": len(training.validation)}),
        "training": json.dumps({"seed": options.seed, "examples_seen": training.seen, "batch": options.batch,
                                "processes": training.ranks, "rate": options.rate, "least_samples": options.least_samples,
                                "lambda_d": options.lambda_d, "lambda_l": options.lambda_l,
                                "average": options.average, "of": options.examples,
                                "precision": options.precision}),
        "losses": json.dumps({"training": training.history[-1][1] if training.history else None,
                              "validation": training.loss_of(w)}),
        "mean_absolute_errors": json.dumps(figures),
        "check": json.dumps(check_outputs(training.averaged().cpu())),
    }
    write_tensors(options.export, training.averaged().tensors(), metadata)


def finish(training):
    """Report, plots, weights."""
    if training.rank != 0:
        return
    w = training.estimates()
    text, _ = validate.table(w, training.truth)
    text = (f"{training.seen} examples seen, {len(training.truth)} held out, validation loss "
            f"{training.loss_of(w):.5f}\nmean absolute errors, alpha where ks is at least {validate.LEAST_KS}\n\n{text}\n")
    print(text, flush=True)
    report.write(training.options.work, text, training.history, w, training.truth)
    if training.options.export:
        export(training, w)


def train(training):
    stop = training.batches.stop
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.append(True))
    options, recent, started, first = training.options, [], time.monotonic(), training.seen
    batches = iter(training.batches)
    while training.step < training.steps() and not stop:
        try:
            batch = next(batches)
        except Stopped:
            break
        recent.append(training.learn(*batch))
        if training.rank == 0 and training.step % options.validate_every == 0:
            held_out = training.loss_of(training.estimates(1024))
            training.history.append([training.seen, float(np.mean(recent)), held_out, training.rate()])
            pace = (training.seen - first) / (time.monotonic() - started)
            print(f"{training.seen:9} of {options.examples} examples, {pace:5.0f} a second, loss "
                  f"{np.mean(recent):.5f}, held out {held_out:.5f}", flush=True)
            recent = []
        if training.step % options.checkpoint_every == 0:
            training.save()
    training.save()


def main():
    options = arguments()
    torch.set_num_threads(options.threads)
    os.makedirs(options.work, exist_ok=True)
    try:
        training = Training(options)
        training.resume()
        if not options.export_only:
            train(training)
        finish(training)
    except ExampleFileError as error:
        sys.exit(f"train.py: {error}")


if __name__ == "__main__":
    main()
