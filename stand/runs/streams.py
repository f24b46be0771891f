"""What the recorder is told of each instrument before a run."""

from __future__ import annotations

from collections.abc import Mapping

from stand.clock.polls import WORDS
from stand.config import GaugeConfig, RtuLink, Stand, TcpLink
from stand.drive.profile import load_profile
from stand.recorder import StreamSpec, Wire

RING_REGISTERS = 64
LONGEST_FRAME = 16
UNITS = {"drive": "m", "force_gauge": "N", "dial_gauge": "m"}


def stream_specs(stand: Stand, identities: Mapping[str, Mapping[str, str]]) -> tuple[StreamSpec, ...]:
    """One for each instrument, with its identity and calibration."""
    return tuple(_spec(stand, name, dict(identities.get(name, {}))) for name in stand.instruments)


def _spec(stand: Stand, name: str, identity: dict[str, str]) -> StreamSpec:
    instrument = stand.instruments[name]
    calibration = {
        "latency": (instrument.latency, "s"),
        "latency_uncertainty": (instrument.latency_uncertainty, "s"),
    }
    texts = {"identity": {key: str(value) for key, value in identity.items()}}
    if isinstance(instrument, GaugeConfig):
        texts["identity"]["codec"] = instrument.codec
        numbers = {"calibration": {**calibration, "scale": (instrument.scale, "1")}}
        sampling = f"sent by the device at {instrument.rate:g} Hz; frames counted by the host, timed by a fitted clock"
        return StreamSpec(
            name, Wire.BYTES, UNITS[name], instrument.rate, sampling,
            bytes_per_sample=LONGEST_FRAME, texts=texts, numbers=numbers,
        )  # fmt: skip
    texts["identity"]["profile"] = instrument.profile
    ring = load_profile(instrument.profile).trace.kind == "ring"
    if ring:
        sampling = f"read from the drive's counted ring of {instrument.rate:g} Hz over {_wire(instrument.link)}; "
        sampling += "between its samples interpolated"
    else:
        sampling = (
            f"position and velocity polled {instrument.poll_rate:g} times a second over {_wire(instrument.link)}; "
        )
        sampling += "derived: between polls of position and velocity interpolated"
    return StreamSpec(
        name, Wire.REGISTERS, UNITS[name], instrument.rate, sampling, width=RING_REGISTERS if ring else WORDS,
        reads_per_second=4 * instrument.poll_rate, texts=texts, numbers={"calibration": calibration},
    )  # fmt: skip


def _wire(link: TcpLink | RtuLink) -> str:
    return "Modbus TCP" if isinstance(link, TcpLink) else f"Modbus RTU at {link.baud} baud"
