"""HemiCNN, its loss, and the materials that its outputs stand for (docs/develop/specular.md)."""

import json

import numpy as np
import torch
from torch import nn

from example_file import CHANNELS, SAMPLES, SIDE

# As the weight file lists them; convolutions are 3 x 3.
LAYERS = (
    {"kind": "conv", "name": "conv1", "pad": 1, "relu": True, "outputs": 16},
    {"kind": "conv", "name": "conv2", "pad": 1, "relu": True, "outputs": 32},
    {"kind": "max_pool"},
    {"kind": "conv", "name": "conv3", "pad": 1, "relu": True, "outputs": 48},
    {"kind": "max_pool"},
    {"kind": "conv", "name": "conv4", "pad": 0, "relu": True, "outputs": 64},
    {"kind": "sample_pool"},
    {"kind": "full", "name": "full1", "relu": True, "outputs": 128},
    {"kind": "full", "name": "full2", "relu": True, "outputs": 64},
    {"kind": "full", "name": "full3", "relu": False, "outputs": 7},
)


def description(hemisphere_map):
    """The metadata `network` of the weight file."""
    layers = [{key: value for key, value in layer.items() if key != "outputs"} for layer in LAYERS]
    return json.dumps({"input": [SAMPLES, SIDE, SIDE, CHANNELS], "map": hemisphere_map, "layers": layers})


class HemiNetwork(nn.Module):
    """Images [example][sample][y][x][channel] to w [example][7]."""

    def __init__(self):
        super().__init__()
        channels = CHANNELS
        for layer in LAYERS:
            if layer["kind"] == "sample_pool":
                channels *= 2
            if layer["kind"] == "conv":
                self.add_module(layer["name"], nn.Conv2d(channels, layer["outputs"], 3, padding=layer["pad"]))
            if layer["kind"] == "full":
                self.add_module(layer["name"], nn.Linear(channels, layer["outputs"]))
            channels = layer.get("outputs", channels)
        for module in self.children():
            nn.init.kaiming_normal_(module.weight, nonlinearity="relu")
            nn.init.zeros_(module.bias)
        with torch.no_grad():  # estimates begin near the middle of what materials there are
            self.full3.weight *= 0.1
            self.full3.bias[:] = torch.tensor([0.5, 0, 0, 0.1, 0.1, 0.1, 0.8])

    def forward(self, images):
        examples, samples = images.shape[:2]
        values = images.flatten(0, 1).permute(0, 3, 1, 2)  # channels last in memory, as convolutions are fastest
        for layer in LAYERS:
            if layer["kind"] == "max_pool":
                values = nn.functional.max_pool2d(values, 2)
            elif layer["kind"] == "sample_pool":
                values = values.reshape(examples, samples, -1)
                values = torch.cat((values.mean(dim=1), values.amax(dim=1)), dim=1)
            else:
                values = getattr(self, layer["name"])(values)
                values = torch.relu(values) if layer["relu"] else values
        return values

    def tensors(self):
        """Weights and biases by the names of the weight file."""
        return {name: values.detach().cpu().numpy() for name, values in self.state_dict().items()}


def loss_weights(lambda_d, lambda_l):
    """Of the squared errors of w (paper, Eq. 5)."""
    return torch.tensor([lambda_d * lambda_l**2, lambda_d, lambda_d, 1.0, 1.0, 1.0, 1.0])


def loss(estimate, truth, weights):
    """Paper, Eq. 5, the mean over examples."""
    return ((estimate - truth) ** 2 * weights).sum(dim=1).mean()


XYZ_OF_SRGB = np.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750],
                        [0.0193339, 0.1191920, 0.9503041]])  # linear
WHITE = np.array([0.95047, 1.0, 1.08883])  # D65


def material_of(w):
    """(kd, ks, alpha) of perceptual parameters [example][7], as shaders/lib/color/perceptual.glsl limits them."""
    w = np.asarray(w, dtype=np.float64)
    y = (w[:, 0] + 0.16) / 1.16
    f = np.stack((y + w[:, 1] / 5, y, y - w[:, 2] / 2), axis=1)
    knee = 6 / 29
    t = np.where(f > knee, f**3, 3 * knee**2 * (f - 4 / 29))
    kd = (t * WHITE) @ np.linalg.inv(XYZ_OF_SRGB).T
    root = w[:, 3:6] + np.cbrt(kd / 2)
    ks = root**3 - kd / 2
    return np.clip(kd, 0, 1), np.maximum(ks, 0), np.maximum(1 - w[:, 6], 0.01)
