"""Dry friction in the guide other than stated."""

from __future__ import annotations

from twin.causes._kind import GUIDE, Cause
from twin.parameter import Parameter, Source

guide_coulomb_friction = Cause(
    name="guide-coulomb-friction",
    title="dry friction in the guide other than stated",
    acts_on="guide",
    parameters=(Parameter("difference", "N", 0.0, (-10.0, 60.0), 1.0, "against the setup"),),
    source=Source("assumed"),
    how="base",
    base="guide_friction",
    systems=GUIDE,
    rivals=("guide-stribeck-friction", "pulley-bearing-friction"),
)
