"""Places that results go to, checked before any work is done for them."""

from __future__ import annotations

import os
from pathlib import Path

from stand.errors import InputError


def check_target(path: Path, where: str = "") -> Path:
    """A file that can be written at `path`; InputError where its folder is missing or closed, or a folder is there."""
    if path.is_dir():
        raise InputError("is a folder", where=where or str(path), value=str(path), remedy="Name a file in it")
    folder = path.parent
    if not folder.is_dir():
        raise InputError("no such folder", where=where or str(path), value=str(folder), remedy="Make it first")
    _check_rights(folder, where or str(path))
    return path


def make_folder(folder: Path, where: str = "--out") -> Path:
    """The folder, made where it is missing; InputError where that can't be, or nothing can be written there."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        remedy = "Name a folder that can be made"
        raise InputError(f"can't be made ({error.strerror})", where=where, value=str(folder), remedy=remedy) from error
    _check_rights(folder, where)
    return folder


def _check_rights(folder: Path, where: str) -> None:
    if not os.access(folder, os.W_OK | os.X_OK):
        remedy = "Name another folder, or change its rights"
        raise InputError("nothing can be written there", where=where, value=str(folder), remedy=remedy)
