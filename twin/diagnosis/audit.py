"""What is wrong with a recording before any physics: a clear error, or a remedy that is stated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from stand.errors import InputError
from stand.recording import Recording
from stand.setup import System

Float = NDArray[np.float64]
FEW = 0.02
SHORTEST = 0.8
LARGEST = {"weight_position": 5.0, "drive_position": 20.0, "fibre_force": 2e4, "drive_force": 1e6}
BITS = {"drive_position": 1, "weight_position": 2, "fibre_force": 4}


def audit(recording: Recording) -> tuple[Recording, tuple[str, ...]]:
    """The recording mended where that is safe, and what was mended; InputError where it can't be used."""
    where = recording.name
    if recording.time[-1] - recording.time[0] < SHORTEST:
        _refuse(
            f"only {recording.time[-1] - recording.time[0]:.2f} s long", where, "Record 0.4 s of rest and some motion"
        )
    notes: list[str] = []
    channels: dict[str, Float] = {}
    quality = np.zeros(len(recording.time), np.uint8) if recording.quality is None else recording.quality.copy()
    for name, values in recording.channels.items():
        channels[name], lost = _whole(name, values, where, notes)
        quality[lost] |= np.uint8(BITS.get(name, 0))
        _plausible(name, channels[name], where)
        _clipped(name, channels[name], notes)
    _rest(recording, channels, where)
    return replace(recording, channels=channels, quality=quality, notes=(*recording.notes, *notes)), tuple(notes)


def audit_all(
    recordings: Sequence[Recording], skipped: Sequence[dict[str, str]] = ()
) -> tuple[list[Recording], list[dict[str, str]], list[str]]:
    """Usable recordings, the skipped ones with why, and notes; InputError where none is left or rigs are mixed."""
    good: list[Recording] = []
    bad, notes = [dict(s) for s in skipped], []
    last: InputError | None = None
    for recording in recordings:
        try:
            mended, said = audit(recording)
        except InputError as error:
            last = error
            bad.append({"file": recording.name, "why": f"{error.what}. {error.remedy}".strip()})
            continue
        good.append(mended)
        notes += [f"{recording.name}: {n}" for n in (*recording.notes, *said)]
    if not good:
        raise last or InputError("no recording to diagnose", remedy="Give one or more runs")
    return _alike(good, bad), bad, notes


def _alike(good: list[Recording], bad: list[dict[str, str]]) -> list[Recording]:
    """Those of the first recording's rig and rate."""
    first = good[0]
    kept = []
    for recording in good:
        if recording.setup.system is not first.setup.system:
            bad.append(
                {"file": recording.name, "why": f"rig {recording.setup.system}, the campaign's is {first.setup.system}"}
            )
        elif abs(recording.dt - first.dt) > 1e-3 * first.dt:
            bad.append(
                {"file": recording.name, "why": f"{1 / recording.dt:.0f} Hz, the campaign has {1 / first.dt:.0f} Hz"}
            )
        else:
            kept.append(recording)
    return kept


def _refuse(what: str, where: str, remedy: str, value: object = None) -> None:
    raise InputError(what, where=where, value=value, remedy=remedy)


def _whole(name: str, values: Float, where: str, notes: list[str]) -> tuple[Float, NDArray[np.bool_]]:
    """A channel without NaN: few are bridged and not used, many are refused."""
    lost = ~np.isfinite(values)
    if lost.all() or lost.mean() > FEW:
        share = 100 * float(lost.mean())
        _refuse(f"{name}: {share:.1f} % of its samples are not numbers", where, "Record again, or cut the gap out")
    if not lost.any():
        return values, lost
    notes.append(f"{name}: {int(lost.sum())} samples are not numbers; bridged and left out")
    index = np.arange(len(values))
    return np.interp(index, index[~lost], values[~lost]), np.convolve(lost, np.ones(5), "same") > 0


def _plausible(name: str, values: Float, where: str) -> None:
    spread = float(np.ptp(values))
    if spread == 0.0 and name != "drive_force":
        _refuse(f"{name} is constant", where, "Check its cable and its gauge", float(values[0]))
    if spread > LARGEST.get(name, np.inf):
        _refuse(
            f"{name} spans {spread:.3g}", where, "Its @units are probably wrong: state those of the numbers", spread
        )


def _clipped(name: str, values: Float, notes: list[str]) -> None:
    top = values >= values.max()
    runs = np.diff(np.flatnonzero(np.diff(np.concatenate([[0], top.astype(int), [0]]))))[::2]
    if len(runs) and runs.max() >= 6 and top.mean() < 0.5:
        notes.append(f"{name}: {int(top.sum())} samples stand at its highest value {values.max():.4g}: clipped?")


def _rest(recording: Recording, channels: dict[str, Float], where: str) -> None:
    """The rest at the beginning: there, and of the force that the setup says, within a factor."""
    setup = recording.setup
    if setup.system is not System.WFPD:
        return
    n = max(8, round(0.4 / recording.dt))
    force, expected = float(np.mean(channels["fibre_force"][:n])), setup.rest_tension
    if not 0.2 * expected < force < 5 * expected:
        remedy = "Check the force's @units and sign (tension positive), or the setup's mass and incline"
        _refuse(f"rest force {force:.3g} N, the setup says {expected:.3g} N", where, remedy, force)
    moved = max(float(np.ptp(channels[c][:n])) for c in ("drive_position", "weight_position"))
    if moved > 1e-3:
        remedy = "A recording begins with 0.4 s of rest; cut it so or record again"
        _refuse(f"moves by {1e3 * moved:.2f} mm in its first 0.4 s", where, remedy)
