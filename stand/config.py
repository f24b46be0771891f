"""The stand as its TOML file describes it: setup, instruments, links, limits. SI inside, units in the file."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, TypeAlias

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, PlainSerializer, ValidationError, model_validator
from pydantic_core import PydanticCustomError

from stand.codecs.codec import load_codec
from stand.drive.profile import load_profile
from stand.errors import InputError
from stand.setup import Setup, check
from stand.setup_table import read_setup, setup_table, write_toml
from stand.units import parse_quantity

RTU_UNCERTAINTY = 0.5e-3
DEFAULT = Path(__file__).parent / "profiles" / "stand.toml"


def _quantity(unit: str) -> Any:
    def parse(value: Any) -> float:
        if isinstance(value, bool) or not isinstance(value, str | int | float):
            raise _refusal("not a number with a unit", f'Write it like "1.5 {unit}"')
        try:
            return parse_quantity(value, unit)
        except InputError as error:
            raise _refusal(error.what, error.remedy) from error

    return Annotated[float, BeforeValidator(parse), PlainSerializer(lambda v: f"{v!r} {unit}".strip())]


def _refusal(what: str, remedy: str) -> PydanticCustomError:
    return PydanticCustomError("refused", "{what}", {"what": what, "remedy": remedy})


Metre: TypeAlias = _quantity("m")  # type: ignore[valid-type]
Speed: TypeAlias = _quantity("m/s")  # type: ignore[valid-type]
Acceleration: TypeAlias = _quantity("m/s^2")  # type: ignore[valid-type]
Jerk: TypeAlias = _quantity("m/s^3")  # type: ignore[valid-type]
Newton: TypeAlias = _quantity("N")  # type: ignore[valid-type]
Second: TypeAlias = _quantity("s")  # type: ignore[valid-type]
Hertz: TypeAlias = _quantity("Hz")  # type: ignore[valid-type]


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class TcpLink(_Part):
    """Modbus TCP."""

    kind: Literal["tcp"] = "tcp"
    host: str = "127.0.0.1"
    port: int = Field(default=502, ge=1, le=65535)
    unit_id: int = Field(default=1, ge=0, le=255)
    timeout: Second = 0.5


class RtuLink(_Part):
    """Modbus RTU on a serial port."""

    kind: Literal["rtu"]
    port: str
    unit_id: int = Field(default=1, ge=1, le=247)
    baud: int = Field(default=115200, gt=0)
    parity: Literal["N", "E", "O"] = "E"
    stopbits: int = Field(default=1, ge=1, le=2)
    interframe: Second = 0.00175
    timeout: Second = 0.5


class SerialLink(_Part):
    """A serial stream, 8N1."""

    kind: Literal["serial"] = "serial"
    port: str = ""
    baud: int = Field(gt=0)


class _Timed(_Part):
    """rate: nominal, Hz. latency: sample taken -> its last byte in the host's hands, earliest case, s.

    latency_uncertainty: its one sigma, s. stale: seconds without a sample after which the run trips.
    """

    rate: Hertz
    latency: Second = 0.0
    latency_uncertainty: Second = Field(default=20e-6, ge=0)
    stale: Second = Field(default=0.25, gt=0)


class DriveConfig(_Timed):
    """The drive: its profile's name, its link, and where along its travel a run rests.

    latency: of a poll, by how much the answer's way is longer than the question's, halved, s; what the bytes need on
    a serial bus not counted. latency_uncertainty: on RTU 0.5 ms where the file states none.
    """

    profile: str = "nanotec-cia402"
    link: Annotated[TcpLink | RtuLink, Field(discriminator="kind")] = TcpLink()
    rate: Hertz = 1000.0
    latency_uncertainty: Second = Field(default=5e-6, ge=0)
    poll_rate: Hertz = Field(default=100.0, gt=0)
    command_rate: Hertz = Field(default=200.0, gt=0)
    rest_travel: Metre = 0.030
    homing_method: int = 0
    direction: Literal[-1, 1] = 1

    @model_validator(mode="before")
    @classmethod
    def _slower_on_rtu(cls, given: Any) -> Any:
        if isinstance(given, dict) and isinstance(link := given.get("link"), dict) and link.get("kind") == "rtu":
            return {"latency_uncertainty": RTU_UNCERTAINTY, **given}
        return given


class GaugeConfig(_Timed):
    """A streaming gauge: its codec's name, its link; true = scale * shown; full_scale: SI, for integer frames."""

    codec: str
    link: SerialLink
    rate: Hertz = 2000.0
    scale: float = 1.0
    full_scale: float | None = None


