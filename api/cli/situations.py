"""List the tested situations of the papers with the published R."""

from __future__ import annotations

from typing import Any

from api.cli._console import JsonOption, out, quiet, table, write_json

EXAMPLE = "stand situations --json -"
COLUMNS = ("name", "shape", "Hz", "stroke mm", "ramp s", "cycles", "added kg")


def command(json: JsonOption = None) -> None:
    """Run the command."""
    from api.catalogue import describe_situations

    found = describe_situations()
    if not quiet(json):
        out.print(
            table(
                "Situations of the papers; the stroke and ramp are assumed",
                COLUMNS,
                [_row(s) for s in found],
                right=COLUMNS[2:],
            )
        )
    write_json(found, json)


def _row(preset: dict[str, Any]) -> list[object]:
    ramp, added = preset["ramp"] or None, preset["added_mass"] or None
    return [
        preset["name"],
        preset["shape"],
        preset["frequency"],
        1e3 * preset["amplitude"],
        ramp,
        preset["cycles"],
        added,
    ]
