"""What the stepper remembers behind a state's own values: guesses of accelerations, the factors of Newton's matrix."""

from __future__ import annotations

from twin.kernels.jit import part


@part
def recall(kept, guess, zd, band, border, edge):  # type: ignore[no-untyped-def]
    """Fills the arrays from `kept`; returns the step for which the factors hold and the width of the guesses.

    kept[2] is the stepper's own: how fast Newton's method converged.
    """
    at = 3 + len(zd)
    zd[:] = kept[3:at]
    for array in (guess, band, border):
        flat = array.reshape(-1)
        flat[:] = kept[at : at + len(flat)]
        at += len(flat)
    edge[:] = kept[at : at + len(edge)]
    return kept[0], kept[1]


@part
def keep(kept, guess, zd, band, border, edge, factored, guessed):  # type: ignore[no-untyped-def]
    """The way back."""
    kept[0], kept[1] = factored, guessed
    at = 3 + len(zd)
    kept[3:at] = zd
    for array in (guess, band, border):
        flat = array.reshape(-1)
        kept[at : at + len(flat)] = flat
        at += len(flat)
    kept[at : at + len(edge)] = edge
