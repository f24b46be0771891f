"""Fibre stiffer or softer than stated."""

from __future__ import annotations

from twin.causes._kind import Cause
from twin.parameter import Parameter, Source

fibre_stiffness = Cause(
    name="fibre-stiffness",
    title="fibre stiffer or softer than stated",
    acts_on="fibre",
    parameters=(Parameter("difference", "N/m", 0.0, (-30000.0, 300000.0), 2000.0, "against the setup"),),
    source=Source("assumed"),
    how="base",
    base="fibre_stiffness",
    rivals=("drive-compliance", "fibre-hardening"),
)
