"""A bedroom of 4.0 x 4.4 x 2.6 m: a wide window, a lampshade, and a disc under the ceiling that no picture shows."""
import math

from room import Material, speckled, wood

EXPOSURE = 3.0


def build(room, sky):
    paint = Material("wall paint", (0.62, 0.66, 0.64))
    floor = Material("floor boards", wood((0.42, 0.28, 0.16), (0.3, 0.18, 0.09), 2), 0.03, 0.2)
    white_wood = Material("white wood", (0.74, 0.73, 0.7), 0.04, 0.15)
    walnut = Material("walnut", wood((0.16, 0.08, 0.045), (0.1, 0.05, 0.03)), 0.05, 0.12)
    linen = Material("linen", (0.7, 0.68, 0.62))
    blanket = Material("blanket", speckled((0.14, 0.22, 0.4), (0.2, 0.3, 0.48), 30))
    brass = Material("brass", (0.03, 0.025, 0.01), (0.72, 0.55, 0.26), 0.15)
    picture = Material("print", speckled((0.7, 0.65, 0.5), (0.15, 0.3, 0.3), 5))
    rug = Material("rug", speckled((0.5, 0.46, 0.38), (0.4, 0.3, 0.22), 15))
    curtain = Material("curtain", (0.5, 0.36, 0.2))

    room.box("floor", (0, 0, -0.1), (4.0, 4.4, 0), floor)
    room.box("ceiling", (0, 0, 2.6), (4.0, 4.4, 2.7), Material("ceiling", (0.82, 0.82, 0.81)))
    room.box("wall back", (-0.1, 4.4, 0), (4.1, 4.5, 2.6), paint)
    room.box("wall left", (-0.1, 0, 0), (0, 4.4, 2.6), paint)
    room.box("wall front", (-0.1, -0.1, 0), (4.1, 0, 2.6), paint)
    room.wall_with_opening("wall right", (4.0, 0, 0), (4.12, 4.4, 2.6), (1.1, 3.3), (0.8, 2.3), 0, paint)
    room.box("sill", (3.85, 1.0, 0.76), (4.0, 3.4, 0.8), white_wood)
    room.portal((4.06, 2.2, 1.55), (2.2, 1.5), (-1, 0, 0))
    room.sky(sky, 0.25, 120)
    room.cloth("curtain left", (3.9, 0.65, 0.05), (3.9, 1.15, 2.45), curtain)
    room.cloth("curtain right", (3.9, 3.25, 0.05), (3.9, 3.75, 2.45), curtain)

    # The bed, its head at the back wall.
    room.box("bed frame", (1.2, 2.2, 0.05), (2.9, 4.34, 0.32), walnut, 0.01)
    room.box("headboard", (1.15, 4.32, 0.1), (2.95, 4.39, 1.1), walnut, 0.01)
    room.box("mattress", (1.25, 2.25, 0.32), (2.85, 4.3, 0.52), linen, 0.05)
    room.box("blanket", (1.22, 2.22, 0.5), (2.88, 3.6, 0.57), blanket, 0.03)
    room.ball("pillow left", (1.65, 4.05, 0.6), 0.3, Material("pillow", (0.72, 0.72, 0.7)), (1.1, 0.6, 0.32))
    room.ball("pillow right", (2.45, 4.05, 0.6), 0.3, Material("pink pillow", (0.6, 0.3, 0.3)), (1.1, 0.6, 0.32))
    room.box("bedside table", (3.1, 3.9, 0), (3.55, 4.35, 0.5), white_wood, 0.006)
    room.cylinder("lamp foot", (3.32, 4.12, 0.5), 0.07, 0.25, brass, 0.02)
    room.cylinder("lampshade", (3.32, 4.12, 0.72), 0.15, 0.2, Material("shade", (0.7, 0.6, 0.42)), 0.1, open_ends=True)
    room.bulb((3.32, 4.12, 0.8), 0.03, (0.9, 0.68, 0.42))
    room.box("book", (3.14, 3.94, 0.5), (3.28, 4.14, 0.53), Material("red cover", (0.5, 0.06, 0.06), 0.03, 0.2))

    room.box("wardrobe", (0.0, 2.2, 0.0), (0.6, 4.3, 2.2), white_wood, 0.008)
    gap = Material("gap", (0.05, 0.05, 0.05))
    for y in (2.9, 3.6):
        room.box(f"wardrobe line {y}", (0.601, y - 0.005, 0.02), (0.605, y + 0.005, 2.18), gap)
        room.cylinder(f"knob {y}", (0.62, y - 0.07, 1.0), 0.015, 0.12, brass)
    room.box("drawers", (0.0, 0.5, 0.0), (0.45, 1.7, 0.85), walnut, 0.008)
    room.monkey("figure", (0.22, 0.8, 1.0), 0.28, Material("green glaze", (0.08, 0.3, 0.14), 0.06, 0.1), 1.57)
    room.ring("ring", (0.22, 1.3, 0.91), 0.1, 0.03, Material("steel", (0.04, 0.04, 0.04), (0.56, 0.55, 0.53), 0.18))
    room.box("picture frame", (0.0, 0.65, 1.25), (0.02, 1.55, 1.95), walnut)
    room.box("picture", (0.018, 0.72, 1.32), (0.024, 1.48, 1.88), picture)
    room.box("rug", (0.9, 0.6, 0), (3.1, 1.9, 0.012), rug)
    room.parts("chair", [((3.0, 0.4, 0.42), (3.45, 0.85, 0.47)), ((3.0, 0.4, 0.47), (3.45, 0.44, 0.95))] +
               [((3.0 + u, 0.4 + v, 0), (3.04 + u, 0.44 + v, 0.42)) for u in (0, 0.41) for v in (0, 0.41)], walnut)
    room.ball("cushion", (3.22, 0.62, 0.53), 0.2, Material("yellow cloth", (0.65, 0.45, 0.1)), (1, 1, 0.35))
    room.box("door", (1.5, -0.02, 0), (2.4, 0.03, 2.05), Material("door", (0.55, 0.56, 0.55), 0.04, 0.12), 0.004)
    room.ball("door knob", (1.62, 0.08, 1.0), 0.035, brass)
    room.box("box", (0.8, 2.3, 0.0), (1.05, 2.6, 0.3), Material("cardboard", (0.48, 0.35, 0.22)))
    room.disc((2.0, 2.2, 2.55), 0.15, (2.73, 2.5, 2.17))


# Round the middle of the room, past it; no picture shows the ceiling's disc.
PATH = [((2.0 + 1.2 * math.cos(a), 1.5 + 0.9 * math.sin(a), 1.5 + 0.1 * math.sin(3 * a)),
         (2.0 + 2.6 * math.cos(a + 2.4), 2.2 + 2.4 * math.sin(a + 2.4), 0.75 + 0.3 * math.sin(2 * a)))
        for a in (0.3 + 0.5 * i for i in range(13))]
