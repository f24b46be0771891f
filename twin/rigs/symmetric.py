"""Weight-fibre-pulley-drive rig, weight in the plane of drive and pulley."""

from __future__ import annotations

from stand.setup import Setup, nominal
from twin.parameter import Source
from twin.rigs import DRIVEN, Rig


def _setup() -> Setup:
    """The nominal stand."""
    return nominal()


RIG = Rig(
    name="symmetric",
    title="WFPD symmetric",
    source=Source("Polach, Hajzman, Dupal", 2017, "section 2"),
    setup=_setup,
    excitations=DRIVEN,
)
