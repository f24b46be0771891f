"""Plug-ins are found by looking in their folder: one public instance of the kind's dataclass in each file."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterator
from types import ModuleType
from typing import TypeVar

from stand.errors import InputError

P = TypeVar("P")


def names(package: ModuleType) -> tuple[str, ...]:
    """The plug-ins in `package`, by their files' names with hyphens for underscores; none is imported."""
    return tuple(
        sorted(m.name.replace("_", "-") for m in pkgutil.iter_modules(package.__path__) if not m.name.startswith("_"))
    )


def load(package: ModuleType, name: str, kind: type[P]) -> P:
    """The plug-in `name` of `package`; InputError listing the known ones where there is none of that name."""
    if name not in names(package):
        known = ", ".join(names(package))
        what = f"no {kind.__name__} of that name"
        raise InputError(what, where=package.__name__, value=name, remedy=f"Known: {known}")
    module = importlib.import_module(f"{package.__name__}.{name.replace('-', '_')}")
    found = [value for key, value in vars(module).items() if isinstance(value, kind) and not key.startswith("_")]
    if len(found) != 1:
        raise TypeError(f"{module.__name__} must hold one public {kind.__name__}, it holds {len(found)}")
    return found[0]


def every(package: ModuleType, kind: type[P]) -> Iterator[P]:
    """All plug-ins of `package`, loaded one by one."""
    for name in names(package):
        yield load(package, name, kind)
