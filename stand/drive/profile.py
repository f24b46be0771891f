"""A drive's profile: a TOML file in `stand/profiles/drives` that says where the drive keeps what."""

from __future__ import annotations

import tomllib
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from stand.drive.address import CIA402, Address, parse_address
from stand.errors import InputError
from stand.units import conversion

FOLDER = Path(__file__).parent.parent / "profiles" / "drives"
Order = Literal["big", "little"]
QuantityName = Literal["position", "velocity", "acceleration"]


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class Identity(_Part):
    """Who made it and where its map was read."""

    name: str
    vendor: str
    source: str
    verified: Literal["manual", "vendor-client", "hardware", "third-party"] = "manual"


class RtuSettings(_Part):
    """The device's own RTU settings."""

    baud: int = 115200
    parity: Literal["N", "E", "O"] = "E"
    stopbits: int = 1
    interframe_us: int = 1750


class LinkSection(_Part):
    """What the device speaks, and how much of it at once."""

    transports: tuple[Literal["tcp", "rtu"], ...] = ("tcp",)
    unit_id: int = 1
    tcp_port: int = 502
    max_read: int = 125
    max_write: int = 123
    fc: tuple[int, ...] = (3, 16)
    one_in_flight: bool = True
    rtu: RtuSettings = RtuSettings()


class Probe(_Part):
    """An object read both ways at start-up to find the word order."""

    object: str
    via: Literal["mei13"] = "mei13"


class Encoding(_Part):
    """How values stand in registers; `probe` checks it at start-up."""

    backend: Literal["image", "direct", "mei13", "table"]
    word_order: Order = "big"
    byte_order: Order = "big"
    probe: Probe | None = None


class Image(_Part):
    """The process image: registers, mapping objects, and what is mapped, in order; "pad8", "pad16" fill."""

    tx: int = 5000
    rx: int = 6000
    tx_mapping: str = "3602"
    rx_mapping: str = "3502"
    configure_mapping: bool = True
    tx_map: tuple[str, ...]
    rx_map: tuple[str, ...]


class Scale(_Part):
    """One raw count is `scale` of `unit`."""

    scale: float
    unit: str


class Units(_Part):
    """Scales of position, velocity and acceleration."""

    position: Scale
    velocity: Scale
    acceleration: Scale

    def si(self, quantity: QuantityName) -> float:
        """SI of one raw count."""
        given: Scale = getattr(self, quantity)
        like = {"position": "m", "velocity": "m/s", "acceleration": "m/s^2"}[quantity]
        return given.scale * conversion(given.unit, like, f"units.{quantity}")


class State(_Part):
    """The state machine that the device keeps."""

    machine: Literal["cia402", "profidrive111", "orca-modes", "iai"] = "cia402"


class QuickStop(_Part):
    """The write that stops at once."""

    action: Literal["controlword"] = "controlword"
    value: int = 0x0002


class Watchdog(_Part):
    """The drive's own watch over the link, where it has one."""

    kind: Literal["none", "register", "client"] = "none"
    register_: int | None = Field(None, alias="register")
    scale_ms: float = 1.0
    max_ms: float = 5000.0


class MotionTable(_Part):
    """Points that the drive could run through by itself, as far as they are known; motions are streamed."""

    kind: Literal["none", "points", "kinematic"] = "none"
    base: int = 0
    stride: int = 1
    entry: tuple[str, ...] = ()
    count: int = 0
    select: int | None = None


class Trace(_Part):
    """A counted ring of position samples in registers.

    newest: register of the newest sample as i32; where it is given, slot k mod depth holds sample k less sample k - 1,
    and 16-bit slots lie two to a 32-bit number.
    """

    kind: Literal["none", "ring"] = "none"
    head: int = 0
    head_type: Literal["u16", "u32"] = "u32"
    newest: int | None = None
    base: int = 0
    depth: int = 0
    record: Literal["i16", "i32"] = "i32"
    scale: float = 1.0
    unit: str = "m"
    clock_hz: float = 1000.0


class Quantity(_Part):
    """A value in registers of its own (back-end `table`)."""

    reg: int
    type: Literal["u16", "i16", "u32", "i32"] = "i32"
    fc: Literal[3, 4] = 3
    scale: float = 1.0


class Homing(_Part):
    """The homing method that the profile uses where the stand names none (35: here is zero)."""

    method: int = 35


class Motion(_Part):
    """A planned motion is executed as a stream of velocities; gain: feedback of position on them, 1/s."""

    gain: float = 15.0


class DriveProfile(_Part):
    """One drive's map; see the module's folder for examples."""

    profile: Identity
    link: LinkSection = LinkSection()
    encoding: Encoding
    image: Image | None = None
    units: Units
    state: State = State()
    limits: dict[str, str] = {}
    watchdog: Watchdog = Watchdog.model_construct()
    quickstop: QuickStop = QuickStop()
    table: MotionTable = MotionTable()
    trace: Trace = Trace()
    homing: Homing = Homing()
    motion: Motion = Motion()
    objects: dict[str, str] = {}
    absent: tuple[str, ...] = ()
    quantities: dict[str, Quantity] = {}

    @cached_property
    def addresses(self) -> dict[str, Address]:
        """Objects by the driver's names: CiA 402, with the profile's changes."""
        named = {k: v for k, v in {**CIA402, **self.objects}.items() if k not in self.absent}
        return {name: parse_address(text, f"{self.profile.name}: objects.{name}") for name, text in named.items()}


def profile_names() -> tuple[str, ...]:
    """The profiles in the folder."""
    return tuple(sorted(path.stem for path in FOLDER.glob("*.toml")))


def load_profile(name: str, where: str = "drive.profile") -> DriveProfile:
    """A profile by name, or by the path of a file of one's own; InputError naming file, key and remedy."""
    path = Path(name) if name.endswith(".toml") else FOLDER / f"{name}.toml"
    if not path.exists():
        known = ", ".join(profile_names())
        raise InputError("no drive profile of that name", where=where, value=name, remedy=f"Known: {known}")
    return parse_profile(path.read_text(encoding="utf-8"), str(path))


def parse_profile(text: str, where: str) -> DriveProfile:
    """A profile from its text."""
    try:
        tables: dict[str, Any] = tomllib.loads(text)
        profile = DriveProfile.model_validate(tables)
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"not valid TOML: {error}", where=where, remedy="Mend the line that it names") from error
    except ValidationError as error:
        first = error.errors()[0]
        key = ".".join(map(str, first["loc"]))
        raise InputError(first["msg"], where=f"{where}: {key}", value=first["input"], remedy="Mend the key") from error
    if profile.encoding.backend == "image" and profile.image is None:
        raise InputError("the image back-end needs [image]", where=where, remedy="Add the section")
    return profile
