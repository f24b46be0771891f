"""Recordings of the simulated stand without its instruments: `python -m mocks record --out run.h5 --situation 3c`."""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocks.effects import Value, find
from mocks.plant.layout import write
from mocks.plant.linear import axis, wander
from mocks.plant.motion import SITUATIONS, Motion, targets
from mocks.plant.operator import Stand, draw_stand
from mocks.plant.plant import GRID, Plant
from mocks.plant.release import release
from mocks.plant.rig import LINEAR_DRIVE, WF, WFPD, Rig, linear_drive, weight_fibre
from mocks.plant.world import World

Float = NDArray[np.float64]
Hidden = Mapping[str, Mapping[str, Value]]

RATE = 2000.0
INSTRUMENT = {
    "drive_position": "drive",
    "weight_position": "dial_gauge",
    "fibre_force": "force_gauge",
    "drive_force": "force_gauge",
}
ZERO_REST = 0.5  # s at the beginning from which the zeros of u and x are taken


@dataclass(frozen=True)
class Noise:
    """One sigma and the step of each channel, m and N."""

    x: float = 5e-6
    u: float = 6e-6
    F: float = 0.12
    x_step: float = 5e-7
    u_step: float = 1e-7
    F_step: float = 0.005

    def of(self, channel: str) -> tuple[float, float]:
        """Sigma and step of a channel."""
        key = {"drive_position": "x", "weight_position": "u", "fibre_force": "F", "drive_force": "F"}[channel]
        return getattr(self, key), getattr(self, f"{key}_step")


def record(
    stand: Stand,
    motion: Motion,
    *,
    path: Path | str,
    seconds: float = 10.0,
    seed: int = 0,
    hidden: Hidden | None = None,
    noise: Noise | None = None,
) -> Path:
    """One run to `path`, its truth to `path` with suffix .truth.json; the same seed gives the same bytes.

    The stand's system decides what is recorded: weight-fibre-pulley-drive, weight-fibre (motion of shape "release") or
    linear-drive (the motion's own shape is not used: it wanders). ValueError where motion and stand do not fit.
    """
    hidden, noise, path = hidden or {}, noise or Noise(), Path(path)
    stand = stand.with_mass(motion.added_mass)
    signals, time, world = _run(stand, motion, seconds, seed, hidden)
    channels = sample(signals, time, world, noise, np.random.default_rng(seed))
    sigma = {name: noise.of(name)[0] for name in channels}
    ordered = {} if stand.believed.system == LINEAR_DRIVE else motion.ordered(seconds)
    write(path, stand, channels, sigma, RATE, ordered)
    write_truth(path, truth(stand, hidden, seed, noise, motion))
    return path


def _run(
    stand: Stand, motion: Motion, seconds: float, seed: int, hidden: Hidden
) -> tuple[dict[str, Float], Float, World]:
    """Signals on the plant's grid, that grid, and the world that made them."""
    rig = stand.hiding(hidden)
    if rig.system == LINEAR_DRIVE:
        world, time, position, force = axis(rig, wander(seconds, seed), hidden)
        return {"drive_position": position, "drive_force": force}, time, world
    if rig.system == WF:
        plant, run = release(rig, motion.drop_height, seconds, hidden)
        return {"weight_position": run.u, "fibre_force": run.F}, run.time, plant.world
    plant = Plant(rig, hidden)
    run = plant.follow(targets(motion, seconds, GRID))
    return {"drive_position": run.x, "weight_position": run.u, "fibre_force": run.F}, run.time, plant.world


def sample(
    signals: Mapping[str, Float], time: Float, world: World, noise: Noise, rng: np.random.Generator
) -> dict[str, Float]:
    """The channels as the instruments give them at RATE: by own clocks, noisy, in steps, u and x from the rest."""
    wanted = time[0] + (np.arange(round((time[-1] - time[0]) * RATE)) + 1.0) / RATE - GRID
    channels = {}
    for name, signal in signals.items():
        values = np.interp(wanted / (1.0 + world.clocks.get(INSTRUMENT[name], 0.0)), time, signal)
        sigma, step = noise.of(name)
        values = values + sigma * rng.standard_normal(len(values))
        values = np.round(values / step) * step if step else values
        if not name.endswith("_force"):
            values -= values[: round(ZERO_REST * RATE)].mean()
        channels[name] = values
    return channels


