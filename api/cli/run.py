"""Run one experiment: move the drive, record, follow with the twin, compare."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from api.cli._console import JsonOption, write_json
from api.cli._stand import (
    HideOption,
    SeedOption,
    SimulatedOption,
    StandOption,
    check_ports,
    configured,
    serve_arguments,
)

if TYPE_CHECKING:
    from api.orders import Order

EXAMPLE = "stand run --shape trapezoidal --frequency 1.25 --amplitude 0.03 --ramp 0.2 --duration 10 --simulated"
Number = float | None


def command(
    shape: Annotated[str | None, typer.Option(help="rectangular, trapezoidal or quasi-sinusoidal.")] = None,
    frequency: Annotated[Number, typer.Option(metavar="HZ", help="Cycles a second.")] = None,
    amplitude: Annotated[Number, typer.Option(metavar="M", help="Peak-to-peak stroke in m.")] = None,
    duration: Annotated[
        Number, typer.Option(metavar="S", help="Seconds of motion; 1 s of rest before and after.")
    ] = None,
    ramp: Annotated[Number, typer.Option(metavar="S", help="From one level to the other, trapezoid only.")] = None,
    added_mass: Annotated[bool | None, typer.Option("--added-mass", help="The added mass is on the weight.")] = None,
    situation: Annotated[str | None, typer.Option(metavar="NAME", help="A preset of `stand situations`.")] = None,
    model: Annotated[str, typer.Option(help="The model that runs beside.")] = "force",
    comment: Annotated[str, typer.Option(help="A note in the recording.")] = "",
    out: Annotated[Path | None, typer.Option(metavar="DIR", help="Where the recording goes.")] = None,
    stand: StandOption = None,
    simulated: SimulatedOption = False,
    hide: HideOption = None,
    seed: SeedOption = None,
    json: JsonOption = None,
) -> None:
    """Run the command."""
    from api.orders import Order, checked

    fields = {"shape": shape, "frequency": frequency, "amplitude": amplitude, "duration": duration, "ramp": ramp}
    order = checked(
        Order, {**fields, "added_mass": added_mass, "situation": situation, "comment": comment, "model": model}
    )
    on = serve_arguments(hide, seed, added_mass=bool(order.mass()))
    with configured(stand, simulated=simulated, arguments=on) as (rig, _):
        check_ports(rig, stand)
        write_json(execute(order, rig, out), json)


def execute(order: Order, rig: Any, folder: Path | None, *, title: str = "") -> dict[str, Any]:
    """Run an order on a stand and compare; returns {"recording", "comparison", ...}."""
    from api.cli._after import check_end, compare_and_tell
    from api.cli._console import out
    from api.cli._watch import run_and_watch
    from api.orders import make_plan
    from api.twins import store
    from stand.runs import RunOrder
    from stand.targets import make_folder

    excitation, setup = order.excitation(), order.setup(rig)
    plan = make_plan(excitation, rig)
    folder = make_folder(folder or rig.storage.folder)
    wanted = RunOrder(excitation=excitation, setup=setup, folder=folder, comment=order.comment)
    name = title or f"{excitation.shape} {excitation.frequency:g} Hz {1e3 * excitation.amplitude:g} mm"
    last, beside = run_and_watch(rig, wanted, model=order.model, seconds=float(plan.duration), title=name)
    path = check_end(last, folder)
    store(path, beside)
    out.print(f"recording   {path}")
    done = compare_and_tell(path)
    return {"recording": str(path), "experiment": last.view(), **done}
