"""Preparation steps, done and told in a sentence."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from stand.config import Stand

SENTENCES = {
    "home": "The drive is homed, at {travel:.2f} mm of its travel",
    "jog": "The drive is at {travel:.2f} mm of its travel",
    "tare": "The force gauge is tared and shows {force:.2f} N",
    "rest-check": "At rest {force:.2f} N, the setup gives {expected:.2f} ± {tolerance:.2f} N: {verdict}",
    "reset": "The stand may move again; the drive is {state}",
    "status": "All devices answer",
}


def do_step(stand: Stand, step: str, distance: float = 0.0) -> dict[str, Any]:
    """Do a step of `stand.runs.Step` and wait: {"step", "message", "result"}; raises what made it fail."""
    from stand.runs import Step, StepOrder, take_step

    result = dict(take_step(stand, StepOrder(Step(step), distance=distance)))
    return {"step": step, "message": sentence(step, result), "result": result}


def sentence(step: str, result: Mapping[str, Any]) -> str:
    """What came out, in words; lengths in mm."""
    facts = dict(result)
    if "travel" in facts:
        facts["travel"] = 1e3 * facts["travel"]
    facts["verdict"] = "as it should be" if facts.get("ok") else "NOT as it should be"
    return SENTENCES[step].format(**facts)
