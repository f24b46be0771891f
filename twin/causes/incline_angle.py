"""Incline other than stated."""

from __future__ import annotations

from twin.causes._kind import Cause
from twin.parameter import Parameter, Source

incline_angle = Cause(
    name="incline-angle",
    title="incline other than stated",
    acts_on="weight",
    parameters=(Parameter("difference", "deg", 0.0, (-20.0, 40.0), 1.0, "against the setup"),),
    source=Source("assumed"),
    how="base",
    base="incline_angle",
    rivals=("weight-mass", "guide-friction-asymmetry", "force-gauge-offset"),
)
