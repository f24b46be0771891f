"""Fibre damped more or less than stated."""

from __future__ import annotations

from twin.causes._kind import Cause
from twin.parameter import Parameter, Source

fibre_damping = Cause(
    name="fibre-damping",
    title="fibre damped more or less than stated",
    acts_on="fibre",
    parameters=(Parameter("difference", "N*s/m", 0.0, (-25.0, 400.0), 5.0, "against the setup"),),
    source=Source("assumed"),
    how="base",
    base="fibre_damping",
    rivals=("velocity-dependent-damping", "fibre-viscoelasticity"),
)
