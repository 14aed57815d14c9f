"""A kitchen of 4.6 x 3.8 x 2.5 m: a ceiling lamp that no picture shows, two bulbs in shades over the table, a hidden
tube under the wall cabinets, a window, much white beside a fridge of steel."""
import math

from room import Material, speckled, tiled, wood

EXPOSURE = 1.0


def build(room, sky):
    white = Material("white paint", (0.76, 0.75, 0.72))
    ceiling = Material("ceiling", (0.82, 0.82, 0.81))
    floor = Material("floor", tiled((0.33, 0.27, 0.22), (0.2, 0.2, 0.19), 0.45, 0.45), 0.03, 0.2)
    upright = (math.pi / 2, 0, 0)
    wall_tiles = Material("wall tiles", tiled((0.72, 0.74, 0.72), (0.45, 0.45, 0.44), 0.15, 0.15, upright), 0.05, 0.08)
    lacquer = Material("red lacquer", (0.42, 0.05, 0.04), 0.05, 0.1)
    cream = Material("cream lacquer", (0.66, 0.6, 0.48), 0.04, 0.15)
    granite = Material("granite", speckled((0.05, 0.05, 0.055), (0.17, 0.16, 0.16), 60), 0.06, 0.08)
    steel = Material("steel", (0.04, 0.04, 0.04), (0.56, 0.55, 0.53), 0.18)
    brass = Material("brass", (0.03, 0.025, 0.01), (0.72, 0.55, 0.26), 0.15)
    oak = Material("oak", wood((0.36, 0.22, 0.11), (0.24, 0.13, 0.06)), 0.03, 0.2)
    black = Material("black plastic", (0.025, 0.025, 0.028), 0.05, 0.1)
    shade = Material("lamp shade", (0.12, 0.3, 0.26))
    rug = Material("rug", speckled((0.35, 0.12, 0.1), (0.2, 0.08, 0.12), 12))
    turquoise = Material("turquoise glaze", (0.1, 0.4, 0.38), 0.06, 0.08)
    picture = Material("print", speckled((0.7, 0.6, 0.3), (0.1, 0.25, 0.45), 5))
    cork = Material("cork", speckled((0.45, 0.3, 0.17), (0.36, 0.22, 0.12), 80))
    china = Material("china", (0.75, 0.75, 0.73), 0.05, 0.06)

    room.box("floor", (0, 0, -0.1), (4.6, 3.8, 0), floor)
    room.box("ceiling", (0, 0, 2.5), (4.6, 3.8, 2.6), ceiling)
    room.box("wall back", (-0.1, 3.8, 0), (4.7, 3.9, 2.5), white)
    room.box("wall left", (-0.1, 0, 0), (0, 3.8, 2.5), white)
    room.box("wall front", (-0.1, -0.1, 0), (4.7, 0, 2.5), white)
    room.wall_with_opening("wall right", (4.6, 0, 0), (4.7, 3.8, 2.5), (1.2, 2.6), (1.0, 2.1), 0, white)
    frame = Material("window frame", (0.7, 0.7, 0.7), 0.04, 0.1)
    room.parts("window frame", [((4.6, 1.15, 0.95), (4.68, 2.65, 1.0)), ((4.6, 1.15, 2.1), (4.68, 2.65, 2.15)),
                                ((4.6, 1.15, 1.0), (4.68, 1.2, 2.1)), ((4.6, 2.6, 1.0), (4.68, 2.65, 2.1)),
                                ((4.63, 1.88, 1.0), (4.67, 1.92, 2.1))], frame)
    room.box("window sill", (4.42, 1.1, 0.92), (4.6, 2.7, 0.95), oak)
    room.portal((4.65, 1.9, 1.55), (1.4, 1.1), (-1, 0, 0))
    room.sky(sky, 1.5, 200)

    # The long counter along the back wall.
    room.box("tiles over counter", (0.7, 3.79, 0.9), (4.0, 3.802, 1.45), wall_tiles)
    for i in range(5):
        front = lacquer if i != 2 else black
        room.box(f"front {i}", (0.72 + 0.62 * i, 3.2, 0.1), (1.32 + 0.62 * i, 3.78, 0.86), front, 0.008)
        room.box(f"handle {i}", (0.9 + 0.62 * i, 3.165, 0.74), (1.15 + 0.62 * i, 3.18, 0.755), steel)
    room.box("worktop", (0.7, 3.16, 0.86), (4.0, 3.79, 0.9), granite, 0.004)
    for i in range(4):
        room.box(f"wall cabinet {i}", (0.72 + 0.62 * i, 3.45, 1.47), (1.32 + 0.62 * i, 3.79, 2.15), cream, 0.006)
    room.tube((0.9, 3.55, 1.455), (3.0, 3.57, 1.465), (0.7, 0.62, 0.5))
    room.box("tube cover", (0.85, 3.44, 1.42), (3.05, 3.45, 1.47), cream)
    room.box("hood", (3.3, 3.4, 1.6), (3.9, 3.79, 1.75), steel, 0.01)
    room.box("hood pipe", (3.48, 3.55, 1.75), (3.72, 3.79, 2.5), steel)
    # Fridge, flush with nothing, beside the counter.
    room.box("fridge", (0.02, 3.1, 0.02), (0.66, 3.78, 1.85), steel, 0.02)
    room.box("fridge handle", (0.57, 3.06, 0.9), (0.6, 3.08, 1.5), black)
    room.cylinder("pot", (3.55, 3.45, 0.9), 0.12, 0.15, steel)
    room.cylinder("kettle", (3.0, 3.5, 0.9), 0.09, 0.2, brass, 0.06)
    room.cylinder("jar", (1.1, 3.55, 0.9), 0.06, 0.18, Material("blue glaze", (0.06, 0.13, 0.36), 0.05, 0.06))
    room.box("bread box", (1.5, 3.4, 0.9), (1.9, 3.7, 1.08), oak, 0.03)
    room.box("book", (2.2, 3.4, 0.9), (2.45, 3.6, 0.94), Material("yellow cover", (0.7, 0.52, 0.08), 0.03, 0.2))

    # A tall cupboard and shelf on the left.
    room.box("cupboard", (0.0, 0.3, 0.0), (0.55, 1.5, 2.1), cream, 0.008)
    room.box("cupboard line", (0.551, 0.895, 0.02), (0.556, 0.905, 2.08), black)
    room.box("shelf", (0.0, 1.75, 1.2), (0.28, 2.8, 1.235), oak)
    room.monkey("green figure", (0.15, 1.95, 1.33), 0.22, Material("green glaze", (0.08, 0.3, 0.12), 0.06, 0.1), 1.57)
    room.ball("orange vase", (0.15, 2.3, 1.36), 0.12, Material("orange glaze", (0.62, 0.25, 0.05), 0.05, 0.15))
    room.cylinder("tin", (0.14, 2.6, 1.235), 0.07, 0.2, steel)
    room.box("picture frame", (0.0, 1.9, 1.55), (0.02, 2.6, 2.1), black)
    room.box("picture", (0.018, 1.95, 1.6), (0.024, 2.55, 2.05), picture)

    # Table with chairs in the middle.
    room.parts("table", [((1.5, 1.2, 0.7), (3.1, 2.1, 0.74))] +
               [((x, y, 0), (x + 0.06, y + 0.06, 0.7)) for x in (1.55, 2.99) for y in (1.25, 1.99)], oak)
    for i, (x, y, back) in enumerate(((1.8, 0.85, 0.85), (2.5, 0.85, 0.85), (1.8, 2.1, 2.46), (2.5, 2.1, 2.46))):
        room.parts(f"chair {i}", [((x, y, 0.42), (x + 0.4, y + 0.4, 0.46)),
                                  ((x, back, 0.46), (x + 0.4, back + 0.04, 0.9))] +
                   [((x + u, y + v, 0), (x + u + 0.04, y + v + 0.04, 0.42)) for u in (0, 0.36) for v in (0, 0.36)],
                   black if i % 2 else Material("blue paint", (0.1, 0.2, 0.4), 0.03, 0.2))
    room.cylinder("plate", (1.9, 1.5, 0.74), 0.13, 0.015, china, bevel=0.005)
    room.cylinder("cup", (2.15, 1.75, 0.74), 0.045, 0.09, china, 0.05)
    room.ball("apple", (2.45, 1.5, 0.785), 0.045, Material("apple", (0.45, 0.07, 0.05), 0.05, 0.1))
    room.ball("lemon", (2.56, 1.58, 0.775), 0.035, Material("lemon", (0.72, 0.6, 0.08), 0.04, 0.15), (1.3, 1, 1))
    room.cylinder("bowl", (2.75, 1.75, 0.74), 0.07, 0.08, turquoise, 0.13)
    room.box("napkin", (1.62, 1.7, 0.74), (1.8, 1.95, 0.746), Material("linen", (0.5, 0.44, 0.55)))
    room.box("rug", (1.2, 0.25, 0), (3.4, 2.9, 0.012), rug)
    for x, intensity in ((1.95, (1.43, 1.18, 0.88)), (2.65, (1.43, 1.18, 0.88))):
        room.cylinder(f"shade {x}", (x, 1.65, 1.75), 0.16, 0.17, shade, 0.07, open_ends=True)
        room.box(f"cable {x}", (x - 0.004, 1.646, 1.92), (x + 0.004, 1.654, 2.5), black)
        room.bulb((x, 1.65, 1.79), 0.025, intensity)
    room.bulb((3.4, 2.0, 2.38), 0.035, (2.80, 2.31, 1.72))

    # The wall towards the viewer: door, radiator, plant.
    room.box("door", (3.4, -0.02, 0), (4.3, 0.03, 2.05), Material("door", (0.62, 0.63, 0.62), 0.04, 0.12), 0.004)
    room.ball("door knob", (3.5, 0.08, 1.0), 0.035, brass)
    room.box("board", (1.2, 0.0, 1.1), (2.4, 0.02, 1.9), cork)
    room.box("note 1", (1.35, 0.018, 1.5), (1.55, 0.024, 1.75), Material("paper", (0.8, 0.8, 0.78)))
    room.box("note 2", (1.8, 0.018, 1.3), (2.05, 0.024, 1.5), Material("pink paper", (0.75, 0.4, 0.45)))
    room.parts("radiator", [((4.5, 1.25 + 0.1 * i, 0.15), (4.58, 1.32 + 0.1 * i, 0.8)) for i in range(13)],
               Material("radiator", (0.74, 0.74, 0.72), 0.05, 0.15))
    room.cylinder("plant pot", (4.2, 3.3, 0), 0.16, 0.3, Material("terracotta", (0.45, 0.2, 0.12)), 0.19)
    room.ball("plant", (4.2, 3.3, 0.62), 0.28, Material("leaves", (0.07, 0.2, 0.05), 0.03, 0.2), (1, 1, 1.2))
    room.box("bin", (4.15, 0.3, 0), (4.45, 0.6, 0.55), steel, 0.02)


# Where the camera is, and what it looks at. No picture shows the lamp under the ceiling.
PATH = [((3.9, 0.6, 1.45), (1.2, 2.6, 0.9)), ((3.9, 1.3, 1.5), (1.0, 3.2, 1.1)), ((3.5, 1.6, 1.4), (1.6, 3.7, 1.1)),
        ((3.3, 2.4, 1.4), (2.6, 3.8, 1.15)), ((2.4, 2.7, 1.45), (0.3, 3.3, 1.0)), ((1.2, 2.6, 1.4), (0.1, 1.8, 1.2)),
        ((1.0, 2.2, 1.5), (1.6, 0.2, 1.0)), ((0.9, 2.6, 1.45), (3.2, 0.8, 0.7)), ((1.0, 2.7, 1.5), (4.5, 1.9, 1.1)),
        ((1.0, 0.7, 1.5), (3.0, 2.4, 0.7)), ((1.0, 0.5, 1.4), (3.9, 3.4, 1.0))]
