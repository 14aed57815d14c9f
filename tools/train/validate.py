"""How far estimates are from the truth on held-out examples, beside the constant that does best."""

import numpy as np
import torch

from example_file import SIDE
from hemi_network import material_of

LEAST_KS = 0.02  # below it there is nothing that a roughness could show in


def estimates(network, images, device, batch=256):
    """w of images [example][sample][pixel][channel]."""
    network.eval()
    results = []
    with torch.no_grad():
        for begin in range(0, len(images), batch):
            part = torch.from_numpy(images[begin : begin + batch]).to(device).float().unflatten(2, (SIDE, SIDE))
            results.append(network(part).cpu().numpy())
    network.train()
    return np.concatenate(results)


def errors(kd, ks, alpha, truth):
    """Mean absolute errors: kd and ks per channel, alpha where ks is at least LEAST_KS."""
    glossy = truth["ks"].mean(axis=1) >= LEAST_KS
    off = np.abs(alpha - truth["alpha"])
    return {
        "kd": np.abs(kd - truth["kd"]).mean(axis=0),
        "ks": np.abs(ks - truth["ks"]).mean(axis=0),
        "alpha": float(off[glossy].mean()) if glossy.any() else float("nan"),
    }


def constant_errors(truth):
    """Of the medians, the constants with the least mean absolute errors."""
    glossy = truth["ks"].mean(axis=1) >= LEAST_KS
    alpha = np.median(truth["alpha"][glossy]) if glossy.any() else 0.0
    return errors(np.median(truth["kd"], axis=0), np.median(truth["ks"], axis=0), alpha, truth)


def groups(truth):
    """Parts of the examples by what lights them."""
    return {
        "all": np.ones(len(truth), dtype=bool),
        "lamps": truth["windows"] == 0,
        "environment": truth["windows"] > 0,
    }


def table(w, truth):
    """Lines of text, and the errors of all by name."""
    kd, ks, alpha = material_of(w)
    lines = [f"{'':24} {'kd':>7} {'ks':>7} {'alpha':>7}   examples"]
    figures = {}
    for name, part in groups(truth).items():
        if not part.any():
            continue
        for who, found in ((name, errors(kd[part], ks[part], alpha[part], truth[part])),
                           (f"{name}, a constant", constant_errors(truth[part]))):
            means = {key: float(np.mean(value)) for key, value in found.items()}
            figures[who] = means
            lines.append(f"{who:24} {means['kd']:7.4f} {means['ks']:7.4f} {means['alpha']:7.4f}   {int(part.sum())}")
    return "\n".join(lines), figures
