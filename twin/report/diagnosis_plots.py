"""The diagnosis's figures: what each model leaves, in units of the sensors' noise."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from twin.diagnosis.fit import Fitted
from twin.diagnosis.found import Evidence
from twin.report.page import figure, section
from twin.report.plots import _line, _rows

Float = NDArray[np.float64]
BINS = 24
FEWEST = 40
_CHANNELS = ("u", "F")


def pictures(e: Evidence) -> dict[str, str]:
    """Figures by what they are drawn against: "speed", "position", "pulley", "load", "cycle", "time", "spectrum"."""
    signals = _signals(e)
    axes = {
        "speed": ("weight speed in m/s", signals[..., 1]),
        "position": ("weight position u in mm", signals[..., 0] * 1e3),
        "load": ("fibre force in N", signals[..., 2]),
        "pulley": ("pulley angle in degrees", np.degrees(signals[..., 4] / e.problem.runs[0].setup.pulley_radius)),
    }
    made = {key: _against(e, where, title, key) for key, (title, where) in axes.items()}
    made["cycle"] = _against(e, _phase(e), "phase of the drive's cycle in degrees", "the drive's cycle")
    made["time"] = _over_time(e)
    made["spectrum"] = _spectrum(e)
    return {key: html for key, html in made.items() if html}


def _signals(e: Evidence) -> Float:
    """u, v, F, x'', s at every sample of every window [w, LENGTH, 5], as the final model simulates them."""
    found, _ = e.problem.simulate(e.final.model, e.final.z, e.final.starts)
    return found


def _models(e: Evidence) -> list[tuple[str, str, Fitted]]:
    named = [("as calibrated", "model-2", e.calibrated)]
    return [*named, ("with what was found", "model-1", e.final)] if e.final is not e.calibrated else named


def _scaled(e: Evidence, fitted: Fitted) -> Float:
    left: Float = fitted.residual / e.problem.sigma[:, None, :]
    return left


def _against(e: Evidence, where: Float, title: str, what: str) -> str:
    """Mean residual in bins of `where`, bars of two standard errors, both channels."""
    use, data = e.problem.windows.use, []
    finite = np.isfinite(where)
    if not finite.any() or np.ptp(where[finite]) < 1e-9:
        return ""
    of = np.broadcast_to(np.arange(len(use))[:, None], use.shape[:2])
    low, high = (float(np.percentile(where[finite], share)) for share in (0.5, 99.5))
    edges = np.linspace(low, high, BINS + 1)
    for name, role, fitted in _models(e):
        left = _scaled(e, fitted)
        for c in range(2):
            keep = use[..., c] & finite
            data += _banded(where[keep], left[..., c][keep], of[keep], edges, name, role, c)
    layout = _rows("u, times noise", "F, times noise")
    layout["xaxis"] |= {"title": title}
    words = (
        f"Measured less simulated over short windows against {title}: means, with bars of two standard errors "
        "(windows counted as independent)."
    )
    return figure(data, layout, words, 420)


def _banded(
    x: Float, y: Float, of: NDArray[np.int64], edges: Float, name: str, role: str, channel: int
) -> list[dict[str, Any]]:
    place = np.digitize(x, edges) - 1
    inside = (place >= 0) & (place < len(edges) - 1)
    place, y, of = place[inside], y[inside], of[inside]
    pairs = np.unique(np.column_stack((place, of)), axis=0)[:, 0]
    windows = np.bincount(pairs, minlength=len(edges) - 1)
    count = np.bincount(place, minlength=len(edges) - 1)
    mean = np.bincount(place, y, minlength=len(edges) - 1) / np.maximum(count, 1)
    square = np.bincount(place, y**2, minlength=len(edges) - 1) / np.maximum(count, 1)
    error = 2.0 * np.sqrt(np.maximum(square - mean**2, 0.0) / np.maximum(windows, 1))
    good = count >= FEWEST
    at, mean, error = 0.5 * (edges[1:] + edges[:-1])[good], mean[good], error[good]
    return [
        {
            "type": "scatter", "mode": "lines+markers", "x": at, "y": mean, "name": name, "role": role,
            "legendgroup": name, "showlegend": channel == 0, "yaxis": "y2" if channel else "y",
            "error_y": {"type": "data", "array": error, "thickness": 1, "width": 2}, "marker": {"size": 5},
        }
    ]  # fmt: skip


def _phase(e: Evidence) -> Float:
    """Phase of the drive's motion at every sample of every window, degrees; NaN without a drive's cycle."""
    w = e.problem.windows
    at = w.first[:, None] + np.arange(w.data.shape[1])[None, :]
    phase = np.full(at.shape, np.nan)
    for r, run in enumerate(e.problem.runs):
        x = run.x.value - np.mean(run.x.value)
        power = np.abs(np.fft.rfft(x * np.hanning(len(x)))) ** 2
        if not power[1:].max() > 0 or np.ptp(x) < 1e-4:
            continue
        f = np.fft.rfftfreq(len(x), run.dt)[1 + int(np.argmax(power[1:]))]
        phase[w.run == r] = (360.0 * f * run.dt * at[w.run == r]) % 360.0
    return phase


def _over_time(e: Evidence) -> str:
    """Rms of each window's residual over the time in its run."""
    w, data = e.problem.windows, []
    time = w.first * e.problem.dt
    for name, role, fitted in _models(e):
        left = _scaled(e, fitted)
        for c in range(2):
            rms = np.sqrt((left[..., c] ** 2).sum(1) / np.maximum(w.use[..., c].sum(1), 1))
            data.append(
                {
                    "type": "scatter", "mode": "markers", "x": time, "y": np.maximum(rms, 1e-3), "name": name,
                    "role": role, "legendgroup": name, "showlegend": c == 0, "yaxis": "y2" if c else "y",
                    "marker": {"size": 6, "opacity": 0.75},
                }
            )  # fmt: skip
    layout = _rows("u, times noise", "F, times noise")
    layout["yaxis"] |= {"type": "log"}
    layout["yaxis2"] |= {"type": "log"}
    return figure(data, layout, "Error of each short window (rms, in the sensors' noise; 1 is the floor).", 420)


