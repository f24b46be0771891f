"""What can be fitted: base values within their priors, nuisances of each run, and the parameters of causes.

Every coordinate z counts in units of its scale: base values in their stated uncertainties from the setup's value,
causes'
parameters in typical sizes from null.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from stand.setup import Setup, System
from twin.causes._kind import Cause

#: owners of what the setup states; all else belongs to a cause
STATED = ("base", "run")
WITHIN = 3.0
#: shares of a stated base value between which a cause may free it
LEAST, MOST = 0.1, 6.0
TIMING = 4e-5
OFFSET = 4e-6
LOST_OFFSET = 6e-4
NO_FRICTION = 1e-3
#: causes beside which a channel's own small shift in time can't be told, and is left at none
TIMED = {
    "late_u": frozenset({"dial-gauge-delay", "dial-gauge-lag", "drive-delay"}),
    "late_F": frozenset({"force-gauge-delay", "force-gauge-lag"}),
}


@dataclass(frozen=True)
class Coordinate:
    """One number to fit. owner: "base", "run" (a number per run) or a cause's name; scale in SI; prior: one sigma
    in z.
    """

    name: str
    owner: str
    scale: float
    origin: float = 0.0
    prior: float = math.inf
    low: float = -math.inf
    high: float = math.inf
    run: int = -1

    def value(self, z: float) -> float:
        """The number itself, SI."""
        return self.origin + self.scale * z


def base(
    setups: Sequence[Setup], freed: frozenset[str] = frozenset(), named: frozenset[str] = frozenset()
) -> tuple[Coordinate, ...]:
    """The base values that calibration may move, those in `freed` without prior or bound; `named`: the causes in the
    model.
    """
    setup = setups[0]
    names = {
        System.WFPD: (
            "weight_mass",
            "incline_angle",
            "fibre_stiffness",
            "fibre_damping",
            "pulley_inertia",
            "guide_friction",
        ),
        System.WF: ("weight_mass", "incline_angle", "fibre_stiffness", "fibre_damping", "guide_friction"),
        System.LINEAR_DRIVE: ("moving_mass", "guide_friction"),
    }[setup.system]
    found = [Coordinate(n, "base", _sigma(setup, n), 0.0, 1.0, -WITHIN, WITHIN) for n in names]
    if setup.system is System.LINEAR_DRIVE:  # the baseline there has no friction: any is a cause
        found[1] = Coordinate("guide_friction", "base", 1.0, 0.0, NO_FRICTION, 0.0, WITHIN * NO_FRICTION)
    else:
        found.append(Coordinate("guide_friction_velocity", "base", 0.7, 0.0, 1.0, -3.6, 2.2))
        found.append(Coordinate("late_F", "base", TIMING, 0.0, 1.0, -WITHIN, WITHIN))
    if setup.system is System.WFPD:
        found.append(Coordinate("late_u", "base", TIMING, 0.0, 1.0, -WITHIN, WITHIN))
        found.append(Coordinate("split", "base", _split(setup), 0.0, 1.0, -WITHIN, WITHIN))
    if any(s.added_mass > 0 for s in setups) and setup.system is not System.LINEAR_DRIVE:
        heavy = max(setups, key=lambda s: s.added_mass)
        if heavy.sigma("added_mass") > 1e-6:
            found.append(Coordinate("added_mass", "base", heavy.sigma("added_mass"), 0.0, 1.0, -WITHIN, WITHIN))
    found = [c for c in found if not named & TIMED.get(c.name, frozenset())]
    return tuple(_freed(c, getattr(setup, c.name)) if c.name in freed else c for c in found)


def _freed(c: Coordinate, stated: float) -> Coordinate:
    """Without a prior; no nearer to nothing than a share of what is stated, where the model would turn stiff."""
    if stated <= 0.0:
        return replace(c, prior=math.inf, low=-math.inf, high=math.inf)
    low, high = ((share - 1.0) * stated / c.scale for share in (LEAST, MOST))
    return replace(c, prior=math.inf, low=low, high=high)


def _sigma(setup: Setup, name: str) -> float:
    if name == "pulley_inertia":
        rim = 2 * setup.sigma("pulley_radius") / setup.pulley_radius
        return setup.pulley_inertia * math.hypot(setup.sigma(name) / setup.pulley_inertia, rim)
    if name == "fibre_stiffness":
        length = setup.sigma("weight_strand_length") / setup.weight_strand_length
        return setup.fibre_stiffness * math.hypot(setup.sigma(name) / setup.fibre_stiffness, 0.5 * length)
    return setup.sigma(name)


def _split(setup: Setup) -> float:
    """One sigma of the strands' ratio L1/L2, as a share."""
    return math.hypot(
        setup.sigma("weight_strand_length") / setup.weight_strand_length,
        setup.sigma("drive_strand_length") / setup.drive_strand_length,
    )


def offsets(runs: int, lost: bool) -> tuple[Coordinate, ...]:
    """Each run's zero of u against x (through the strands' rest tensions), m."""
    sigma = LOST_OFFSET if lost else OFFSET
    return tuple(Coordinate("offset", "run", OFFSET, 0.0, sigma / OFFSET, -5e3, 5e3, r) for r in range(runs))


def of_cause(cause: Cause) -> tuple[Coordinate, ...]:
    """A cause's parameters; none for a cause that only frees a base value."""
    if cause.base is not None:
        return ()
    found = []
    for p in cause.parameters:
        scale = p.uncertainty or max(abs(p.value), 1.0)
        low, high = ((b - p.value) / scale for b in p.bounds)
        found.append(Coordinate(p.name, cause.name, scale, p.value, math.inf, low, high))
    return tuple(found)
