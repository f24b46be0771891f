"""What a command does with a recording once it is there: twin's notes stored, comparison, diagnosis, paths told."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from api.cli._console import out, progress, score_rows, table
from api.experiment import Experiment, State
from stand.errors import DeviceError, SafetyTrip

MODELS = (
    "model",
    "R(u)",
    "R(F)",
    "NRMSE u",
    "NRMSE F",
    "peak u mm",
    "peak F N",
    "window u µm",
    "window F N",
    "seconds",
)
SCORES = ("channel", "R", "R ceiling", "NRMSE", "lag ms", "gain", "peak error")


def check_end(experiment: Experiment, folder: Path) -> Path:
    """The recording of a run that went well; SafetyTrip or DeviceError naming the partial one otherwise."""
    path = folder / f"{experiment.run}.h5" if experiment.run else None
    remedy = f"What was recorded is in {path}" if path else "Nothing was recorded"
    if experiment.state in (State.TRIPPED, State.EMERGENCY):
        raise SafetyTrip(experiment.why, where="the stand was stopped", remedy=remedy)
    if path is None or experiment.state is State.FAILED:
        raise DeviceError(experiment.why or "the run failed", where="run", remedy=remedy)
    return path


def compare_and_tell(
    path: Path,
    models: list[str] | None = None,
    *,
    json: Path | None = None,
    page: Path | None = None,
    silent: bool = False,
) -> dict[str, Any]:
    """Compare a recording and print the scores and where everything is."""
    from api.afterwards import compare_run

    with progress("comparing") as report:
        done = compare_run(path, models or ["force"], report, json_file=json, page=page)
    if not silent:
        for run in done["comparison"]["baseline"]["runs"]:
            channels = {name: values for name, values in run.items() if isinstance(values, dict)}
            title = f"{run['file']}: model and measurement, {100 * run['slack_fraction']:.1f} % slack"
            out.print(table(title, SCORES, score_rows(channels), right=SCORES[1:]))
        tell_models(done["comparison"])
        out.print(f"comparison  {done['page']}\n            {done['json']}")
    return done


def tell_models(comparison: dict[str, Any]) -> None:
    """Print all models of a comparison (as JSON) side by side, and R's ceiling; nothing where there is but one."""
    models = comparison.get("models", [])
    if len(models) < 2:
        return
    rows: list[list[object]] = []
    for model in models:
        u, F = model.get("weight_position", {}), model.get("fibre_force", {})
        windows = (u.get("short_window_error"), F.get("short_window_error"))
        cost = model.get("cost_s")
        rows.append(
            [
                model["name"],
                u.get("R"),
                F.get("R"),
                u.get("nrmse"),
                F.get("nrmse"),
                _scaled(u.get("peak_error"), 1e3),
                F.get("peak_error"),
                _scaled(windows[0], 1e6),
                windows[1],
                cost,
            ]
        )
    best = [
        run[name].get("R_ceiling")
        for run in comparison["baseline"]["runs"]
        for name in ("weight_position", "fibre_force")
    ]
    rows.append(["R's ceiling", *best, *[None] * (len(MODELS) - 3)])
    out.print(table("Models side by side", MODELS, rows, right=MODELS[1:]))
    for failed in comparison.get("failed", []):
        out.print(f"{failed['model']} gave up: {failed['why']}")


def _scaled(value: float | None, factor: float) -> float | None:
    return None if value is None else factor * value


def diagnose_and_tell(
    paths: list[Path], *, json: Path | None = None, page: Path | None = None, silent: bool = False, **options: Any
) -> dict[str, Any]:
    """Diagnose recordings and print the verdict in words."""
    from api.afterwards import diagnose_runs

    with progress("diagnosing") as report:
        done = diagnose_runs(paths, report, json_file=json, page=page, **options)
    if not silent:
        _tell(done)
    return done


def _tell(done: dict[str, Any]) -> None:
    verdict = done["verdict"]
    for finding in verdict["findings"]:
        out.print(f"- {finding}")
    rows = [
        [
            c["name"],
            f"{100 * c['probability']:.0f} %",
            _sizes(c),
            ", ".join(c["indistinguishable_from"]) or None,
            c["strength"],
        ]
        for c in verdict["causes"]
    ]
    columns = ("cause", "probability", "size", "not to be told from", "strength")
    if rows:
        out.print(table("Causes", columns, rows, right=("probability", "strength")))
    elif verdict["unknown"]:
        out.print(f"[bold]Unknown effect[/bold], depends on {', '.join(verdict['unknown']['depends_on'])}")
    else:
        out.print("Nothing beyond calibration: the model explains the data.")
    ratio = (verdict.get("gain") or {}).get("prediction_error_ratio")
    if ratio is not None:
        out.print(f"Prediction error on data not fitted: {ratio:.2f} times the calibrated baseline's")
    paths = [path for path in (done["page"], done["json"]) if path]
    out.print("diagnosis   " + "\n            ".join(paths))


def _sizes(cause: dict[str, Any]) -> str:
    return ", ".join(f"{n} {p['value']:.4g} ± {p['std']:.2g} {p['units']}" for n, p in cause["parameters"].items())
