"""The shell of every report page: one file that opens offline, light and dark, on screen and on paper.

A page is made of HTML strings from `section`, `tiles`, `table`, `findings` and `figure`; colours are named by role
("measured", "model-1", ...) and follow the theme.
"""

from __future__ import annotations

import base64
import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from importlib import resources
from typing import Any

import numpy as np
from numpy.typing import NDArray

_HEAD = '<meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">'


@dataclass(frozen=True, slots=True)
class Cell:
    """A table's cell: html, as shown; kind: a CSS class ("text", "best", "good", "warn", "bad")."""

    html: str
    kind: str = ""


def document(title: str, subtitle: str, sections: Iterable[str], footer: str = "") -> str:
    """The whole page as HTML, plotly inlined once."""
    plotly = (resources.files("plotly") / "package_data" / "plotly.min.js").read_text(encoding="utf-8")
    own = resources.files("twin.report")
    css, js = (own / "page.css").read_text(encoding="utf-8"), (own / "page.js").read_text(encoding="utf-8")
    return (
        f'<!doctype html>\n<html lang="en" data-theme="light"><head>{_HEAD}<title>{escape(title)}</title>\n'
        f"<style>\n{css}</style></head>\n<body>\n"
        f'<header class="top"><div><h1>{escape(title)}</h1><p>{escape(subtitle)}</p></div>'
        f'<button class="theme" type="button" aria-label="Change between light and dark">Dark</button></header>\n'
        f"<main>\n{''.join(sections)}</main>\n<footer>{footer}</footer>\n"
        f"<script>{plotly}</script>\n<script>\n{js}</script>\n</body></html>\n"
    )


def section(heading: str, *parts: str) -> str:
    """A card with a heading."""
    return f"<section><h2>{escape(heading)}</h2>\n{''.join(parts)}</section>\n"


def paragraph(text: str, kind: str = "") -> str:
    """A paragraph of plain text; kind: "lead", "caption" or ""."""
    return f'<p class="{kind}">{escape(text)}</p>\n'


def findings(sentences: Iterable[str]) -> str:
    """Sentences as a list."""
    return '<ul class="findings">' + "".join(f"<li>{escape(s)}</li>" for s in sentences) + "</ul>\n"


def tiles(entries: Iterable[tuple[str, str, str, str]]) -> str:
    """Large numbers side by side: (name, value, note, kind), kind "good", "warn", "bad" or ""."""
    made = (
        f'<div class="tile"><div class="name">{escape(name)}</div><div class="value {kind}">{escape(value)}</div>'
        f'<div class="note">{escape(note)}</div></div>'
        for name, value, note, kind in entries
    )
    return f'<div class="tiles">{"".join(made)}</div>\n'


def swatch(role: str, text: str) -> Cell:
    """A cell that begins with a line in the colour of `role`."""
    return Cell(f'<span class="swatch" style="background:var(--{escape(role)})"></span>{escape(text)}')


def table(header: Sequence[str], rows: Iterable[Sequence[str | Cell]], caption: str = "", text: int = 1) -> str:
    """A table; cells are text (escaped) or `Cell`s; the first `text` columns are words, the others numbers."""
    kinds = ["text" if i < text else "" for i in range(len(header))]
    head = "".join(f'<th scope="col" class="{k}">{escape(h)}</th>' for h, k in zip(header, kinds, strict=True))
    body = "".join("<tr>" + "".join(map(_cell, row, kinds)) + "</tr>" for row in rows)
    words = f"<caption>{escape(caption)}</caption>" if caption else ""
    return f'<div class="scroll"><table>{words}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>\n'


def _cell(cell: str | Cell, kind: str) -> str:
    made = cell if isinstance(cell, Cell) else Cell(escape(cell))
    return f'<td class="{kind} {made.kind}">{made.html}</td>'


def details(summary: str, *parts: str) -> str:
    """Something folded away."""
    return f"<details><summary>{escape(summary)}</summary>{''.join(parts)}</details>\n"


def figure(data: Sequence[Mapping[str, Any]], layout: Mapping[str, Any], caption: str, height: int = 340) -> str:
    """A plotly figure. Traces may say "role" for their colour; numpy arrays become 4-byte floats in the page."""
    text = json.dumps({"data": list(data), "layout": dict(layout)}, default=_pack, allow_nan=False)
    text = text.replace("</", "<\\u002f")
    return (
        f'<figure class="chart"><div class="plot" style="height:{height}px"></div>'
        f"<figcaption>{escape(caption)}</figcaption>"
        f'<script type="application/json">{text}</script></figure>\n'
    )


def _pack(value: object) -> object:
    """What JSON can't say itself: numpy arrays as plotly's typed arrays, numpy numbers as numbers."""
    if isinstance(value, np.ndarray):
        return {"dtype": "f4", "bdata": base64.b64encode(value.astype("<f4").tobytes()).decode()}
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"{type(value).__name__} has no place in a figure")


def number(value: float | None, digits: int = 4, unit: str = "") -> str:
    """A number for reading: `digits` significant, a dash where undefined."""
    if value is None or not math.isfinite(value):
        return "–"
    text = f"{value:.{digits}g}"
    if "e" in text:
        mantissa, power = text.split("e")
        text = f"{mantissa}·10^{int(power)}"
    return f"{text.replace('-', '−')} {unit}".rstrip()


def thin(most: int, *columns: NDArray[np.float64]) -> tuple[NDArray[np.float64], ...]:
    """Columns with at most about `most` points: of each stretch its lowest and highest in the second column."""
    n = len(columns[0])
    if n <= most:
        return columns
    stretch = -(-2 * n // most)
    whole = columns[1][: n // stretch * stretch].reshape(-1, stretch)
    base = np.arange(len(whole)) * stretch
    keep = np.unique(np.concatenate((base + whole.argmin(1), base + whole.argmax(1), [0, n - 1])))
    return tuple(column[keep] for column in columns)