class Limits(_Part):
    """What the stand admits; ranges are [low, high]. travel is the drive's coordinate, the rest relative to rest."""

    travel: tuple[Metre, Metre] = (0.0, 0.100)
    speed: Speed = Field(default=1.0, gt=0)
    acceleration: Acceleration = Field(default=12.0, gt=0)
    jerk: Jerk = Field(default=400.0, gt=0)
    force: tuple[Newton, Newton] = (-20.0, 1000.0)
    weight_position: tuple[Metre, Metre] = (-0.050, 0.250)
    rest_force_tolerance: Newton = Field(default=8.0, gt=0)

    @model_validator(mode="after")
    def _ordered(self) -> Limits:
        for name in ("travel", "force", "weight_position"):
            low, high = getattr(self, name)
            if not low < high:
                raise _refusal(f"the low end of {name} is not below its high end", "Give it as [low, high]")
        return self


class Storage(_Part):
    """Where run files go."""

    folder: Path = Path("runs")


class Stand(_Part):
    """One stand, frozen: what is measured on, with what, within which limits."""

    model_config = ConfigDict(frozen=True, extra="forbid", arbitrary_types_allowed=True)

    name: str = "stand"
    setup: Setup
    drive: DriveConfig = DriveConfig()
    force_gauge: GaugeConfig
    dial_gauge: GaugeConfig
    limits: Limits = Limits()
    storage: Storage = Storage()

    @property
    def instruments(self) -> Mapping[str, DriveConfig | GaugeConfig]:
        """The instruments by their names in files."""
        return {"drive": self.drive, "force_gauge": self.force_gauge, "dial_gauge": self.dial_gauge}

    def with_links(self, announcement: Mapping[str, Any]) -> Stand:
        """The same stand on the ports (and calibrated latencies) that a simulated stand announces."""
        drive, latency = announcement["drive"], dict(announcement.get("latency") or {})
        link: dict[str, Any] = {"unit_id": drive.get("unit_id", 1)}
        if isinstance(self.drive.link, RtuLink):
            baud = drive.get("rtu_baud", self.drive.link.baud)
            link |= {"port": drive["rtu"], "baud": baud, "parity": "N"}  # a pseudo-terminal carries no parity
            latency.pop("drive", None)  # announced of TCP
        else:
            host, _, port = str(drive["tcp"]).rpartition(":")
            link |= {"host": host, "port": int(port)}
        changed: dict[str, Any] = {"drive": _relink(self.drive, link, latency.get("drive"))}
        for name in ("force_gauge", "dial_gauge"):
            gauge = announcement[name]
            link = {"port": gauge["port"], "baud": gauge.get("baud", self.instruments[name].link.baud)}  # type: ignore[union-attr]
            changed[name] = _relink(self.instruments[name], link, latency.get(name))
        return self.model_copy(update=changed)

    def with_setup(self, setup: Setup) -> Stand:
        """The same stand with another setup, such as the added mass mounted."""
        return self.model_copy(update={"setup": check(setup)})

    def to_toml(self) -> str:
        """Text that `load_stand_text` reads back to an equal stand."""
        tables = self.model_dump(mode="json", exclude={"setup"}, exclude_none=True)
        return write_toml({"name": tables.pop("name"), "setup": setup_table(self.setup), **tables})


def _relink(instrument: Any, link: Mapping[str, Any], latency: float | None) -> Any:
    update: dict[str, Any] = {"link": instrument.link.model_copy(update=dict(link))}
    if latency is not None:
        update["latency"] = float(latency)
    return instrument.model_copy(update=update)


def load_stand(path: Path | str | None = None) -> Stand:
    """The stand at `path`, or the nominal one; InputError naming file, key, value and remedy.

    What it names, the drive's profile and the gauges' codecs, is there.
    """
    path = DEFAULT if path is None else Path(path)
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"can't be read ({error.strerror})", where=str(path), remedy="Check the path") from error
    stand = load_stand_text(text, str(path))
    load_profile(stand.drive.profile, f"{path}: drive.profile")
    for name, gauge in stand.instruments.items():
        if isinstance(gauge, GaugeConfig):
            load_codec(gauge.codec, f"{path}: {name}.codec")
    return stand


def load_stand_text(text: str, where: str = "stand") -> Stand:
    """The stand that a TOML text describes; InputError as for `load_stand`."""
    try:
        tables = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"not valid TOML: {error}", where=where, remedy="Mend the line that it names") from error
    tables["setup"] = read_setup(tables.get("setup", {}), f"{where}: setup")
    try:
        return Stand.model_validate(tables)
    except ValidationError as error:
        raise _explain(error, where) from error


def _explain(error: ValidationError, where: str) -> InputError:
    first = error.errors()[0]
    parts = [str(p) for p in first["loc"] if p not in ("tcp", "rtu")]
    message = str(first["msg"])
    remedy = {
        "extra_forbidden": "Remove the key or mend its spelling",
        "missing": "Add the key",
        "union_tag_invalid": 'Use kind = "tcp" or kind = "rtu"',
    }.get(first["type"], first.get("ctx", {}).get("remedy", "Mend the value"))
    value = None if first["type"] == "missing" else first["input"]
    return InputError(
        message[:1].lower() + message[1:], where=f"{where}: {'.'.join(parts)}", value=value, remedy=remedy
    )
