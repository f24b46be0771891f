"""Rectangular: each flank is the quickest step that the stand's limits admit."""

from __future__ import annotations

from stand.config import Limits
from stand.excitation.curve import Curve, Waveform, fastest_step
from stand.excitation.flanks import up_and_down
from stand.excitation.spec import Excitation, Shape


def build(excitation: Excitation, limits: Limits) -> Curve:
    """The curve; `ramp` is not used."""
    return up_and_down(excitation, lambda height: fastest_step(height, limits))


WAVEFORM = Waveform(Shape.RECTANGULAR, "rectangular", "Polach et al., S0, S1: shape; flanks assumed", build)
