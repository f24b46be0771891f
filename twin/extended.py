"""The extended model as a file: calibrated values, causes with their parameters; loaded, a fibre model like any
other.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import twin.causes
from stand.errors import InputError
from stand.setup import Setup, System
from twin.causes._kind import Cause, named
from twin.model import FibreModel, Start
from twin.parameter import Parameter, Source
from twin.plugins import names

Float = NDArray[np.float64]
HISTORY = 1024  # samples of drive and of gauge signals that delays and lags look back on
HEAD = 16  # y (12), taut flags (2), time, samples seen


def to_toml(fitted: Any) -> str:
    """[model], [setup] as differences of base values (SI), [causes."name"] with parameters, [unknown] as a table."""
    model, z = fitted.model, fitted.z
    lines = ["[model]", 'base = "force"', f'system = "{model.setups[0].system}"', "", "[setup]"]
    for c in model.coordinates:
        if c.owner == "base":
            lines.append(f"{c.name} = {c.value(float(z[model.index['base', c.name]])):.12g}")
    for cause in model.causes:
        values = model.values(z, cause)
        if cause.name == "unknown":
            kind, low, step, _ = cause.pack(model.setups[0], {}, 0)[1:5]
            lines += [
                "",
                "[unknown]",
                f'place = "{cause.acts_on}"',
                f"kind = {kind:.0f}",
                f"low = {low:.12g}",
                f"step = {step:.12g}",
            ]
            lines.append("y = [" + ", ".join(f"{v:.9g}" for v in values.values()) + "]")
            continue
        lines += ["", f'[causes."{cause.name}"]']
        lines += [f"{name} = {value:.12g}" for name, value in values.items()]
    return "\n".join(lines) + "\n"


def load_model(path: Path | str, setup: Setup) -> tuple[FibreModel, dict[str, float], Setup]:
    """The extended model at `path`, its parameters by "cause:parameter", and `setup` with the calibrated values in it.

    Raises InputError where the file can't be read or names a cause that isn't known.
    """
    text = _read(Path(path))
    if text.get("model", {}).get("system", str(setup.system)) != str(setup.system):
        raise InputError("the model is of another rig", where=str(path), value=text["model"]["system"])
    causes = tuple(_cause(name, path) for name in text.get("causes", {}))
    built = _Built(causes, {c.name: dict(text["causes"][c.name]) for c in causes}, text.get("unknown"))
    calibrated = built.calibrated(setup, text.get("setup", {}))
    parameters = {f"{c}:{p}": float(v) for c, values in built.values.items() for p, v in values.items()}
    return _model(built, calibrated, Path(path)), parameters, calibrated


def _read(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(path.read_text())
    except (OSError, tomllib.TOMLDecodeError) as error:
        raise InputError(
            f"not a model file ({error})", where=str(path), remedy="`stand diagnose` writes one"
        ) from error


def _cause(name: str, path: Path | str) -> Cause:
    if name.split("/")[0] not in names(twin.causes):
        raise InputError("no cause of that name", where=str(path), value=name, remedy="See `stand causes`")
    return named(name)


@dataclass(frozen=True)
class _Built:
    causes: tuple[Cause, ...]
    values: Mapping[str, Mapping[str, float]]
    unknown: Mapping[str, Any] | None

    def all(self) -> tuple[Cause, ...]:
        return (*self.causes, *([_table(self.unknown)] if self.unknown else []))

    def calibrated(self, setup: Setup, differences: Mapping[str, float]) -> Setup:
        from twin.diagnosis.composition import Composition

        model = Composition((setup,), self.all())
        z = model.zero()
        for name, value in differences.items():
            i = model.index.get(("base", name))
            if i is not None:
                z[i] = value / model.coordinates[i].scale
        return model.setup(z, 0)


def _table(unknown: Mapping[str, Any]) -> Cause:
    from twin.diagnosis.latent import PLACES, TABLES

    place, y = str(unknown["place"]), [float(v) for v in unknown["y"]]
    head = (float(unknown["kind"]), float(unknown["low"]), float(unknown["step"]), float(len(y)))
    return Cause(
        name="unknown", title="a term outside the catalogue", acts_on=place, parameters=(),
        source=Source("learned"), order=8,
        pack=lambda setup, values, own: (0.0, *head, *y), **{PLACES[place][0]: TABLES[place]},
    )  # fmt: skip


def _model(built: _Built, calibrated: Setup, path: Path) -> FibreModel:
    engine = _Engine(built, calibrated)
    return FibreModel(
        name=path.name.removesuffix(".toml"),
        title="Force model with " + (", ".join(c.name for c in built.all()) or "calibrated values"),
        source=Source("diagnosis"),
        systems=frozenset({calibrated.system}),
        parameters=tuple(Parameter(f"{c.name}:{p.name}", p.unit, p.value) for c in built.causes for p in c.parameters),
        state=("u", "u'", "s", "s'"),
        constants=engine.constants,
        start=engine.start,
        advance=engine.advance,
        warm=engine.warm,
    )


class _Engine:
    """The composed stepper behind the four functions of a fibre model; causes are those of the file."""

    def __init__(self, built: _Built, calibrated: Setup) -> None:
        self.built, self.calibrated = built, calibrated

    def constants(self, setup: Setup, parameters: Mapping[str, float]) -> Float:
        """The kernel's constants of the setup; hooks are packed beside them."""
        from twin.diagnosis.composition import Composition

        model = Composition((setup,), self.built.all())
        z = model.zero()
        for cause in self.built.causes:
            if cause.base is None:
                own = {
                    p.name: parameters.get(f"{cause.name}:{p.name}", self.built.values[cause.name][p.name])
                    for p in cause.parameters
                }
                z = model.put(z, cause, own)
        self.hooks = {kind: model.hooks(z, kind) for kind in ("before", "after", "senses", "moves")}
        row: Float = model.constants(z, [setup.rest_tension])[0]
        return row

    def start(self, c: Float, at: Start) -> Float:
        """y, modes, time, and a history that stood still before."""
        from twin.kernels import composed_slots as k

        state = np.zeros(HEAD + HISTORY * 7)
        share = c[k.K_C1] / (c[k.K_C1] + c[k.K_C2]) if c[k.K_SYSTEM] == k.WFPD else 0.0
        state[0], state[1] = at.u, at.v
        if c[k.K_SYSTEM] == k.WFPD:
            w = share * at.v + (1 - share) * at.w if at.rim_speed is None else at.rim_speed
            s = share * at.u + (1 - share) * at.x
            if at.force is not None and at.force > 0:
                s = at.x + (c[k.K_REST] + c[k.K_B2] * (at.w - w) - at.force) / c[k.K_C2]
            state[2], state[3] = (at.s if at.s is not None else s), w
        state[12:14] = 1.0
        history = state[HEAD:].reshape(HISTORY, 7)
        history[:, 0], history[-1, 1] = at.x, at.w
        force = at.force if at.force is not None else c[k.K_REST]
        history[:, 2], history[:, 4] = at.u, force
        return state

    def advance(self, c: Float, state: Float, drive: Float, dt: float, out: Float) -> int:
        """Drive through the input hooks, the stepper, then the gauges' hooks; all with their history."""
        from twin.kernels import composed, composed_sense
        from twin.kernels import composed_slots as k

        n = len(drive) - 1
        history = state[HEAD:].reshape(HISTORY, 7)
        x = np.concatenate([history[:, 0], drive[1:, 0]])
        speed = np.concatenate([history[:, 1], drive[1:, 1]])
        x[HISTORY - 1], speed[HISTORY - 1] = drive[0]
        moved, pace = x.copy(), speed.copy()
        composed_sense.drive_end(moved, pace, dt, self.hooks["moves"].address, self.hooks["moves"].p)
        row = np.zeros((len(x), 5))
        row[:HISTORY] = history[:, 2:]
        mode = state[12:14].astype(np.int64)
        y = state[:12].copy()
        ends = np.ascontiguousarray(np.column_stack([moved, pace])[HISTORY - 1 :])
        b, a = self.hooks["before"], self.hooks["after"]
        true = np.zeros((n, 5))
        rest = np.ascontiguousarray(c[: k.CONSTANTS])
        status = int(composed.carry(y, rest, ends, state[14], dt, b.address, b.p, a.address, a.p, mode, true))
        row[HISTORY:] = true
        told = np.empty((1, len(x), 2))
        senses, zero = self.hooks["senses"], np.zeros(1, np.int64)
        first = np.array([round(state[14] / dt) - HISTORY + 1], np.int64)
        composed_sense.sense(row[None], zero, first, dt, 0.0, 0.0, senses.address, senses.p, told)
        out[:, 0], out[:, 1], out[:, 2] = told[0, HISTORY:, 0], true[:, 1], told[0, HISTORY:, 1]
        state[:12], state[12:14], state[14] = y, mode, state[14] + n * dt
        history[:, 0], history[:, 1] = x[-HISTORY:], speed[-HISTORY:]
        history[:, 2:] = row[-HISTORY:]
        return status

    def warm(self) -> None:
        """Loads the kernels."""
        from twin.kernels import composed, composed_sense  # noqa: F401


__all__ = ["System", "load_model", "to_toml"]