def _spectrum(e: Evidence) -> str:
    """Mean amplitude spectra of the windows' residuals over the white noise's."""
    w, data = e.problem.windows, []
    n = w.data.shape[1]
    window = np.hanning(n)
    f = np.fft.rfftfreq(n, e.problem.dt).astype(np.float64)[1:]
    for name, role, fitted in _models(e):
        left = _scaled(e, fitted)
        for c in range(2):
            spectrum = np.fft.rfft(left[..., c] * window, axis=1)[:, 1:]
            level = np.sqrt(np.mean(np.abs(spectrum) ** 2, axis=0) / (window**2).sum())
            data.append(
                _line(
                    f,
                    np.maximum(level, 1e-3),
                    name,
                    role,
                    legendgroup=name,
                    showlegend=c == 0,
                    yaxis="y2" if c else "y",
                )
            )
    layout = _rows("u, times noise", "F, times noise")
    layout["xaxis"] |= {"title": "frequency in Hz", "type": "log"}
    layout["yaxis"] |= {"type": "log"}
    layout["yaxis2"] |= {"type": "log"}
    return figure(data, layout, "Spectrum of what is left; 1 is the sensors' white noise.", 420)


def ladder(v: Mapping[str, Any]) -> str:
    """Errors of the ladder's steps, held out and fitted."""
    rungs = v.get("ladder") or []
    if not rungs:
        return ""
    names, data = [r["name"] for r in rungs], []
    for c, channel in enumerate(_CHANNELS):
        for key, words, role in (("error", "fitted", "soft"), ("held_out", "held out", "accent")):
            data.append(
                {
                    "type": "bar", "x": names, "y": [r[key][c] for r in rungs], "name": words, "role": role,
                    "legendgroup": key, "showlegend": c == 0, "yaxis": "y2" if c else "y",
                    "hovertemplate": f"{channel}, {words}: %{{y:.3g}} × noise<extra></extra>",
                }
            )  # fmt: skip
    layout = _rows("u, times noise", "F, times noise") | {"barmode": "group"}
    layout["xaxis"] |= {"title": "", "type": "category"}
    layout["yaxis"] |= {"type": "log"}
    layout["yaxis2"] |= {"type": "log"}
    return figure(data, layout, "Short-window error in units of the sensors' noise: 1 is all that can be reached.", 420)


def unknown(v: Mapping[str, Any]) -> str:
    """The learned shape with its error band; nothing where there is no unknown."""
    found = v.get("unknown")
    if not found or not (found.get("shape") or {}).get("x"):
        return ""
    x, y, std = (np.array(found["shape"][key], dtype=np.float64) for key in ("x", "y", "std"))
    band = {"type": "scatter", "mode": "lines", "x": np.r_[x, x[::-1]], "y": np.r_[y + std, (y - std)[::-1]]}
    data = [
        band | {"fill": "toself", "role": "accent", "name": "one sigma", "hoverinfo": "skip"},
        {"type": "scatter", "mode": "lines", "x": x, "y": y, "name": "learned", "role": "accent"},
    ]
    on = found["depends_on"][0].replace("_", " ")
    layout = {"xaxis": {"title": on}, "yaxis": {"title": f"{found['acts_on']}, {found['units']}"}}
    words = f"What no cause of the catalogue explains, as learned from the data, against {on}."
    return section("The unknown's shape", figure(data, layout, words, 360))
