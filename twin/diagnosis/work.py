"""Who does a search's independent fits: this process, two at a time as they are asked for, or a Dask cluster, all at
once.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any, Protocol, Self, TypeVar

import twin.causes
from stand.errors import InputError, StandError
from twin.diagnosis.problem import Problem
from twin.diagnosis.shared import in_turn
from twin.kernels.jit import cache_folder

R = TypeVar("R")


class Work(Protocol):
    """Promises of function(problem, *job) for each job, in their order. What is never asked for may never be done."""

    def each(
        self, function: Callable[..., R], problem: Problem, jobs: Sequence[tuple[Any, ...]]
    ) -> list[Callable[[], R]]: ...


class Here:
    """In this process, when asked, two at a time."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *why: object) -> None:
        return None

    def each(
        self, function: Callable[..., R], problem: Problem, jobs: Sequence[tuple[Any, ...]]
    ) -> list[Callable[[], R]]:
        """Nothing is done before a promise is called, and no more than the job after it besides."""
        return in_turn([partial(_afresh, function, problem, job) for job in jobs])


class Dask:
    """On the workers of a Dask cluster; they need this package. address: of its scheduler, tcp://host:port.

    InputError where `distributed` is not installed or nothing answers there.
    """

    def __init__(self, address: str, timeout: float = 4.0) -> None:
        try:
            from distributed import Client
        except ImportError as error:
            remedy = "Install it: pip install 'fibre-stand[dask]'"
            raise InputError("distributed is not installed", where="--dask", value=address, remedy=remedy) from error
        try:
            self._client = Client(address, timeout=timeout, set_as_default=False)
        except (OSError, ValueError, TypeError) as error:
            remedy = "Start one: dask scheduler, and dask worker ADDRESS on each machine"
            raise InputError("no Dask scheduler answers", where="--dask", value=address, remedy=remedy) from error
        try:
            self._check(address)
        except BaseException:
            self._client.close()
            raise
        self._sent: dict[int, tuple[Problem, Any]] = {}

    def _check(self, address: str) -> None:
        """Whether there are workers, and all with this package as it is here."""
        try:
            theirs = set(self._client.run(_version).values())
        except Exception as error:  # whatever a worker without the package makes of it
            remedy = "Install the same version on every worker"
            raise InputError(
                "a Dask worker lacks this package", where="--dask", value=address, remedy=remedy
            ) from error
        if not theirs:
            remedy = f"Start one on each machine: dask worker {address}"
            raise InputError("the Dask cluster has no worker", where="--dask", value=address, remedy=remedy)
        if theirs != {_version()}:
            remedy = "Install the same version on every worker"
            raise InputError("a Dask worker has another version", where="--dask", value=address, remedy=remedy)

    def each(
        self, function: Callable[..., R], problem: Problem, jobs: Sequence[tuple[Any, ...]]
    ) -> list[Callable[[], R]]:
        """All jobs are sent at once; a promise waits for its own."""
        if id(problem) not in self._sent:
            there = self._client.scatter(problem, broadcast=True, hash=False)
            self._sent = dict(list(self._sent.items())[-3:]) | {id(problem): (problem, there)}
        self._sent[id(problem)] = kept = self._sent.pop(id(problem))  # the last used is dropped last
        return [_asked(self._client.submit(_afresh, function, kept[1], job, pure=False)) for job in jobs]

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *why: object) -> None:
        self._client.close()


def _afresh(function: Callable[..., R], problem: Problem, job: tuple[Any, ...]) -> R:
    """Do a job so that it does not hang on what was done before it, here or there."""
    problem.forget_states()
    return function(problem, *job)


def _asked(future: Any) -> Callable[[], Any]:
    def result() -> Any:
        try:
            return future.result()
        except Exception as error:
            remedy = "See the worker's log; without --dask the work is done here"
            what = f"a fit failed on the Dask cluster: {type(error).__name__}: {error}"
            raise StandError(what, where="--dask", remedy=remedy) from error

    return result


def _version() -> str:
    """What this process's kernels, causes and diagnosis say of themselves."""
    folders = Path(twin.causes.__file__).parent, Path(__file__).parent
    return cache_folder("composed").name + "".join(cache_folder("", folder).name for folder in folders)


__all__ = ["Dask", "Here", "Work"]
