"""Simulate an experiment on the nominal stand, or a recording's drive motion, with one model or several."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from api.cli._console import JsonOption, out, progress, quiet, table, write_json

if TYPE_CHECKING:
    from api.orders import Order
    from stand.recording import Recording

EXAMPLE = "stand simulate --situation 3c --model force --out simulated.h5"
Number = float | None
PUBLISHED = ("channel", "S1: constant b", "S1: b(v)", "here: constant b", "here: b(v)")
COLUMNS = ("model", "u from mm", "u to mm", "F from N", "F to N", "slack %", "seconds")


def command(
    recording: Annotated[
        Path | None, typer.Argument(metavar="[RUN.h5]", help="Take drive and setup from here.")
    ] = None,
    situation: Annotated[str | None, typer.Option(metavar="NAME", help="A preset of `stand situations`.")] = None,
    shape: Annotated[str | None, typer.Option(help="rectangular, trapezoidal or quasi-sinusoidal.")] = None,
    frequency: Annotated[Number, typer.Option(metavar="HZ", help="Cycles a second.")] = None,
    amplitude: Annotated[Number, typer.Option(metavar="M", help="Peak-to-peak stroke in m.")] = None,
    duration: Annotated[Number, typer.Option(metavar="S", help="Seconds of motion.")] = None,
    ramp: Annotated[Number, typer.Option(metavar="S", help="Of a trapezoid.")] = None,
    added_mass: Annotated[bool | None, typer.Option("--added-mass", help="With the added mass.")] = None,
    model: Annotated[
        list[str] | None, typer.Option(help="A model or an extended model's file; may repeat; all.")
    ] = None,
    save: Annotated[
        Path | None, typer.Option("--out", metavar="FILE.h5", help="Write the (first) result here.")
    ] = None,
    json: JsonOption = None,
) -> None:
    """Run the command."""
    from api.catalogue import model_names
    from api.simulations import ordered, save_simulated, simulate, summary
    from stand.recording import read_recording

    fields = {"shape": shape, "frequency": frequency, "amplitude": amplitude, "duration": duration, "ramp": ramp}
    fields |= {"situation": situation, "added_mass": added_mass}
    run = read_recording(recording) if recording else ordered(_order(fields))
    usual = ["force"] if situation is None else ["force", "force-damping"]
    models = list(model_names()) if model and "all" in model else model or usual
    rows: list[dict[str, Any]] = []
    with progress("simulating") as report:
        for k, name in enumerate(models):
            report(name, k / len(models))
            found, seconds = simulate(run, name)
            rows.append({"model": name, **summary(found), "seconds": seconds})
            if save is not None and k == 0:
                save_simulated(run, found, save)
    if not quiet(json):
        _show(run, rows)
    published = _published(situation)
    content = {"situation": situation, "models": rows, "published_R": published}
    if published is not None and recording is None:
        content |= _beside(run, models, published, not quiet(json))
    write_json(content, json)


def _order(fields: dict[str, Any]) -> Order:
    from api.orders import Order, checked

    return checked(Order, fields)


def _show(run: Recording, rows: list[dict[str, Any]]) -> None:
    cells = [
        [
            r["model"],
            *(1e3 * v for v in r["weight_position"]),
            *r["fibre_force"],
            100 * r["slack_fraction"],
            r["seconds"],
        ]
        for r in rows
    ]
    out.print(table(f"{run.name}: {run.time[-1]:.1f} s simulated", COLUMNS, cells, right=COLUMNS[1:]))


def _beside(run: Recording, models: list[str], published: dict[str, Any], say: bool) -> dict[str, Any]:
    """The comparison's tables for a situation, and S1's R beside those found here."""
    from api.beside import STAND_IN, judged, reasons, table_rows
    from api.cli._after import tell_models

    with progress("comparing") as report:
        comparison = judged(run, models, report)
    content, rows, why = comparison.to_json(), table_rows(published, comparison), reasons(comparison)
    if say:
        tell_models(content)
        out.print(table("R as S1's Table 3 has it, and here", PUBLISHED, rows, right=PUBLISHED[1:]))
        out.print("They may differ because:")
        for reason in why:
            out.print(f"- {reason}", soft_wrap=True)
    return {"comparison": content, "stand_in": STAND_IN, "table_3": rows, "reasons": why}


def _published(name: str | None) -> dict[str, Any] | None:
    from api.catalogue import describe_situations

    return next((s["published_R"] for s in describe_situations() if s["name"] == name), None)
