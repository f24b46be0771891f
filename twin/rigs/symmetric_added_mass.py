"""Weight-fibre-pulley-drive rig, symmetric, with the added mass of 5.035 kg."""

from __future__ import annotations

from stand.setup import Setup, nominal
from twin.parameter import Source
from twin.rigs import DRIVEN, Rig


def _setup() -> Setup:
    """The nominal stand with the added mass."""
    return nominal().with_values(added_mass=5.035)


RIG = Rig(
    name="symmetric-added-mass",
    title="WFPD symmetric, added mass",
    source=Source("Polach, Hajzman, Dupal", 2017, "section 2"),
    setup=_setup,
    excitations=DRIVEN,
)
