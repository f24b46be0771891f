"""Trapezoidal: up in `ramp` seconds, hold, down, hold; a ramp that is not given is a quarter of the cycle."""

from __future__ import annotations

from stand.config import Limits
from stand.excitation.curve import Curve, Waveform, shaped_step
from stand.excitation.flanks import up_and_down
from stand.excitation.spec import Excitation, Shape


def build(excitation: Excitation, limits: Limits) -> Curve:
    """The curve; a flank lasts `ramp` from rest to rest."""
    ramp = excitation.ramp or 0.25 / excitation.frequency
    return up_and_down(excitation, lambda height: shaped_step(height, ramp))


WAVEFORM = Waveform(Shape.TRAPEZOIDAL, "trapezoidal", "Polach et al., S0, S1: shape; corners assumed", build)
