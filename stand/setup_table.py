"""A `[setup]` table in lab units read as a Setup, and tables written as TOML text."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from stand.errors import InputError
from stand.setup import SCALARS, Setup, System, check, nominal
from stand.units import parse_quantity


def read_setup(table: Mapping[str, Any], where: str = "setup") -> Setup:
    """A `[setup]` table as a Setup: `name = "3.096 kg"` or `name = { value = ..., uncertainty = ... }`."""
    system = _system(table.get("system", System.WFPD), where)
    values: dict[str, Any] = {}
    sigma: dict[str, float] = {}
    for name, given in table.items():
        if name == "system":
            continue
        if name not in SCALARS:
            known = ", ".join(SCALARS)
            raise InputError("unknown key", where=f"{where}.{name}", value=given, remedy=f"Known: {known}")
        entry = given if isinstance(given, Mapping) else {"value": given}
        unit, key = SCALARS[name], f"{where}.{name}"
        if "value" in entry:
            values[name] = parse_quantity(entry["value"], unit, key)
        if "uncertainty" in entry:
            sigma[name] = _sigma(entry["uncertainty"], values.get(name), unit, key)
    return check(nominal(system).with_values(**values, uncertainty=sigma), where)


def _sigma(given: str | float, value: float | None, unit: str, where: str) -> float:
    if isinstance(given, str) and given.strip().endswith("%"):
        if value is None:
            raise InputError("a percentage of no value", where=where, value=given, remedy="State `value` too")
        return abs(value) * parse_quantity(given, "1", where)
    return parse_quantity(given, unit, where)


def _system(given: str, where: str) -> System:
    try:
        return System(given)
    except ValueError as error:
        known = ", ".join(System)
        raise InputError("unknown system", where=f"{where}.system", value=given, remedy=f"Known: {known}") from error


def setup_table(setup: Setup) -> dict[str, Any]:
    """The setup as `read_setup` reads it, exact in SI."""
    table: dict[str, Any] = {"system": str(setup.system)}
    for name, unit in SCALARS.items():
        value = getattr(setup, name)
        if value is None:
            continue
        unit = "rad" if unit == "deg" else unit
        entry = {"value": f"{value!r} {unit}"}
        if name in setup.uncertainty:
            entry["uncertainty"] = f"{setup.uncertainty[name]!r} {unit}"
        table[name] = entry
    return table


def write_toml(tables: Mapping[str, Any]) -> str:
    """One level of tables as TOML text."""
    scalars = [f"{k} = {_literal(v)}" for k, v in tables.items() if not isinstance(v, Mapping)]
    blocks = [
        f"[{k}]\n" + "\n".join(f"{n} = {_literal(v)}" for n, v in t.items())
        for k, t in tables.items()
        if isinstance(t, Mapping)
    ]
    return "\n".join(scalars) + "\n\n" + "\n\n".join(blocks) + "\n"


def _literal(value: Any) -> str:
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{k} = {_literal(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_literal(v) for v in value) + "]"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int | float):
        return repr(value)
    return '"' + str(value).replace("\\", "\\\\").replace('"', '\\"') + '"'
