"""Follow one run: its events become the experiment's record, its samples go through the twin to whoever watches."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from api.blocks import joined
from api.experiment import Experiment, State
from api.latency import Latency
from stand.clock import LiveBlock
from stand.runs import Failed, Finished, Health, Outcome, Phase, Progress, Trip

if TYPE_CHECKING:
    from api.twins import Beside
    from stand.runs import Event
    from twin.live import LiveScore

#: the record is published this often while only time goes on, s
EVERY = 0.25
#: samples that are served at once, 20 ms; and where the newest came more than LATE s ago, to catch up
GATHER, GATHER_MORE = 40, 200
LATE = 0.06
#: how a run's outcome reads; an emergency stop is a trip by the operator
ENDS = {Outcome.FINISHED: State.FINISHED, Outcome.STOPPED: State.STOPPED, Outcome.TRIPPED: State.TRIPPED}


class Follower:
    """Reads a run's events to their end in the calling thread.

    changed(experiment): the record changed. sampled(block, score, latency): samples came; latency s from the
    block's oldest sample to now. health(health): once a second. now: CLOCK_MONOTONIC, s.
    """

    def __init__(
        self,
        experiment: Experiment,
        beside: Beside | None,
        *,
        changed: Callable[[Experiment], None],
        sampled: Callable[[LiveBlock, LiveScore | None, float], None],
        health: Callable[[Health], None] = lambda health: None,
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        self.experiment, self._beside, self.latency = experiment, beside, Latency()
        self._changed, self._sampled, self._health, self._now = changed, sampled, health, now
        self._end = State.FAILED
        self._waiting: list[LiveBlock] = []

    def tell(self, **changes: Any) -> None:
        """Replace the record and say so."""
        self.experiment = self.experiment.now(**changes)
        self._changed(self.experiment)

    def follow(self, events: Iterable[Event]) -> Experiment:
        """Follow until the last event and return the last record."""
        actions: dict[type, Callable[[Any], None]] = {
            LiveBlock: self._block,
            Phase: self._phase,
            Progress: self._progress,
            Health: self._health,
            Trip: self._trip,
            Finished: self._finished,
            Failed: self._failed,
        }
        for event in events:
            actions[type(event)](event)
        return self.experiment

    def _phase(self, event: Phase) -> None:
        self._serve_waiting()  # after a phase nothing may come for long
        state = State.RUNNING if self.experiment.state is State.STARTING else self.experiment.state
        self.tell(phase=event.name, state=state, passed=(*self.experiment.passed, event.name))

    def _progress(self, event: Progress) -> None:
        self.tell(elapsed=event.elapsed, dropped=event.dropped, latency=self.latency.quantiles())

    def _finished(self, event: Finished) -> None:
        self._serve_waiting()
        state = ENDS[event.outcome]
        if event.trip is not None and event.trip.rule == "operator":
            state = State.EMERGENCY
        run = event.path.stem if event.path else None
        self.tell(state=state, why=event.why, run=run, latency=self.latency.quantiles())

    def _trip(self, event: Trip) -> None:
        self._end = State.EMERGENCY if event.rule == "operator" else State.TRIPPED
        self.tell(why=str(event))

    def _failed(self, event: Failed) -> None:
        """Nothing more will come; where a trip came before, that is what counts."""
        why = f"{self.experiment.why}; then {event}" if self._end is not State.FAILED else str(event)
        self.tell(state=self._end, why=why, run=event.path.stem if event.path else None)

    def _block(self, block: LiveBlock) -> None:
        """Gather short blocks: a twin and a screen are served as well by fifty a second."""
        self._waiting.append(block)
        enough = GATHER_MORE if self._now() - block.newest_arrival > LATE else GATHER
        if sum(len(waiting.time) for waiting in self._waiting) >= enough:
            self._serve_waiting()

    def _serve_waiting(self) -> None:
        if self._waiting:
            self._serve(joined(self._waiting))
            self._waiting.clear()

    def _serve(self, block: LiveBlock) -> None:
        score = self._beside.push(block) if self._beside is not None else None
        span = float(block.time[-1] - block.time[0])
        self._sampled(block, score, self.latency.add(self._now() - block.newest_arrival + span))
        elapsed = float(block.time[-1])
        if self._beside is not None and self._beside.note != self.experiment.note:
            self.tell(note=self._beside.note)
        if not self.experiment.streaming or elapsed - self.experiment.elapsed > EVERY:
            self.tell(streaming=True, elapsed=elapsed, latency=self.latency.quantiles())
