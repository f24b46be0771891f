"""What a model has to know of the stepper before any kernel is wanted: its orders, and the room its memory takes."""

from __future__ import annotations

from stand.errors import InputError

#: stages by order
STAGES = {2: 2, 4: 6}


def order_of(order: float) -> int:
    """The order as a whole number; InputError where there is no method of that order."""
    if order not in STAGES:
        raise InputError("no method of that order", where="order", value=order, remedy="2 or 4")
    return int(order)


def memory(unknowns: int, half_band: int, inner: int, order: int) -> int:
    """Places that `fibre_step` needs behind q, v, a and z; zeros mean that nothing is remembered."""
    padded = unknowns + half_band
    return 3 + inner + (2 * STAGES[order] + 2) * unknowns + padded * (2 * half_band + 2)
