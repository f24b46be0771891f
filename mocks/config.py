"""A simulated stand as a TOML file describes it; what is left out is drawn from the seed or takes its default."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from mocks.effects import find, names
from mocks.plant.rig import Rig

Hidden = dict[str, dict[str, float | str]]


class ConfigError(ValueError):
    """A file or an option that describes no stand: where, what, the value, the remedy."""

    def __init__(self, where: str, what: str, value: object, remedy: str) -> None:
        super().__init__(f"{where}: {what} (got {value!r}). {remedy}")


def _number(default: Any, low: float = -math.inf, high: float = math.inf) -> Any:
    return field(default=default, metadata={"low": low, "high": high})


def _choice(default: str, *choices: str) -> Any:
    return field(default=default, metadata={"choices": choices})


def _pair(low: float, high: float, least: float = 0.0) -> Any:
    return field(default=(low, high), metadata={"low": least, "pair": True})


@dataclass(frozen=True)
class DriveConfig:
    """The simulated drive. Lengths m, times s; drift in ppm, drawn within +-50 where None."""

    profile: str = _choice("nanotec-cia402", "nanotec-cia402")
    unit_id: int = _number(1, 0, 247)
    tcp_port: int = _number(0, 0, 65535)
    rtu_baud: int = _number(115_200, 1200, 4_000_000)
    word_order: str = _choice("big", "big", "little")
    byte_order: str = _choice("big", "big", "little")
    rest_travel: float = _number(0.030, 0.0, 0.100)
    encoder_resolution: float = _number(0.5e-6, 0.0, 1e-3)
    encoder_noise: float = _number(0.5e-6, 0.0, 1e-3)
    drift_ppm: float | None = _number(None, -1000, 1000)
    phase: float | None = _number(None, 0.0, 1.0)


@dataclass(frozen=True)
class GaugeConfig:
    """A simulated gauge. noise, quantisation, zero, limit in its SI unit; times s.

    bunching: s of the adapter's timer, 0 for none (bunching_error: share by which it may be off, drawn).
    jitter: least and most host jitter, s. batch: frames handed over at once where there is no timer.
    """

    baud: int = _number(230_400, 1200, 20_000_000)
    rate: float = _number(2000.0, 1.0, 12_000.0)
    noise: float = _number(0.1, 0.0)
    quantisation: float = _number(0.005, 0.0)
    zero: float | None = _number(None)
    limit: float = _number(1000.0, 0.0)
    conversion: float = _number(150e-6, 0.0, 0.1)
    bunching: float = _number(0.0, 0.0, 1.0)
    bunching_error: float = _number(0.003, 0.0, 0.1)
    jitter: tuple[float, float] = _pair(0.0, 0.0)
    batch: int = _number(8, 1, 200)
    drift_ppm: float | None = _number(None, -1000, 1000)
    phase: float | None = _number(None, 0.0, 1.0)


def _dial() -> GaugeConfig:
    return GaugeConfig(baud=921_600, noise=6e-6, quantisation=1e-7, limit=0.95, conversion=250e-6)


@dataclass(frozen=True)
class Fault:
    """A line of the control protocol, carried out `at` s after the start."""

    at: float = _number(0.0, 0.0)
    command: str = ""


@dataclass(frozen=True)
class StandConfig:
    """plant: true values that differ from the published stand's. errors: how far (in the operator's sigmas) the true
    values are drawn off the published ones, 0 for exact. hidden: effect -> parameters."""

    seed: int = _number(0, 0)
    errors: float = _number(0.0, 0.0, 10.0)
    drive: DriveConfig = field(default_factory=DriveConfig)
    force_gauge: GaugeConfig = field(default_factory=GaugeConfig)
    dial_gauge: GaugeConfig = field(default_factory=_dial)
    plant: Mapping[str, float] = field(default_factory=dict)
    hidden: Hidden = field(default_factory=dict)
    faults: tuple[Fault, ...] = ()


def load(path: Path | str | None) -> StandConfig:
    """The file's stand; ConfigError naming file, key, value and remedy. None: the default stand."""
    if path is None:
        return StandConfig()
    try:
        table = tomllib.loads(Path(path).read_text())
    except OSError as error:
        raise ConfigError(str(path), "can't be read", error.strerror, "Name a TOML file") from None
    except tomllib.TOMLDecodeError as error:
        raise ConfigError(str(path), "is no TOML", str(error), "Mend that line") from None
    return parse(table, str(path))


