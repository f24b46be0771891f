"""`python -m api.worker KIND FILES...`: one job in a process of its own, telling its progress as JSON lines."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from api.cli._errors import exit_code, tell
from api.priority import stand_back


def main(arguments: list[str]) -> int:
    """Do one job; the last line on stdout holds its result, an error goes to stderr in one line."""
    stand_back()
    kind, files = arguments[0], [Path(name) for name in arguments[1:]]
    try:
        result = _work(kind, files)
    except Exception as error:
        tell(error)
        return exit_code(error)
    _say(result={"json": result["json"], "page": result["page"]})
    return 0


def _work(kind: str, files: list[Path]) -> dict[str, Any]:
    from api.afterwards import compare_run, diagnose_runs

    if kind == "compare":
        return compare_run(files[0], ("force",), _progress)
    return diagnose_runs(files, _progress)


def _progress(what: str, fraction: float | None = None) -> None:
    _say(what=what, fraction=fraction)


def _say(**content: Any) -> None:
    print(json.dumps(content), flush=True)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
