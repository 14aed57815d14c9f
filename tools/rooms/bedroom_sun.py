"""The bedroom with a low sun in its window."""
import bedroom

EXPOSURE = bedroom.EXPOSURE
PATH = bedroom.PATH


def build(room, sky):
    bedroom.build(room, sky)
    room.sun((-0.75, 0.28, -0.6), (4.0, 3.6, 3.0))
