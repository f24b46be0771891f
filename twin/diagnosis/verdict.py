"""The verdict: what verdict.md asks for, as data, JSON and files."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from twin.diagnosis.found import Evidence


@dataclass(frozen=True)
class Verdict:
    """data: the JSON of verdict.md. model: the extended model as TOML, or "" where there is nothing to add.

    evidence: what the report page draws (see `Evidence`); None in a verdict read back from its file.
    """

    data: Mapping[str, Any]
    model: str = ""
    evidence: Evidence | None = field(default=None, repr=False, compare=False)

    @property
    def causes(self) -> tuple[str, ...]:
        """Names of the causes found, most probable first."""
        return tuple(c["name"] for c in self.data["causes"])

    def to_json(self) -> dict[str, Any]:
        """verdict.md's keys; null where undefined, never NaN."""
        clean = plain(self.data)
        assert isinstance(clean, dict)
        return clean

    def write(self, json_path: Path, page_path: Path | None = None) -> Verdict:
        """Write the JSON, the extended model (NAME.model.toml beside it) and the page; the verdict as written."""
        stem = json_path.name.removesuffix(".json").removesuffix(".diagnosis")
        data = dict(self.data)
        data["model"] = None
        if self.model:
            data["model"] = f"{stem}.model.toml"
            json_path.with_name(data["model"]).write_text(self.model)
        written = replace(self, data=data)
        json_path.write_text(json.dumps(written.to_json(), indent=1) + "\n")
        if page_path is not None:
            from twin.report.diagnosis import diagnosis_page  # a page is rarely asked for; plotly is slow to import

            diagnosis_page(written, page_path)
        return written


def plain(value: Any) -> Any:
    """Numbers, texts, lists and dicts as JSON knows them; None for what is not finite."""
    if isinstance(value, Mapping):
        return {str(k): plain(v) for k, v in value.items()}
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    if isinstance(value, list | tuple):
        return [plain(v) for v in value]
    if isinstance(value, bool) or value is None or isinstance(value, str | int):
        return value
    number = float(value)
    return number if math.isfinite(number) else None
