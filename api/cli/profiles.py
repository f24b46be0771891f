"""List the instrument profiles that a stand's configuration may name."""

from __future__ import annotations

from api.cli._console import JsonOption, out, quiet, table, write_json

EXAMPLE = "stand profiles"


def command(json: JsonOption = None) -> None:
    """Run the command."""
    from api.catalogue import describe_profiles

    found = describe_profiles()
    if not quiet(json):
        rows = [[p["name"], p["kind"], p["vendor"], p["verified"], p["source"]] for p in found]
        out.print(table("Instrument profiles", ("name", "kind", "vendor", "verified against", "source"), rows))
    write_json(found, json)
