"""Weight-fibre-pulley-drive rig, the weight's path 0.280 m beside the plane of drive and pulley."""

from __future__ import annotations

import math

from stand.setup import Setup, nominal
from twin.parameter import Source
from twin.rigs import DRIVEN, Rig


def _setup() -> Setup:
    """alpha, phi and offset as printed; L1 = 1.04 m, L2 what the fibre of 1.82 m leaves beside it and the arc."""
    return nominal().with_values(
        incline_angle=math.radians(30.6),
        wrap_angle=math.radians(146.0),
        lateral_offset=0.280,
        weight_strand_length=1.04,
        drive_strand_length=1.82 - 1.04 - 0.040 * math.radians(146.0),
        fibre_stiffness=34e3 * 1.7153 / (1.82 - 0.040 * math.radians(146.0)),
        fibre_damping=27.5 * 1.7153 / (1.82 - 0.040 * math.radians(146.0)),
    )


RIG = Rig(
    name="asymmetric",
    title="WFPD asymmetric",
    source=Source("Polach, Hajzman, Dupal", 2017, "section 2; L1 is derived"),
    setup=_setup,
    excitations=DRIVEN,
)
