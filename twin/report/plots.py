"""The comparison's figures."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from stand.setup import System
from twin.compare.comparison import Comparison
from twin.report.page import figure, thin

Float = NDArray[np.float64]

MOST = 24_000


def role(index: int) -> str:
    """The colour of the model at `index` in the comparison."""
    return f"model-{index % 8 + 1}"


def _line(x: Float, y: Float, name: str, colour: str, **more: Any) -> dict[str, Any]:
    x, y = thin(MOST, x, y)
    return {"type": "scatter", "mode": "lines", "x": x, "y": y, "name": name, "role": colour} | more


def _rows(*titles: str) -> dict[str, Any]:
    """Stacked axes that share time."""
    layout: dict[str, Any] = {"xaxis": {"title": "time in s", "anchor": f"y{len(titles)}" if len(titles) > 1 else "y"}}
    height, gap = (1.0 - 0.06 * (len(titles) - 1)) / len(titles), 0.06
    for i, title in enumerate(titles):
        top = 1.0 - i * (height + gap)
        layout[f"yaxis{i + 1 if i else ''}"] = {"title": title, "domain": [max(0.0, top - height), top]}
    return layout


def histories(c: Comparison) -> str:
    """x, u and F over time, measured and simulated (S1 Figs. 4 to 15)."""
    m, time = c.measured, c.measured.time
    later = time[m.begin :]
    driven = m.setup.system is System.WFPD
    data = [_line(time, m.drive[:, 0] * 1e3, "drive x", "measured", yaxis="y", legendgroup="x", line={"dash": "dot"})]
    data = data if driven else []
    rows = ("y2", "y3") if driven else ("y", "y2")
    data.append(_line(time, m.u * 1e3, "measured", "measured", yaxis=rows[0], legendgroup="measured"))
    data.append(_line(time, m.F, "measured F", "measured", yaxis=rows[1], legendgroup="measured", showlegend=False))
    for i, run in enumerate(c.runs):
        shared = {"legendgroup": run.name}
        data.append(_line(later, run.u * 1e3, run.title, role(i), yaxis=rows[0], **shared))
        data.append(_line(later, run.F, run.title, role(i), yaxis=rows[1], showlegend=False, **shared))
    titles = ("x in mm", "u in mm", "F in N") if driven else ("u in mm", "F in N")
    words = "Drive position x, weight position u and fibre force F; drag to zoom in, double-click to see all again."
    return figure(data, _rows(*titles) | {"shapes": _snatch_mark(c)}, words, 640)


def _snatch_mark(c: Comparison) -> list[dict[str, Any]]:
    if c.measured.snatch is None:
        return []
    at = c.measured.snatch
    return [{"type": "line", "x0": at, "x1": at, "yref": "paper", "y0": 0, "y1": 1, "role": "bad"}]


def deviations(c: Comparison) -> str:
    """Simulated less measured over time (as S0 Fig. 8, right)."""
    m = c.measured
    time, u, F = m.time[m.begin :], m.u[m.begin :], m.F[m.begin :]
    data = []
    for i, run in enumerate(c.runs):
        data.append(_line(time, (run.u - u) * 1e3, run.title, role(i), legendgroup=run.name))
        data.append(_line(time, run.F - F, run.title, role(i), yaxis="y2", legendgroup=run.name, showlegend=False))
    layout = _rows("Δu in mm", "ΔF in N") | {"shapes": _snatch_mark(c)}
    words = "Deviation, simulated less measured (as S0 Fig. 8)."
    if m.snatch is not None:
        words += " The dotted line marks the first catch after slack: beyond it deviations grow by themselves."
    return figure(data, layout, words, 460)


def phase_plane(c: Comparison, span: float = 2.0) -> str:
    """Weight velocity over weight position (as S1 Fig. 11), of the middle `span` seconds."""
    m = c.measured
    n, count = len(m.time), round(span / m.dt)
    low = max(m.begin, (n - count) // 2 if m.setup.system is System.WFPD else m.begin)
    part, own = slice(low, low + count), slice(low - m.begin, low - m.begin + count)
    data = [_line(m.u[part] * 1e3, speed(m.u, m.dt)[part], "measured", "measured")]
    data += [_line(run.u[own] * 1e3, run.v[own], run.title, role(i)) for i, run in enumerate(c.runs)]
    layout = {"xaxis": {"title": "weight position u in mm"}, "yaxis": {"title": "weight velocity in m/s"}}
    seconds = f"{m.time[low]:.1f} to {m.time[min(low + count, n) - 1]:.1f} s"
    return figure(data, layout, f"Phase plane of the weight (as S1 Fig. 11), part of the record: {seconds}.", 460)


def speed(u: Float, dt: float, half: int = 5) -> Float:
    """u' by least-squares parabolas over 11 samples; the first and last five repeat their neighbour."""
    k = np.arange(-half, half + 1.0)
    middle = np.convolve(u, k[::-1] / (float(k @ k) * dt), mode="valid")
    return np.pad(middle, half, mode="edge")


def spectra(c: Comparison) -> str:
    """Amplitude spectra of u and F, measured and simulated."""
    m = c.measured
    u, F = m.u[m.begin :], m.F[m.begin :]
    data = []
    for values, axis in ((u * 1e3, "y"), (F, "y2")):
        f, a = spectrum(values, m.dt)
        data.append(_line(f, a, "measured", "measured", yaxis=axis, showlegend=axis == "y", legendgroup="measured"))
    for i, run in enumerate(c.runs):
        for values, axis in ((run.u * 1e3, "y"), (run.F, "y2")):
            f, a = spectrum(values, m.dt)
            shown = {"yaxis": axis, "showlegend": axis == "y", "legendgroup": run.name}
            data.append(_line(f, a, run.title, role(i), **shown))
    layout = _rows("u in mm", "F in N")
    layout["xaxis"] |= {"title": "frequency in Hz", "type": "log", "range": [-0.7, 2.7]}
    layout["yaxis"] |= {"type": "log", "exponentformat": "power"}
    layout["yaxis2"] |= {"type": "log", "exponentformat": "power"}
    return figure(data, layout, "Amplitude spectra (Hann window, mean of half-overlapping stretches).", 520)


def spectrum(values: Float, dt: float, seconds: float = 4.0) -> tuple[Float, Float]:
    """Frequencies above 0, Hz, and rms-averaged amplitudes in the values' unit, of stretches of up to 4 s."""
    n = min(len(values), round(seconds / dt))
    window = np.hanning(n)
    begins = range(0, len(values) - n + 1, max(1, n // 2))
    power = np.mean(
        [np.abs(np.fft.rfft((v := values[b : b + n]) * window - v.mean() * window)) ** 2 for b in begins], 0
    )
    amplitude = 2.0 * np.sqrt(power) / window.sum()
    f: Float = np.fft.rfftfreq(n, dt).astype(np.float64)
    return f[1:], np.maximum(amplitude[1:], 1e-12)
