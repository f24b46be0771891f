"""Who does a search's independent fits: this process, one when it is asked for, or a Dask cluster, all at once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol, Self, TypeVar

from stand.errors import InputError
from twin.diagnosis.problem import Problem

R = TypeVar("R")


class Work(Protocol):
    """Promises of function(problem, *job) for each job, in their order. What is never asked for may never be done."""

    def each(
        self, function: Callable[..., R], problem: Problem, jobs: Sequence[tuple[Any, ...]]
    ) -> list[Callable[[], R]]: ...


class Here:
    """In this process, when asked."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *why: object) -> None:
        return None

    def each(
        self, function: Callable[..., R], problem: Problem, jobs: Sequence[tuple[Any, ...]]
    ) -> list[Callable[[], R]]:
        """Nothing is done before a promise is called."""
        return [_later(function, problem, job) for job in jobs]


class Dask:
    """On the workers of a Dask cluster; they need this package. address: of its scheduler, tcp://host:port.

    InputError where `distributed` is not installed or nothing answers there.
    """

    def __init__(self, address: str, timeout: float = 10.0) -> None:
        try:
            from distributed import Client
        except ImportError as error:
            remedy = "Install it: pip install 'fibre-stand[dask]'"
            raise InputError("distributed is not installed", where="--dask", value=address, remedy=remedy) from error
        try:
            self._client = Client(address, timeout=timeout, set_as_default=False)
            ready = len(self._client.scheduler_info(n_workers=-1)["workers"])
        except (OSError, ValueError, TypeError) as error:
            remedy = "Start one: dask scheduler, and dask worker ADDRESS on each machine"
            raise InputError("no Dask scheduler answers", where="--dask", value=address, remedy=remedy) from error
        if not ready:
            self._client.close()
            remedy = f"Start one on each machine: dask worker {address}"
            raise InputError("the Dask cluster has no worker", where="--dask", value=address, remedy=remedy)
        self._sent: dict[int, tuple[Problem, Any]] = {}

    def each(
        self, function: Callable[..., R], problem: Problem, jobs: Sequence[tuple[Any, ...]]
    ) -> list[Callable[[], R]]:
        """All jobs are sent at once; a promise waits for its own."""
        if id(problem) not in self._sent:
            there = self._client.scatter(problem, broadcast=True, hash=False)
            self._sent = {id(problem): (problem, there)} | dict(list(self._sent.items())[-3:])
        there = self._sent[id(problem)][1]
        return [self._client.submit(function, there, *job, pure=False).result for job in jobs]

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *why: object) -> None:
        self._client.close()


def _later(function: Callable[..., R], problem: Problem, job: tuple[Any, ...]) -> Callable[[], R]:
    return lambda: function(problem, *job)


__all__ = ["Dask", "Here", "Work"]
