"""The stand's limits as safety rules."""

from __future__ import annotations

from stand.config import Stand
from stand.safety import FlagRule, RangeRule, Rule, SpeedRule, StaleRule


def preparing_rules(stand: Stand) -> list[Rule]:
    """Those that hold from the first sample on, homing included: force and device flags."""
    flags: list[Rule] = [FlagRule("device flag", name) for name in stand.instruments]
    return [RangeRule("force", "force_gauge", *stand.limits.force, "N"), *flags]


def standing_rules(stand: Stand) -> list[Rule]:
    """Those that hold once the drive's coordinate is known: travel and speed."""
    limits = stand.limits
    return [
        RangeRule("travel", "drive", *limits.travel, "m"),
        SpeedRule("speed", "drive", limits.speed, stand.drive.rate),
    ]


def guide_rule(stand: Stand, rest: float) -> Rule:
    """The guide's range, once the dial gauge's reading at rest is known, m."""
    return RangeRule("guide range", "dial_gauge", *stand.limits.weight_position, "m", zero=rest)


def stale_rule(stand: Stand) -> StaleRule:
    """Every instrument's longest silence."""
    return StaleRule({name: instrument.stale for name, instrument in stand.instruments.items()})
