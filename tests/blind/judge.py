"""One verdict against what was hidden."""

from __future__ import annotations

from typing import Any

MOST_RIVALS = 3


def judge(truth: dict[str, Any], verdict: dict[str, Any], seconds: float) -> dict[str, Any]:
    """What the battery's table needs of one stand; JSON-ready."""
    hidden = [h["name"] for h in truth["hidden"]]
    causes = verdict["causes"]
    return {
        "number": truth["number"],
        "kind": truth["kind"],
        "hidden": hidden,
        "wanted": [h["strength"] for h in truth["hidden"]],
        "named": [c["name"] for c in causes],
        "rivals": [c["indistinguishable_from"] for c in causes],
        "probability": [c["probability"] for c in causes],
        "right": [any(holds(c, name) for name in hidden) for c in causes],
        "outcome": outcome(truth, verdict),
        "strength": [c["strength"] for c in causes],
        "size": [s for h in truth["hidden"] for s in sizes(h, causes)],
        "unknown": None if verdict["unknown"] is None else verdict["unknown"]["depends_on"],
        "depends_on": [d for h in truth["hidden"] for d in h.get("depends_on") or ()],
        "ratio": verdict["gain"]["prediction_error_ratio"],
        "noise_units": verdict["gain"]["prediction_error_noise_units"],
        "seconds": seconds,
    }


def holds(cause: dict[str, Any], name: str) -> bool:
    """Whether a named cause is `name`, or has it in a rival set of at most three."""
    rivals = cause["indistinguishable_from"]
    return bool(cause["name"] == name or (name in rivals and len(rivals) < MOST_RIVALS))


def outcome(truth: dict[str, Any], verdict: dict[str, Any]) -> str:
    """found | rival | confused | missed, for what is in the catalogue; silent | alarm; unknown | named | missed."""
    hidden, causes = [h["name"] for h in truth["hidden"]], verdict["causes"]
    said = bool(causes or verdict["unknown"])
    if truth["kind"] == "clean":
        return "alarm" if said else "silent"
    if truth["kind"] == "outside":
        return "unknown" if verdict["unknown"] else "named" if causes else "missed"
    if all(any(holds(c, name) for c in causes) for name in hidden):
        exact = {c["name"] for c in causes[: len(hidden)]} == set(hidden)
        return "found" if exact else "rival"
    return "confused" if said else "missed"


def sizes(hidden: dict[str, Any], causes: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Estimate, its std and truth for each parameter of a hidden effect that was named."""
    named = [c for c in causes if c["name"] == hidden["name"]]
    return [
        {"cause": hidden["name"], "parameter": p, "true": v["value"], **_estimate(named[0]["parameters"][p])}
        for p, v in hidden["parameters"].items()
        if named and p in named[0]["parameters"] and isinstance(v["value"], int | float)
    ]


def _estimate(parameter: dict[str, Any]) -> dict[str, Any]:
    return {"value": parameter["value"], "std": parameter["std"]}