def parse(table: Mapping[str, Any], where: str = "config") -> StandConfig:
    """The stand that a TOML table describes; ConfigError."""
    known = [f.name for f in fields(StandConfig)]
    for key in table:
        if key not in known:
            raise ConfigError(f"{where}: {key}", "unknown key", table[key], f"There are {', '.join(known)}")
    start, found = StandConfig(), {}
    for name in ("drive", "force_gauge", "dial_gauge"):
        found[name] = _section(getattr(start, name), _table(table, name, where), f"{where}: {name}")
    for name in ("seed", "errors"):
        if name in table:
            found[name] = _value(_metadata(StandConfig, name), start, name, table[name], where)
    found["plant"] = _plant(_table(table, "plant", where), f"{where}: plant")
    found["hidden"] = hidden_effects(_table(table, "hidden", where), f"{where}: hidden")
    found["faults"] = _faults(table.get("faults", []), where)
    return replace(start, **found)


def _table(table: Mapping[str, Any], name: str, where: str) -> Mapping[str, Any]:
    found = table.get(name, {})
    if not isinstance(found, Mapping):
        raise ConfigError(f"{where}: {name}", "is not a table", found, f"Write it as [{name}]")
    return found


def _metadata(kind: type, name: str) -> Mapping[str, Any]:
    return next(f.metadata for f in fields(kind) if f.name == name)


def _section(start: Any, table: Mapping[str, Any], where: str) -> Any:
    known = {f.name: f.metadata for f in fields(start)}
    found = {}
    for key, value in table.items():
        if key not in known:
            raise ConfigError(f"{where}.{key}", "unknown key", value, f"There are {', '.join(known)}")
        found[key] = _value(known[key], start, key, value, where)
    return replace(start, **found)


def _value(metadata: Mapping[str, Any], start: Any, key: str, value: Any, where: str) -> Any:
    at = f"{where}.{key}"
    if "choices" in metadata:
        if value not in metadata["choices"]:
            raise ConfigError(at, "not one of the choices", value, f"Choose {' or '.join(metadata['choices'])}")
        return value
    if metadata.get("pair"):
        if not isinstance(value, list) or len(value) != 2 or not _inside(value[0], metadata["low"], value[1]):
            raise ConfigError(at, "not a least and a most", value, "Write [least, most], least first, none negative")
        return float(value[0]), float(value[1])
    if key == "bunching" and value == "none":
        return 0.0
    whole = isinstance(getattr(start, key), int)
    if not _inside(value, metadata["low"], metadata["high"]) or (whole and not isinstance(value, int)):
        kind = "a whole number" if whole else "a number"
        raise ConfigError(
            at, f"not {kind} it can be", value, f"Give {kind} from {metadata['low']:g} to {metadata['high']:g}"
        )
    return value if whole else float(value)


def _inside(value: Any, low: float, high: Any) -> bool:
    numbers = all(isinstance(v, int | float) and not isinstance(v, bool) for v in (value, high))
    return numbers and bool(low <= value <= high)


def _plant(table: Mapping[str, Any], where: str) -> dict[str, float]:
    known = [f.name for f in fields(Rig) if f.name != "system"]
    for key, value in table.items():
        if key not in known:
            raise ConfigError(f"{where}.{key}", "unknown key", value, f"There are {', '.join(known)}")
        if not _inside(value, 0.0, 1e9):
            raise ConfigError(f"{where}.{key}", "not a number it can be", value, "Give it in SI, angles in rad")
    return {key: float(value) for key, value in table.items()}


def hidden_effects(table: Mapping[str, Any], where: str) -> Hidden:
    """Effects with their parameters checked; ConfigError."""
    found: Hidden = {}
    for name, values in table.items():
        if name not in names():
            raise ConfigError(f"{where}.{name}", "no such effect", name, f"There are {', '.join(names())}")
        if not isinstance(values, Mapping):
            raise ConfigError(f"{where}.{name}", "is not a table", values, f"Write it as [hidden.{name}]")
        try:
            find(name).complete(values)
        except ValueError as error:
            raise ConfigError(f"{where}.{name}", str(error), dict(values), "Use its own parameters") from None
        found[name] = dict(values)
    return found


def parse_hide(texts: Sequence[str]) -> Hidden:
    """NAME or NAME:parameter=value,... for each text; ConfigError."""
    table: dict[str, dict[str, float | str]] = {}
    for text in texts:
        name, _, rest = text.partition(":")
        pairs = [part.partition("=") for part in rest.split(",") if part]
        table[name] = {key: _number_or_word(value) for key, _, value in pairs}
    return hidden_effects(table, "--hide")


def _number_or_word(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


def _faults(items: Any, where: str) -> tuple[Fault, ...]:
    if not isinstance(items, list) or not all(isinstance(i, Mapping) for i in items):
        raise ConfigError(f"{where}: faults", "is no list of tables", items, "Write [[faults]] with at and command")
    found = []
    for k, item in enumerate(items):
        if set(item) != {"at", "command"} or not _inside(item["at"], 0.0, 1e9) or not isinstance(item["command"], str):
            raise ConfigError(
                f"{where}: faults[{k}]", "is no fault", dict(item), 'Write at = 2.0, command = "fault drive"'
            )
        found.append(Fault(float(item["at"]), item["command"]))
    return tuple(found)
