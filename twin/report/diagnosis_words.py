"""The verdict in sentences."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from twin.report.page import number

Json = Mapping[str, Any]
NOTHING = "Nothing is wrong: calibration within the stated uncertainties explains the data."

#: the pictures that matter to a cause of each place, first ones first
_PLACE = {
    "fibre": ("load", "speed", "cycle"),
    "pulley": ("pulley", "speed", "cycle"),
    "guide": ("speed", "position", "cycle"),
    "weight": ("load", "cycle", "time"),
    "drive": ("cycle", "time", "spectrum"),
    "dial-gauge": ("speed", "position", "cycle"),
    "force-gauge": ("load", "cycle", "spectrum"),
    "wiring": ("spectrum", "time"),
    "timing": ("time", "cycle"),
}
#: where a cause differs from its place
_CAUSE = {
    "guide-rough-patch": ("position", "cycle"),
    "end-stop": ("position", "time"),
    "velocity-dependent-damping": ("speed", "load", "cycle"),
    "velocity-dependent-stiffness": ("speed", "load", "cycle"),
    "dial-gauge-saturation": ("position", "time"),
    "force-gauge-drift": ("time", "load"),
    "force-gauge-resonance": ("spectrum", "cycle"),
    "force-gauge-inertia": ("cycle", "spectrum"),
}
_DEPENDS = {
    "time": "time",
    "frequency": "spectrum",
    "weight_position": "position",
    "drive_position": "position",
    "weight_velocity": "speed",
    "drive_velocity": "speed",
    "fibre_force": "load",
    "pulley_angle": "pulley",
}


def headline(v: Json) -> str:
    """What is wrong, in one sentence."""
    causes, unknown = v["causes"], v.get("unknown")
    if causes:
        named = " and ".join(_cause(c) for c in causes)
        more = "; something beyond the catalogue remains" if unknown else ""
        return f"The simulation is wrong because of {named}{more}."
    if unknown:
        on = ", ".join(_plain(name) for name in unknown["depends_on"])
        return (
            f"Something that is not in the catalogue acts on the {unknown['acts_on']} and depends on {on} "
            f"(probability {unknown['probability']:.0%})."
        )
    return NOTHING


def _cause(c: Json) -> str:
    sizes = ", ".join(size(name, p) for name, p in c["parameters"].items())
    return f"{c['name']} ({sizes}), probability {c['probability']:.0%}"


def size(name: str, p: Json) -> str:
    """A parameter with its one-sigma interval."""
    unit = "" if p["units"] == "1" else f" {p['units']}"
    return f"{_plain(name)} {number(p['value'], 4)} ± {number(p['std'], 2)}{unit}"


def sized(v: Json) -> list[str]:
    """Sentences below the headline: rivals, gain."""
    made = []
    for c in v["causes"]:
        if c["indistinguishable_from"]:
            made.append(f"These runs cannot tell {c['name']} from {', '.join(c['indistinguishable_from'])}.")
    units, ratio = v["gain"].get("prediction_error_noise_units"), v["gain"].get("prediction_error_ratio")
    if units is not None:
        made.append(f"On held-out data the model's short-window error is {number(units, 3)} times the noise.")
    if ratio is not None and (v["causes"] or v.get("unknown")):
        made.append(f"That is {number(ratio, 2)} times what the calibrated baseline leaves there.")
    return made


def proofs(v: Json) -> list[tuple[str, tuple[str, ...]]]:
    """Findings with the names of the pictures that matter to them."""
    places = [_CAUSE.get(c["name"], _PLACE.get(c["acts_on"], ("cycle", "speed"))) for c in v["causes"]]
    unknown = v.get("unknown")
    if unknown:
        places.append(tuple(dict.fromkeys(_DEPENDS.get(name, "cycle") for name in unknown["depends_on"])))
    told = list(v["findings"])
    if not told:
        return [(NOTHING if not unknown else headline(v), places[0] if places else ("speed", "spectrum"))]
    return [(text, places[i] if i < len(places) else ()) for i, text in enumerate(told)]


def _plain(name: str) -> str:
    return name.replace("_", " ")
