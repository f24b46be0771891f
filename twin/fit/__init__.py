"""Tune chosen parameters of a fibre model to recordings."""

from twin.fit.fit import Fit, Fitted, fit

__all__ = ["Fit", "Fitted", "fit"]
