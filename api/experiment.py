"""One experiment as the screens see it: a record that is replaced, never changed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any


class State(StrEnum):
    """How an experiment stands; the last five are ends."""

    STARTING = "starting"
    RUNNING = "running"
    STOPPING = "stopping"
    FINISHED = "finished"
    STOPPED = "stopped"
    TRIPPED = "tripped"
    EMERGENCY = "emergency-stopped"
    FAILED = "failed"


ACTIVE = frozenset({State.STARTING, State.RUNNING, State.STOPPING})


@dataclass(frozen=True)
class Experiment:
    """order: as given. phases: all names in order; phase: the one that it is in. seconds: planned, with rests.

    elapsed: s of the recording so far. run: the recording's name once it is closed. why: of a trip or a failure.
    latency: sample to published, {"p50", "p99"} s. dropped: live blocks that the tap let fall. note: what went
    wrong beside the run, which goes on. passed: the phases so far.
    """

    id: str
    order: dict[str, Any]
    model: str
    created: str
    phases: Sequence[str]
    seconds: float
    state: State = State.STARTING
    phase: str = ""
    elapsed: float = 0.0
    streaming: bool = False
    run: str | None = None
    why: str = ""
    latency: dict[str, float] | None = None
    dropped: int = 0
    note: str = ""
    passed: tuple[str, ...] = ()

    @property
    def active(self) -> bool:
        """Whether it is still going on."""
        return self.state in ACTIVE

    def now(self, **changes: Any) -> Experiment:
        """The same experiment, some moments later."""
        return replace(self, **changes)

    def view(self) -> dict[str, Any]:
        """As JSON."""
        progress = 1.0 if not self.active else min(self.elapsed / self.seconds, 1.0) if self.seconds else 0.0
        return {
            "id": self.id,
            "state": str(self.state),
            "phase": self.phase,
            "phases": self._phases(),
            "progress": round(progress, 4),
            "elapsed": round(self.elapsed, 3),
            "seconds": round(self.seconds, 3),
            "streaming": self.streaming and self.active,
            "model": self.model,
            "order": self.order,
            "created": self.created,
            "run": self.run,
            "why": self.why,
            "latency": self.latency,
            "dropped": self.dropped,
            "note": self.note,
            "links": {"self": f"/experiments/{self.id}", **({"run": f"/runs/{self.run}"} if self.run else {})},
        }

    def _phases(self) -> list[dict[str, str]]:
        """Past, now, ahead; a phase that a stop left out was never there."""
        at = self.phases.index(self.phase) if self.phase in self.phases else -1
        if self.state is State.FINISHED:
            at = len(self.phases)
        if not self.active and at >= 0:
            at += 1
        seen = {*self.passed, self.phase} if self.state is not State.FINISHED else set(self.phases)
        states = [
            "now" if k == at else "ahead" if k > at else "past" if name in seen else "skipped"
            for k, name in enumerate(self.phases)
        ]
        return [{"name": name, "state": state} for name, state in zip(self.phases, states, strict=True)]
