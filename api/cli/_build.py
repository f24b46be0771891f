"""Build the typer application: the one command that is asked for, the others by their summary alone."""

from __future__ import annotations

import ast
import importlib
import pkgutil
from collections.abc import Sequence
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Annotated

import typer

_HERE = Path(__file__).parent


@cache
def names() -> dict[str, str]:
    """Command name -> module name, found in the folder; a trailing underscore avoids a keyword (`import_`)."""
    found = (module.name for module in pkgutil.iter_modules([str(_HERE)]) if not module.name.startswith("_"))
    return {name.rstrip("_"): name for name in sorted(found)}


def build(arguments: Sequence[str]) -> typer.Typer:
    """The application for this command line; only the named command's module is imported."""
    app = typer.Typer(
        name="stand",
        help="Measure, simulate and explain weight-fibre test stands.",
        epilog="Start with `stand demo`, then `stand serve --simulated`. `stand COMMAND --help` shows an example.",
        no_args_is_help=True,
        pretty_exceptions_enable=False,
        rich_markup_mode=None,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback()(_options)
    wanted = next((argument for argument in arguments if not argument.startswith("-")), None)
    for name in names():
        _add(app, name, whole=name == wanted)
    return app


def _add(app: typer.Typer, name: str, *, whole: bool) -> None:
    if not whole:
        app.command(name, short_help=summary(name))(_elsewhere)
        return
    module = importlib.import_module(f"api.cli.{names()[name]}")
    app.command(name, help=module.__doc__, epilog=f"\b\nExample:\n  {module.EXAMPLE}")(module.command)


def summary(name: str) -> str:
    """The first line of the command's module docstring, read without importing it."""
    text = ast.get_docstring(ast.parse((_HERE / f"{names()[name]}.py").read_text())) or ""
    return text.partition("\n")[0]


def _elsewhere() -> None:
    raise AssertionError("a command is loaded by its name before it runs")


def _show_version(asked: bool) -> None:
    if asked:
        print(f"stand {version('fibre-stand')}")
        raise typer.Exit


def _options(
    _version: Annotated[
        bool, typer.Option("--version", help="Print the version and leave.", callback=_show_version, is_eager=True)
    ] = False,
) -> None:
    pass
