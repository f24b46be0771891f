"""What is wrong, in words with numbers: where in speed, place, load and time the calibrated baseline misses, and
by how much.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stand.setup import System
from twin.diagnosis.found import Evidence
from twin.diagnosis.unknown import Unknown

Float = NDArray[np.float64]
ALONG = {
    "speed of the weight": (1, "m/s", 1.0),
    "weight position": (0, "mm", 1e3),
    "fibre force": (2, "N", 1.0),
}


def findings(found: Evidence, causes: list[dict[str, Any]], beyond: Unknown | None) -> list[str]:
    """Sentences: the causes', where the calibrated baseline misses, what is beyond the catalogue, what was gained."""
    told = [c["evidence"][0] for c in causes]
    if causes or beyond is not None:
        told += _where(found)
    if beyond is not None:
        told.append(_beyond(beyond))
    before, after = found.ladder[1].held_out, found.ladder[-1].held_out
    if causes or beyond is not None:
        told.append(
            f"on windows that were not fitted the error falls from {before[0]:.1f} (u) and {before[1]:.1f} (F) times "
            f"the sensors' noise to {after[0]:.2f} and {after[1]:.2f}"
        )
    else:
        told.append(
            "calibration within the stated uncertainties explains the data: the short windows miss by "
            f"{after[0]:.2f} (u) and {after[1]:.2f} (F) times the sensors' noise"
        )
    return told


def _where(found: Evidence) -> list[str]:
    """Where the calibrated baseline misses most: the quarter of speed, place or load with the largest share."""
    problem = found.problem
    if problem.system is System.LINEAR_DRIVE:
        return []
    simulated, _ = problem.simulate(found.calibrated.model, found.calibrated.z, found.calibrated.starts)
    use = problem.windows.use[..., 0]
    left = found.calibrated.residual / problem.sigma[:, None, :]
    worst = int(np.argmax(np.nanmean(np.minimum(left**2, 1e6), axis=(0, 1))))
    squares = np.minimum(left[..., worst] ** 2, 1e6)[use]
    channel, unit, factor = (("weight position", "mm", 1e3), ("fibre force", "N", 1.0))[worst]
    noise = problem.runs[0].noise_u if worst == 0 else problem.runs[0].noise_F
    best = ("", 0.0)
    for name, (column, along, scale) in ALONG.items():
        values = np.abs(simulated[..., column][use]) if column == 1 else simulated[..., column][use]
        edges = np.quantile(values, [0, 0.25, 0.5, 0.75, 1])
        parts = [float(np.sqrt(np.mean(squares[(values >= a) & (values <= b)]))) for a, b in pairwise(edges)]
        contrast = max(parts) / max(min(parts), 0.3)
        if contrast > best[1]:
            i = int(np.argmax(parts))
            best = (
                f"the calibrated simulation misses the {channel} most at a {name} of {edges[i] * scale:.3g} to "
                f"{edges[i + 1] * scale:.3g} {along}: by {parts[i] * noise * factor:.3g} {unit} rms over short "
                f"windows, against {min(parts) * noise * factor:.3g} {unit} where it is best",
                contrast,
            )
    return [best[0]] if best[0] else []


def _beyond(beyond: Unknown) -> str:
    term = beyond.term
    size = float(np.max(np.abs(term.y))) if len(term.y) else 0.0
    how = (
        f"at {term.frequency:.2f} Hz"
        if term.frequency
        else "over " + " or ".join(d.replace("_", " ") for d in beyond.depends_on)
    )
    unit = "N" if term.place not in ("dial-gauge", "drive") else "m"
    return f"no cause of the catalogue explains a term of up to {size:.3g} {unit} at the {term.place} {how}"
