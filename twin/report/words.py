"""What a comparison's numbers mean, in sentences."""

from __future__ import annotations

import math

from stand.setup import System
from twin.compare.comparison import Comparison, ModelRun

#: below this R the lag says nothing of clocks
TELLING = 0.95
#: ceilings above this say that starts within the noise lead to one motion
STEADY = 0.995


def sentences(c: Comparison) -> list[str]:
    """The findings, most important first."""
    made = [_position(c), _force(c), _snatch(c), _windows(c), _lag(c), _best(c)]
    return [sentence for sentence in made if sentence] + [f"{note[0].upper()}{note[1:]}." for note in c.notes]


def grade(R: float, ceiling: float) -> str:
    """How near R comes to its ceiling: "good", "warn" or "bad"."""
    if not math.isfinite(R):
        return ""
    lost = 1.0 - R / ceiling if math.isfinite(ceiling) and ceiling > 0 else 1.0 - R
    return "good" if lost < 0.02 else "warn" if lost < 0.15 else "bad"


def _position(c: Comparison) -> str:
    run, span = c.baseline, float(max(c.measured.u) - min(c.measured.u))
    rms = run.score_u.nrmse * span
    return (
        f"The weight moved over {span * 1e3:.1f} mm. The {run.title.lower()} follows it with R = {run.score_u.R:.4f} "
        f"and an error of {rms * 1e3:.2f} mm rms ({run.score_u.nrmse:.1%} of the range), at worst "
        f"{run.score_u.peak_error * 1e3:.1f} mm."
    )


def _force(c: Comparison) -> str:
    s = c.baseline.score_F
    return (
        f"The fibre force peaked at {s.peak_measured:.0f} N, simulated at {s.peak_simulated:.0f} N; R = {s.R:.3f} "
        f"where {c.ceiling_F:.3f} is the most that even a perfect model could reach."
    )


def _snatch(c: Comparison) -> str:
    m = c.measured
    if m.snatch is None:
        return "The fibre never went slack and caught again: whole-run scores can be trusted."
    if m.setup.system is System.WF:
        return f"The fibre first caught the weight at {m.snatch:.2f} s and was slack for {m.slack:.0%} of the fall."
    slack = f"The fibre was slack for {m.slack:.0%} of the time and first caught at {m.snatch:.2f} s. "
    if c.ceiling_u > STEADY and c.ceiling_F > STEADY:
        return slack + (
            "Starts that differ by the sensors' noise still end alike here, so what R lacks is the model's or the "
            "setup's; but every catch magnifies a small error of theirs: judge by the short windows."
        )
    return slack + (
        "After that small differences grow with every catch, and a whole-run R measures chaos as much as the model: "
        "judge by the short windows."
    )


def _windows(c: Comparison) -> str:
    run = c.baseline
    if not run.windows:
        return "No short window could be restarted: the fibre was never taut and quiet for long enough."
    return (
        f"Restarted from the measured state {run.windows} times, the model's error after up to 0.1 s is "
        f"{run.short_u * 1e6:.0f} µm and {run.short_F:.2f} N rms, which is {run.short_u / c.measured.noise[0]:.0f} and "
        f"{run.short_F / c.measured.noise[1]:.0f} times the sensors' noise."
    )


def _lag(c: Comparison) -> str:
    lag = c.baseline.score_u.lag
    if not math.isfinite(lag) or abs(lag) < 2e-4 or c.baseline.score_u.R < TELLING:
        return ""
    late = "late" if lag > 0 else "early"
    return f"The simulated position is {abs(lag) * 1e3:.2f} ms {late}: check the time base before the physics."


def _best(c: Comparison) -> str:
    judged = [run for run in c.runs if math.isfinite(run.short_u)]
    if len(judged) < 2:
        return ""
    best: ModelRun = min(judged, key=lambda run: run.short_u / c.measured.noise[0] + run.short_F / c.measured.noise[1])
    gain = 1.0 - best.short_u / c.baseline.short_u if c.baseline.short_u > 0 else 0.0
    if best is c.baseline:
        return "Over short windows no other model here does better than the baseline."
    return f"Over short windows the {best.title.lower()} does best ({gain:.0%} less error in u than the baseline)."
