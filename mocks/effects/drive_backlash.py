"""A gap between the encoder and the fibre's end: at a reversal the end waits until the drive has crossed it."""

import numpy as np
from numpy.typing import NDArray

from mocks.effects import Effect, Size
from mocks.plant.stages import Play
from mocks.plant.world import World

Float = NDArray[np.float64]


class _Gap:
    """Play on the drive's position; the end has the drive's speed while it is carried, none in the gap."""

    def __init__(self, width: float, start: float) -> None:
        self.play, self.last = Play(width, start), 0.5 * width * start
        self.zero = self.last

    def __call__(self, time: Float, path: Float) -> Float:
        end = self.play(time, np.ascontiguousarray(path[:, 0]), path)
        moved = np.diff(end, prepend=self.last) != 0.0
        self.last = float(end[-1])
        return np.stack([end - self.zero, np.where(moved, path[:, 1], 0.0)], axis=-1)


def act(world: World, width: float, start: float) -> None:
    """Puts the gap behind the drive; start in -1..1 says where in the gap the drive stands at rest."""
    if width:
        world.drive.append(_Gap(width, start))


EFFECT = Effect(
    "drive-backlash",
    "drive",
    (Size("width", "m", 2e-4, 1e-5, 8e-4), Size("start", "-", 0.0, -1.0, 1.0, steady=True)),
    act,
)
