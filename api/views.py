"""What the interface answers with, for its OpenAPI document: field by field, with examples."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel, ConfigDict, Field


class PhaseView(BaseModel):
    """One phase of a run."""

    name: str = Field(examples=["motion"])
    state: str = Field(examples=["now"], description="past, now, ahead; skipped where a stop left it out")


class LatencyView(BaseModel):
    """From a block's oldest sample to its publication, s."""

    p50: float = Field(examples=[0.031])
    p99: float = Field(examples=[0.058])
    max: float = Field(examples=[0.074])
    blocks: int = Field(examples=[412])


class ExperimentView(BaseModel):
    """One experiment."""

    id: str = Field(examples=["3f0c9a1b22d4"])
    state: str = Field(
        examples=["running"],
        description="starting, running, stopping; finished, stopped, tripped, emergency-stopped, failed",
    )
    phase: str = Field(examples=["motion"])
    phases: list[PhaseView]
    progress: float = Field(examples=[0.42], description="0 to 1")
    elapsed: float = Field(examples=[4.1], description="s recorded")
    seconds: float = Field(examples=[10.0], description="s planned, with the rests")
    streaming: bool = Field(description="samples are coming")
    model: str = Field(examples=["force"])
    order: dict[str, Any] = Field(examples=[{"situation": "2"}])
    created: str = Field(examples=["2026-11-21T10:15:00+00:00"])
    run: str | None = Field(examples=["20261121T101500.123Z_trapezoidal_1.25Hz"], description="the recording's name")
    why: str = Field(examples=[""], description="of a trip, a stop or a failure, in words")
    latency: LatencyView | None
    dropped: int = Field(examples=[0], description="live blocks that the tap let fall")
    note: str = Field(examples=[""], description="what went wrong beside the run, which goes on")
    links: dict[str, str] = Field(examples=[{"self": "/experiments/3f0c9a1b22d4"}])


class DeviceView(BaseModel):
    """One instrument; more fields while a run reads it: rate Hz, age s, samples, skipped, flagged."""

    model_config = ConfigDict(extra="allow")

    name: str = Field(examples=["force_gauge"])
    title: str = Field(examples=["Force gauge"])
    state: str = Field(examples=["ok"], description="ok, stale, lost, unknown, disconnected")
    detail: str = Field(examples=["serial /dev/ttyUSB0, 230400 baud"])
    latency: float = Field(examples=[0.0005], description="of the link, as calibrated, s")
    fields: dict[str, str] = Field(examples=[{"force": "15.21 N"}])


class StandView(BaseModel):
    """The stand as last asked."""

    name: str = Field(examples=["nominal"])
    state: str = Field(examples=["ready"], description="connecting, ready, moving, tripped, disconnected")
    message: str = Field(examples=[""], description="why it is tripped or disconnected")
    model: str = Field(
        default="compiling", examples=["ready"], description="of the live twin: compiling, ready, or why there is none"
    )
    devices: list[DeviceView]


class StepView(BaseModel):
    """A preparation step that was done."""

    step: str = Field(examples=["rest-check"])
    message: str = Field(examples=["At rest 15.21 N, the setup gives 15.19 ± 8.00 N: as it should be"])
    result: dict[str, Any] = Field(examples=[{"force": 15.21, "expected": 15.19, "tolerance": 8.0, "ok": True}])


class StopView(BaseModel):
    """What the emergency stop came to."""

    stopped: bool = Field(description="the drive has answered")
    message: str = Field(examples=["The drive has taken the quick stop"])


class JobView(BaseModel):
    """Work on recordings in a process of its own."""

    id: str = Field(examples=["9d8e7c6b5a41"])
    kind: str = Field(examples=["compare"])
    files: list[str] = Field(examples=[["runs/20261121T101500.123Z_trapezoidal_1.25Hz.h5"]])
    options: list[str] = []
    state: str = Field(examples=["running"], description="queued, running, done, failed")
    what: str = Field(examples=["simulating"])
    fraction: float | None = Field(examples=[0.4])
    created: str = Field(examples=["2026-11-21T10:15:20+00:00"])
    seconds: float | None = Field(examples=[None])
    result: dict[str, Any] = {}
    error: str = ""


class DiagnosisView(JobView):
    """A diagnosis: its job, and the verdict once it is done."""

    verdict: dict[str, Any] | None = Field(examples=[None])


class RunView(BaseModel):
    """One recording and what lies beside it; more fields where it can be read."""

    model_config = ConfigDict(extra="allow")

    name: str = Field(examples=["20261121T101500.123Z_trapezoidal_1.25Hz"])
    written: str = Field(examples=["2026-11-21T10:15:12+00:00"])
    bytes: int = Field(examples=[1481224])
    readable: bool
    scores: dict[str, Any] | None = Field(examples=[{"weight_position": {"R": 0.9993}, "fibre_force": {"R": 0.84}}])
    verdict: dict[str, Any] | None = Field(
        examples=[{"causes": ["guide-viscous-drag"], "unknown": False, "next": None}],
        description="the diagnosis in short; `next`: why to run the proposed next experiment",
    )
    links: dict[str, str] = Field(examples=[{"file": "/runs/20261121T101500.123Z_trapezoidal_1.25Hz/file"}])
