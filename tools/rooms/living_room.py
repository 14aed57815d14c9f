"""A living room of 5.4 x 4.2 x 2.7 m: two windows, four lamps in the ceiling and a standing one that pictures show,
a dark floor with gloss, a teal wall, a wall mirror, books."""
import math
import random

from room import Material, speckled, wood

EXPOSURE = 4.0


def _books(room, random_numbers, low, length, height):
    """Books of their own colours in a row along y, from low on."""
    y = low[1]
    while y < low[1] + length - 0.08:
        width = random_numbers.uniform(0.02, 0.06)
        tall = height * random_numbers.uniform(0.7, 0.95)
        hue = [random_numbers.uniform(0.03, 0.6) for _ in range(3)]
        name = f"book {len(room.things)}"
        room.box(name, (low[0], y, low[2]), (low[0] + random_numbers.uniform(0.16, 0.22), y + width, low[2] + tall),
                 Material(name, hue, 0.03, 0.25))
        y += width + 0.002


def build(room, sky):
    paint = Material("white paint", (0.8, 0.79, 0.76))
    teal = Material("teal paint", (0.1, 0.3, 0.32))
    floor = Material("floor boards", wood((0.16, 0.085, 0.045), (0.1, 0.05, 0.028), 2), 0.04, 0.12)
    oak = Material("oak", wood((0.36, 0.22, 0.11), (0.26, 0.15, 0.07)), 0.03, 0.2)
    white_wood = Material("white lacquer", (0.76, 0.76, 0.74), 0.04, 0.1)
    wool = Material("grey wool", speckled((0.2, 0.2, 0.21), (0.28, 0.28, 0.28), 60))
    leather = Material("leather", (0.2, 0.085, 0.04), 0.04, 0.2)
    black = Material("black gloss", (0.015, 0.015, 0.016), 0.05, 0.05)
    steel = Material("steel", (0.04, 0.04, 0.04), (0.56, 0.55, 0.53), 0.15)
    mirror = Material("mirror", (0.02, 0.02, 0.02), (0.88, 0.88, 0.88), 0.05)
    linen = Material("linen", (0.6, 0.57, 0.5))
    leaves = Material("leaves", (0.05, 0.16, 0.04), 0.04, 0.15)
    rug = Material("rug", speckled((0.55, 0.5, 0.42), (0.3, 0.12, 0.1), 8))

    room.box("floor", (0, 0, -0.1), (5.4, 4.2, 0), floor)
    room.box("ceiling", (0, 0, 2.7), (5.4, 4.2, 2.8), Material("ceiling", (0.84, 0.84, 0.83)))
    room.box("teal wall", (-0.1, 4.2, 0), (5.5, 4.3, 2.7), teal)
    room.box("wall left", (-0.1, 0, 0), (0, 4.2, 2.7), paint)
    room.box("wall front", (-0.1, -0.1, 0), (5.5, 0, 2.7), paint)
    # Two windows in one wall: two parts of it, each with an opening.
    room.wall_with_opening("wall right", (5.4, 0, 0), (5.55, 2.1, 2.7), (0.5, 1.7), (0.5, 2.3), 0, paint)
    room.wall_with_opening("wall right too", (5.4, 2.1, 0), (5.55, 4.2, 2.7), (2.5, 3.7), (0.5, 2.3), 0, paint)
    for y in (1.1, 3.1):
        room.portal((5.48, y, 1.4), (1.8, 1.2), (-1, 0, 0))
        room.parts(f"window bars {y}", [((5.44, y - 0.02, 0.5), (5.48, y + 0.02, 2.3)),
                                        ((5.44, y - 0.6, 1.38), (5.48, y + 0.6, 1.42))], white_wood)
    room.sky(sky, 0.4, 60)
    room.cloth("curtain", (5.32, 1.8, 0.05), (5.32, 2.4, 2.55), linen)

    # A sofa at the teal wall, an armchair, a table between them.
    room.parts("sofa", [((1.4, 3.3, 0.1), (3.5, 4.1, 0.42)), ((1.4, 3.85, 0.42), (3.5, 4.15, 0.85)),
                        ((1.3, 3.3, 0.1), (1.5, 4.1, 0.62)), ((3.4, 3.3, 0.1), (3.6, 4.1, 0.62))], wool)
    for i, (x, colour) in enumerate(((1.75, (0.62, 0.36, 0.06)), (2.2, (0.7, 0.68, 0.62)), (3.1, (0.1, 0.28, 0.3)))):
        room.ball(f"cushion {i}", (x, 3.75, 0.62), 0.22, Material(f"cushion {i}", colour), (1, 0.45, 0.9))
    room.parts("armchair", [((4.2, 2.2, 0.12), (4.95, 2.95, 0.42)), ((4.8, 2.2, 0.42), (4.98, 2.95, 0.95)),
                            ((4.2, 2.12, 0.12), (4.95, 2.24, 0.6)), ((4.2, 2.91, 0.12), (4.95, 3.03, 0.6))], leather)
    room.box("rug", (1.2, 1.7, 0), (4.0, 3.2, 0.012), rug)
    room.box("table top", (1.9, 2.1, 0.36), (3.1, 2.8, 0.4), black, 0.005)
    room.parts("table legs", [((x, y, 0.012), (x + 0.04, y + 0.04, 0.36)) for x in (1.95, 3.01) for y in (2.15, 2.71)],
               steel)
    room.cylinder("bowl", (2.3, 2.5, 0.4), 0.07, 0.08, Material("blue glaze", (0.08, 0.16, 0.42), 0.05, 0.08), 0.14)
    room.ball("pear", (2.75, 2.35, 0.45), 0.05, Material("pear", (0.5, 0.5, 0.1), 0.04, 0.2), (1, 1, 1.2))
    room.box("magazine", (2.6, 2.55, 0.4), (2.82, 2.75, 0.41), Material("magazine", (0.6, 0.1, 0.12), 0.04, 0.1), 0, 0.3)

    # Shelves with books on the left, a screen that is off on the wall towards the viewer.
    room.parts("shelves", [((0.0, 1.0, z), (0.26, 3.0, z + 0.03)) for z in (0.1, 0.5, 0.9, 1.3, 1.7, 2.1)] +
               [((0.0, y, 0.1), (0.26, y + 0.03, 2.13)) for y in (0.97, 2.0, 3.0)], oak)
    random_numbers = random.Random(5)
    for row, (y, length) in ((0.13, (1.02, 0.9)), (0.53, (2.05, 0.7)), (0.93, (1.02, 0.6)), (0.93, (2.05, 0.9)),
                             (1.33, (1.05, 0.8)), (1.73, (2.1, 0.5))):
        _books(room, random_numbers, (0.02, y, row), length, 0.36)
    room.monkey("bronze figure", (0.15, 2.75, 1.45), 0.24, Material("bronze", (0.03, 0.02, 0.012), (0.5, 0.32, 0.16), 0.2),
                1.57)
    room.ball("vase", (0.14, 1.4, 1.87), 0.13, Material("white glaze", (0.75, 0.74, 0.7), 0.05, 0.08), (1, 1, 1.2))
    room.box("low board", (1.3, 0.02, 0.1), (3.5, 0.45, 0.5), white_wood, 0.008)
    room.box("screen", (1.7, 0.02, 0.75), (3.1, 0.07, 1.55), black, 0.004)
    room.cylinder("speaker", (1.45, 0.25, 0.5), 0.08, 0.25, Material("red plastic", (0.45, 0.04, 0.03), 0.05, 0.15))
    room.box("door", (4.2, -0.02, 0), (5.05, 0.03, 2.05), Material("door", (0.62, 0.63, 0.62), 0.04, 0.12), 0.004)
    room.ball("door knob", (4.3, 0.08, 1.0), 0.035, steel)

    # On the teal wall: a mirror and two pictures; plants, the standing lamp.
    room.box("mirror frame", (3.9, 4.17, 0.9), (4.7, 4.205, 2.1), oak)
    room.box("mirror", (3.95, 4.16, 0.95), (4.65, 4.172, 2.05), mirror)
    for i, x in enumerate((1.5, 2.6)):
        room.box(f"frame {i}", (x, 4.175, 1.3), (x + 0.8, 4.205, 1.9), white_wood)
        room.box(f"picture {i}", (x + 0.05, 4.17, 1.35), (x + 0.75, 4.178, 1.85),
                 Material(f"print {i}", speckled((0.7, 0.62, 0.4), (0.2 * i, 0.12, 0.3), 5)))
    room.cylinder("pot", (5.0, 3.8, 0), 0.17, 0.32, Material("terracotta", (0.45, 0.2, 0.12)), 0.2)
    for i in range(5):
        room.ball(f"leaf {i}", (5.0 + 0.16 * math.cos(1.3 * i), 3.8 + 0.16 * math.sin(1.3 * i), 0.55 + 0.13 * i), 0.16,
                  leaves, (1, 0.7, 1.2))
    room.cylinder("lamp foot", (0.6, 3.7, 0), 0.14, 0.02, steel)
    room.cylinder("lamp pole", (0.6, 3.7, 0.02), 0.014, 1.5, steel)
    room.cylinder("standing lampshade", (0.6, 3.7, 1.5), 0.22, 0.28, Material("shade", (0.72, 0.66, 0.5)), 0.16,
                  open_ends=True)
    room.bulb((0.6, 3.7, 1.62), 0.04, (0.9, 0.72, 0.48))
    for x in (1.6, 3.8):
        for y in (1.2, 3.0):
            room.disc((x, y, 2.69), 0.08, (0.8, 0.72, 0.6))
    room.box("basket", (4.5, 1.3, 0), (4.85, 1.65, 0.35), Material("wicker", speckled((0.42, 0.28, 0.14), (0.3, 0.18, 0.08), 50)))


PATH = [((4.6, 0.9, 1.5), (2.0, 3.0, 0.8)), ((4.0, 1.0, 1.5), (1.8, 4.0, 1.1)), ((3.0, 1.2, 1.45), (3.6, 4.1, 1.0)),
        ((2.4, 1.4, 1.4), (4.9, 3.4, 0.9)), ((1.8, 1.8, 1.5), (5.2, 1.6, 1.2)), ((1.4, 2.4, 1.5), (4.2, 0.3, 1.0)),
        ((1.6, 3.0, 1.55), (2.4, 0.2, 0.9)), ((2.6, 3.1, 1.5), (0.4, 0.8, 1.0)), ((3.4, 2.9, 1.45), (0.2, 2.2, 1.1)),
        ((3.6, 1.8, 1.5), (0.4, 3.4, 1.1)), ((3.2, 1.0, 1.6), (1.6, 3.6, 1.6)), ((3.0, 0.9, 1.3), (3.0, 3.6, 0.3)),
        ((3.4, 0.7, 1.5), (4.6, 3.9, 1.2))]
