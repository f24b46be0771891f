"""Pulley heavier or lighter than stated."""

from __future__ import annotations

from twin.causes._kind import WFPD, Cause
from twin.parameter import Parameter, Source

pulley_inertia = Cause(
    name="pulley-inertia",
    title="pulley heavier or lighter than stated",
    acts_on="pulley",
    parameters=(Parameter("difference", "kg*m^2", 0.0, (-0.00018, 0.005), 5e-05, "against the setup"),),
    source=Source("assumed"),
    how="base",
    base="pulley_inertia",
    rivals=("force-gauge-inertia", "fibre-mass"),
    systems=WFPD,
)
