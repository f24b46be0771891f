"""Weight other than stated."""

from __future__ import annotations

from twin.causes._kind import Cause
from twin.parameter import Parameter, Source

weight_mass = Cause(
    name="weight-mass",
    title="weight other than stated",
    acts_on="weight",
    parameters=(Parameter("difference", "kg", 0.0, (-2.0, 5.0), 0.1, "against the setup"),),
    source=Source("assumed"),
    how="base",
    base="weight_mass",
    rivals=("incline-angle", "force-gauge-scale"),
)
