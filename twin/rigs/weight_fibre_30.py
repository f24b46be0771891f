"""Weight-fibre rig at 30 deg: lift, release, slide until the fibre catches the weight."""

from __future__ import annotations

import math

from stand.setup import Setup, System, nominal
from twin.parameter import Source
from twin.rigs import RELEASED, Rig


def _setup() -> Setup:
    """Fibre of 0.559 m; friction at this angle (assumed: it falls with the normal load)."""
    return nominal(System.WF).with_values(incline_angle=math.radians(30.0), guide_friction=3.0)


RIG = Rig(
    name="weight-fibre-30",
    title="WF, 30 deg",
    source=Source("Polach, Hajzman, Bulin", 2020, "section 3.1"),
    setup=_setup,
    excitations=RELEASED,
)
