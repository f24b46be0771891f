"""The one who runs the stand: one experiment or preparation step at a time, and the work after each run."""

from __future__ import annotations

import asyncio
import json
import threading
import uuid
from collections.abc import Callable, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from api.catalogue import model_names
from api.devices import problems, resting, running
from api.experiment import Experiment, State
from api.follow import Follower
from api.hub import Hub
from api.jobs import Job, Jobs
from api.live import Stream
from api.orders import Order, checked, make_plan
from api.problem import Conflict, NotFound
from api.runs import Runs
from api.steps import do_step
from api.twins import Beside, make_twin, store

if TYPE_CHECKING:
    from stand.config import Stand
    from stand.runs import Health, RunHandle

#: the devices are asked for their status at this interval while someone watches and nothing runs, s
STATUS_EVERY = 10.0
#: how long a look at the devices is waited for, s
PATIENCE = 15.0


class Operator:
    """Owns the stand for as long as the server lives; every method may be called from any thread.

    title: how the screens call the stand. mount(mass): tells a simulated stand its added mass before a run.
    diagnose: whether each run is diagnosed after its end.
    """

    def __init__(
        self,
        stand: Stand,
        folder: Path,
        *,
        title: str = "",
        mount: Callable[[float], None] | None = None,
        diagnose: bool = True,
    ) -> None:
        self.stand, self.title, self._mount, self._diagnose = stand, title or stand.name, mount, diagnose
        self.hub, self.runs = Hub(), Runs(folder)
        self.jobs = Jobs(self._job_changed)
        self._busy = threading.Lock()
        self._experiments: dict[str, Experiment] = {}
        self._handle: RunHandle | None = None
        self._thread: threading.Thread | None = None
        self._status: dict[str, Any] = {}
        self._closing = threading.Event()
        self._tripped = ""
        self._model_state = "compiling"

    def open(self, loop: asyncio.AbstractEventLoop) -> None:
        """Begin: the live stream runs on `loop`; the devices are asked how they are."""
        self.hub.bind(loop)
        self._tell_stand("connecting", resting(self.stand, "unknown"))
        threading.Thread(target=self._look_now_and_then, name="status", daemon=True).start()
        threading.Thread(target=self._warm, name="warm", daemon=True).start()

    def close(self) -> None:
        """Stop what runs, in good order, and end the jobs."""
        self._closing.set()
        if self._handle is not None and self._thread is not None and self._thread.is_alive():
            self._handle.stop("the server ends")
            self._thread.join(20.0)
        self.jobs.close()

    def experiments(self) -> list[Experiment]:
        """All since the start, newest first."""
        return list(reversed(self._experiments.values()))

    def experiment(self, identity: str) -> Experiment:
        """The experiment of that id; NotFound."""
        if identity not in self._experiments:
            raise NotFound("no such experiment", where="experiments", value=identity)
        return self._experiments[identity]

    def start(self, order: Order, campaign: Sequence[Path] = ()) -> Experiment:
        """Start an experiment; InputError where the order can't be run, Conflict while the stand is busy.

        campaign: recordings that the diagnosis after the run takes in as well.
        """
        from stand.runs import PHASES, RunOrder, start

        excitation, setup = order.excitation(), order.setup(self.stand)
        plan = make_plan(excitation, self.stand)
        model = self._model(order.model)
        self._take()
        try:
            self._refuse_after_trip()
            if self._mount is not None:
                self._mount(setup.added_mass)
            run = RunOrder(excitation=excitation, setup=setup, folder=self.runs.folder, comment=order.comment)
            self._handle = start(self.stand, run)
        except BaseException:
            self._busy.release()
            raise
        created = datetime.now(UTC).isoformat(timespec="seconds")
        given = order.model_dump(exclude_none=True)
        experiment = Experiment(uuid.uuid4().hex[:12], given, order.model, created, PHASES, float(plan.duration))
        self.hub.clear_past()
        self._changed(experiment)
        self.jobs.hold(True)
        given_on = (experiment, self._handle, Beside(lambda: make_twin(model, setup)), tuple(campaign))
        self._thread = threading.Thread(target=self._follow, args=given_on, daemon=True)
        self._thread.start()
        return experiment

    def next_experiment(self, name: str) -> Experiment:
        """Start what the diagnosis of the run `name` proposes; the campaign is diagnosed with it."""
        verdict = json.loads(self.runs.file(name, "diagnosis").read_text())
        proposal = verdict.get("next_experiment")
        if not proposal:
            raise NotFound("the diagnosis proposes no further experiment", where=name)
        known = [self.runs.folder / Path(run["file"]).name for run in verdict["baseline"]["runs"]]
        order = checked(Order, {**proposal["excitation"], "comment": proposal["why"][:200]})
        return self.start(order, [path for path in known if path.is_file()])

    def stop(self, identity: str) -> Experiment:
        """End an experiment in good order; Conflict where it has ended."""
        experiment = self.experiment(identity)
        if not experiment.active or self._handle is None:
            raise Conflict("the experiment has ended", where=identity, value=str(experiment.state))
        self._handle.stop()
        return experiment

    def emergency_stop(self) -> dict[str, Any]:
        """Quick stop now, whether something runs or not: {"stopped": the drive has answered, "message"}."""
        from stand.runs import emergency_stop

        running = self._handle is not None and self._handle.poll() is None
        stopped = self._handle.emergency_stop() if running and self._handle else emergency_stop(self.stand)
        message = "The drive has taken the quick stop" if stopped else "The drive did not answer: use the hardware stop"
        return {"stopped": stopped, "message": message}

    def prepare(self, step: str, distance: float = 0.0) -> dict[str, Any]:
        """Do a preparation step and wait for its end: {"message", "result"}."""
        self._take()
        try:
            if step != "reset":
                self._refuse_after_trip()
            done = do_step(self.stand, step, distance)
            if step == "reset":
                self._tripped = ""
        finally:
            self._busy.release()
        self._look()
        return done

    def status(self) -> dict[str, Any]:
        """The stand as last told to the screens."""
        return self._status

    def list_runs(self) -> list[dict[str, Any]]:
        """All runs but the one being recorded."""
        return self.runs.list()

    def _take(self) -> None:
        """Have the stand for oneself; a look at the devices is waited for, an experiment is not."""
        runs = any(experiment.active for experiment in self._experiments.values())
        if runs or not self._busy.acquire(timeout=PATIENCE):
            raise Conflict("the stand is busy", where="stand", remedy="Wait for the experiment to end, or stop it")

    def _model(self, name: str) -> str:
        """A fibre model's name as it is; a run's name stands for the extended model that its diagnosis found."""
        return name if name in model_names() else str(self.runs.file(name, "model"))

    def _refuse_after_trip(self) -> None:
        if self._tripped:
            remedy = "See to the cause, then reset the stand: nothing resumes by itself"
            raise Conflict("the stand was stopped and stays stopped", where="stand", value=self._tripped, remedy=remedy)

    def _follow(self, experiment: Experiment, handle: RunHandle, beside: Beside, campaign: Sequence[Path]) -> None:
        """From the first event to the work after the run; in a thread of its own."""
        stream = Stream(self.hub, experiment.id)
        follower = Follower(experiment, beside, changed=self._changed, sampled=stream.sampled, health=self._health)
        try:
            last = follower.follow(handle.events())
            if last.state in (State.TRIPPED, State.EMERGENCY):
                self._tripped = last.why
                self._tell_stand("tripped", resting(self.stand, "unknown"), self._tripped)
        except Exception as error:
            handle.stop(f"the server failed: {error}")
            last = follower.experiment.now(state=State.FAILED, why=f"{type(error).__name__}: {error}")
            self._changed(last)
        finally:
            self._busy.release()
            self.jobs.hold(False)
        self._afterwards(last, beside, campaign)

    def _afterwards(self, last: Experiment, beside: Beside, campaign: Sequence[Path]) -> None:
        closed = self.runs.path(last.run) if last.run is not None and last.state is not State.FAILED else None
        if closed is not None:
            try:
                store(closed, beside)
            except Exception as error:  # the run itself is complete: it gets its comparison all the same
                self._changed(last.now(note=f"what the twin said is not in the recording: {error}"))
        self.hub.publish_state("runs", {"newest": last.run})
        if closed is not None:
            self.jobs.submit("compare", [closed])
            if self._diagnose or campaign:
                self.jobs.submit("diagnose", [*campaign, closed])
        self._look()

    def _changed(self, experiment: Experiment) -> None:
        self._experiments[experiment.id] = experiment
        self.hub.publish_state("experiment", experiment.view())

    def _health(self, health: Health) -> None:
        self._tell_stand("moving", running(self.stand, health))

    def _job_changed(self, job: Job) -> None:
        self.hub.publish_state(f"job {job.id}", {"type": "job", **job.view()})

    def _warm(self) -> None:
        """Have the first model compiled before a run wants it."""
        try:
            make_twin("force", self.stand.setup)
            self._model_state = "ready"
        except Exception as error:
            self._model_state = f"none: {error}"
        self._status = self._status | {"model": self._model_state}
        self.hub.publish_state("stand", self._status)

    def _tell_stand(self, state: str, devices: list[dict[str, Any]], message: str = "") -> None:
        if state == "ready" and not message and self._model_state == "compiling":
            message = "the model is being compiled, once: a run that ends before shows its simulation afterwards"
        told = {"name": self.title, "state": state, "message": message, "model": self._model_state}
        self._status = {**told, "devices": devices}
        self.hub.publish_state("stand", self._status)

    def _look_now_and_then(self) -> None:
        self._look()
        while not self._closing.wait(STATUS_EVERY):
            if len(self.hub):
                self._look()

    def _look(self) -> None:
        """Ask the devices, unless something else has the stand."""
        if not self._busy.acquire(blocking=False):
            return
        try:
            found = do_step(self.stand, "status")["result"]
            missing = problems(found)
            state = "tripped" if self._tripped else "disconnected" if missing else "ready"
            self._tell_stand(state, resting(self.stand, "ok", found), self._tripped or missing)
        except Exception as error:
            self._tell_stand("disconnected", resting(self.stand, "disconnected"), str(error))
        finally:
            self._busy.release()
