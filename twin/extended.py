"""The extended model as a file."""

from __future__ import annotations

from twin.diagnosis.fit import Fitted


def to_toml(fitted: Fitted) -> str:
    """[model], [setup] with calibrated values and [causes.<name>] with parameters, SI."""
    model, z = fitted.model, fitted.z
    lines = ["[model]", 'base = "force"', f'system = "{model.setups[0].system}"', "", "[setup]"]
    for c in model.coordinates:
        if c.owner == "base":
            lines.append(f"{c.name} = {c.value(float(z[model.index['base', c.name]])):.9g}")
    for cause in model.causes:
        lines += ["", f"[causes.{cause.name}]"]
        lines += [f"{name} = {value:.9g}" for name, value in model.values(z, cause).items()]
    return "\n".join(lines) + "\n"