def truth(stand: Stand, hidden: Hidden, seed: int, noise: Noise, motion: Any) -> dict[str, Any]:
    """What a sidecar states: hidden effects with sizes, the true setup, the noise."""
    return {
        "hidden": [told(name, values) for name, values in hidden.items()],
        "true_setup": asdict(stand.hiding(hidden)),
        "believed_setup": asdict(stand.believed),
        "uncertainty": dict(stand.uncertainty),
        "noise": asdict(noise),
        "motion": asdict(motion),
        "seed": seed,
    }


def told(name: str, values: Mapping[str, Value]) -> dict[str, Any]:
    """One hidden effect with its parameters in the verdict's names and units."""
    effect = find(name)
    complete = effect.complete(values)
    parameters = {s.name: {"value": complete[s.name], "units": s.unit} for s in effect.sizes}
    return {
        "name": name,
        "acts_on": effect.acts_on,
        "parameters": parameters,
        "catalogued": effect.catalogued,
        "depends_on": list(effect.depends_on),
    }


def write_truth(path: Path, content: Mapping[str, Any]) -> Path:
    """`content` beside a recording, as JSON (infinities as null)."""
    side = path.with_suffix(".truth.json")
    side.write_text(json.dumps(_finite(content), indent=1) + "\n")
    return side


def _finite(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {k: _finite(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(v) for v in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def parse_hidden(texts: Sequence[str]) -> dict[str, dict[str, Value]]:
    """ "NAME" or "NAME:parameter=value,..." for each text; KeyError or ValueError where there is no such thing."""
    hidden: dict[str, dict[str, Value]] = {}
    for text in texts:
        name, _, rest = text.partition(":")
        pairs = dict(part.split("=", 1) for part in rest.split(",") if part)
        effect = find(name)
        kinds = {size.name: size for size in effect.sizes}
        effect.complete(pairs)
        hidden[name] = {k: v if kinds[k].choices else float(v) for k, v in pairs.items()}
    return hidden


def main_record(argv: Sequence[str] | None = None) -> int:
    """The command line; exit code 2 for what can't be recorded."""
    parser = _parser()
    given = parser.parse_args(argv)
    try:
        hidden = parse_hidden(given.hide)
        stand = draw_stand(given.seed, _believed(given), errors=0.0 if given.exact_setup else 1.0)
        if given.stick:
            stand = replace(stand, true=stand.true.but(guide_friction_velocity=0.0))
        if given.campaign:
            from mocks.plant.campaign import write_campaign

            for path in write_campaign(Path(given.out), stand, given.seed, hidden):
                print(path)
            return 0
        print(record(stand, _motion(given), path=given.out, seconds=given.seconds, seed=given.seed, hidden=hidden))
    except (KeyError, ValueError) as error:
        parser.error(str(error.args[0]))
    return 0


def _believed(given: argparse.Namespace) -> Rig:
    rigs = {WF: lambda: weight_fibre(given.incline), LINEAR_DRIVE: linear_drive}
    return rigs.get(given.system, Rig)()


def _motion(given: argparse.Namespace) -> Motion:
    if given.system == WF:
        return Motion("release", drop_height=given.drop_height, added_mass=given.added_mass or 0.0)
    if given.shape is None:
        motion = SITUATIONS[given.situation]
        return motion if given.added_mass is None else Motion(**asdict(motion) | {"added_mass": given.added_mass})
    return Motion(given.shape, given.frequency, given.amplitude, given.ramp, given.added_mass or 0.0)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m mocks record", description=__doc__)
    parser.add_argument("--out", required=True, help="the HDF5 file; with --campaign a folder")
    parser.add_argument("--situation", choices=sorted(SITUATIONS), default="3c")
    parser.add_argument("--shape", choices=("rectangular", "trapezoidal", "quasi-sinusoidal"))
    for name, default in (("frequency", 1.0), ("amplitude", 0.03), ("ramp", 0.2), ("seconds", 10.0)):
        parser.add_argument(f"--{name}", type=float, default=default)
    parser.add_argument("--system", choices=(WFPD, WF, LINEAR_DRIVE), default=WFPD)
    parser.add_argument("--incline", type=float, default=30.0, help="deg, for weight-fibre")
    parser.add_argument("--drop-height", type=float, default=0.012, help="m, for weight-fibre")
    parser.add_argument("--added-mass", type=float, help="kg")
    parser.add_argument("--hide", action="append", default=[], metavar="NAME[:parameter=value,...]")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--exact-setup", action="store_true", help="the operator's values are the true ones")
    parser.add_argument("--stick", action="store_true", help="the guide's dry friction truly sticks at rest")
    parser.add_argument("--campaign", action="store_true", help="six runs of 10 s instead of one")
    return parser


if __name__ == "__main__":
    raise SystemExit(main_record())
