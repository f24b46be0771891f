"""Safety: rules that see every block first, and a quick stop on a connection of its own. Not a safety function."""

from stand.safety.quickstop import QuickStop
from stand.safety.rules import FlagRule, RangeRule, Rule, SpeedRule, StaleRule
from stand.safety.supervisor import Supervisor
from stand.safety.trip import Trip

__all__ = ["FlagRule", "QuickStop", "RangeRule", "Rule", "SpeedRule", "StaleRule", "Supervisor", "Trip"]
