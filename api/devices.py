"""The devices' states as the screens show them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from stand.config import Stand
    from stand.runs import Health

TITLES = {"drive": "Drive", "force_gauge": "Force gauge", "dial_gauge": "Dial gauge"}
VALUES = {"drive": ("travel", "mm", 1e3), "force_gauge": ("force", "N", 1.0), "dial_gauge": ("reading", "mm", 1e3)}


def resting(stand: Stand, state: str, found: Mapping[str, Any] | None = None) -> list[dict[str, Any]]:
    """Every device while no run reads it. state: of those that `found` (a status step's findings) says nothing of."""
    found = found or {}
    return [
        {
            "name": name,
            "title": TITLES.get(name, name),
            "state": found.get(name, {}).get("state", state),
            "detail": found.get(name, {}).get("problem") or _link(instrument.link),
            "latency": instrument.latency,
            "fields": _fields(name, found),
        }
        for name, instrument in stand.instruments.items()
    ]


def problems(found: Mapping[str, Any]) -> str:
    """Why devices can't be reached, in words; empty where all can."""
    return ". ".join(
        str(about["problem"]) for about in found.values() if isinstance(about, Mapping) and "problem" in about
    )


def running(stand: Stand, health: Health) -> list[dict[str, Any]]:
    """Every device as the run's health tells."""
    devices = resting(stand, "unknown")
    for device in devices:
        seen = health.instruments.get(device["name"])
        if seen is not None:
            device |= {"state": seen.state, "rate": _number(seen.rate), "age": _number(seen.age)}
            device |= {"samples": seen.samples, "skipped": seen.skipped, "flagged": seen.flagged}
    return devices


def _number(value: float) -> float | None:
    return round(value, 4) if value - value == 0.0 else None


def _link(link: Any) -> str:
    if link.kind == "tcp":
        return f"Modbus TCP {link.host}:{link.port}"
    return f"{'Modbus RTU' if link.kind == 'rtu' else 'serial'} {link.port}, {link.baud} baud"


def _fields(name: str, found: Mapping[str, Any]) -> dict[str, str]:
    """What a status step found of this device, in words."""
    about = dict(found.get(name, {}))
    word, unit, factor = VALUES.get(name, ("value", "", 1.0))
    fields = {}
    if isinstance(about.get("value"), float):
        fields[word] = f"{factor * about['value']:.2f} {unit}"
    if name == "drive" and (status := found.get("drive_status")):
        fields |= {"state": str(status.get("state")), "homed": "yes" if status.get("homed") else "no"}
        if status.get("fault_code"):
            fields["fault"] = f"{status['fault_code']:#06x}"
    return fields
