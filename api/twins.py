"""The model that runs beside an experiment."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from stand.setup import Setup


def make_twin(name: str, setup: Setup) -> Any:
    """A live twin of the model `name` (of `stand models`, or an extended model's file), compiled and ready."""
    from twin.live import LiveTwin

    from api.catalogue import find_model

    model, parameters, setup = find_model(name, setup)
    model.warm()
    return LiveTwin(setup, model, parameters)


def store(path: Path, twin: Any) -> None:
    """Keep what the twin used and said in the recording, `/entry/live`."""
    from twin.live import store_live

    if twin is not None:
        store_live(path, twin)
