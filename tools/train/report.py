"""The report of a training: a table of errors, and plots as SVG."""

import csv
import os

import numpy as np

from hemi_network import material_of

WIDTH, HEIGHT, MARGIN = 520, 360, 46


class Plot:
    """Points and lines over two axes."""

    def __init__(self, title, x_label, y_label, x_range, y_range):
        self.x_range, self.y_range = x_range, y_range
        self.parts = [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" font-family="sans-serif" '
            f'font-size="11"><rect width="100%" height="100%" fill="white"/>',
            f'<text x="{WIDTH / 2}" y="16" text-anchor="middle" font-size="13">{title}</text>',
            f'<text x="{WIDTH / 2}" y="{HEIGHT - 6}" text-anchor="middle">{x_label}</text>',
            f'<text transform="translate(12 {HEIGHT / 2}) rotate(-90)" text-anchor="middle">{y_label}</text>',
        ]
        for share in np.linspace(0, 1, 6):
            x, y = x_range[0] + share * (x_range[1] - x_range[0]), y_range[0] + share * (y_range[1] - y_range[0])
            at_x, at_y = self.place(x, y)
            self.parts.append(f'<text x="{at_x:.0f}" y="{HEIGHT - MARGIN + 14}" text-anchor="middle">{x:.4g}</text>')
            self.parts.append(f'<text x="{MARGIN - 4}" y="{at_y + 4:.0f}" text-anchor="end">{y:.3g}</text>')
            self.parts.append(f'<path d="M{MARGIN} {at_y:.1f}H{WIDTH - 12}" stroke="#ddd"/>')

    def place(self, x, y):
        across = (x - self.x_range[0]) / (self.x_range[1] - self.x_range[0])
        up = (y - self.y_range[0]) / (self.y_range[1] - self.y_range[0])
        return MARGIN + across * (WIDTH - MARGIN - 12), HEIGHT - MARGIN - np.clip(up, 0, 1) * (HEIGHT - MARGIN - 26)

    def line(self, xs, ys, color, name):
        path = " ".join("{:.1f},{:.1f}".format(*self.place(x, y)) for x, y in zip(xs, ys))
        self.parts.append(f'<polyline points="{path}" fill="none" stroke="{color}"/>')
        lines = sum("polyline" in part for part in self.parts)
        self.parts.append(f'<text x="{WIDTH - 16}" y="{24 + 14 * lines}" text-anchor="end" fill="{color}">{name}</text>')

    def points(self, xs, ys, color):
        for x, y in zip(xs, ys):
            at_x, at_y = self.place(x, y)
            self.parts.append(f'<circle cx="{at_x:.1f}" cy="{at_y:.1f}" r="1.2" fill="{color}" fill-opacity="0.4"/>')

    def write(self, path):
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(self.parts) + "\n</svg>\n")


def plot_losses(path, history):
    seen, training, held_out = (np.array(column) for column in list(zip(*history))[:3])
    plot = Plot("Loss (Eq. 5)", "examples seen", "loss", (0, seen[-1]), (0, float(np.median(training) * 3)))
    plot.line(seen, training, "#c60", "training")
    plot.line(seen, held_out, "#06c", "held out")
    plot.write(path)


def plot_scatter(path, name, truth, estimate, most):
    plot = Plot(f"{name}: held-out examples", "truth", "estimate", (0, most), (0, most))
    plot.points(truth[:2000], estimate[:2000], "#06c")
    plot.line([0, most], [0, most], "#888", "")
    plot.write(path)


def write(folder, text, history, w, truth):
    """report.txt, losses.csv and .svg, ks.svg, alpha.svg."""
    with open(os.path.join(folder, "report.txt"), "w", encoding="utf-8") as file:
        file.write(text)
    if history:
        with open(os.path.join(folder, "losses.csv"), "w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([("examples", "training_loss", "held_out_loss", "rate"), *history])
        plot_losses(os.path.join(folder, "losses.svg"), history)
    _, ks, alpha = material_of(w)
    glossy = truth["ks"].mean(axis=1) >= 0.02
    plot_scatter(os.path.join(folder, "ks.svg"), "ks", truth["ks"].mean(axis=1), ks.mean(axis=1), 0.5)
    plot_scatter(os.path.join(folder, "alpha.svg"), "alpha, where ks is at least 0.02", truth["alpha"][glossy],
                 alpha[glossy], 0.5)
