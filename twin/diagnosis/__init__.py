"""The diagnosis: what the simulation gets wrong, why, and what is gained."""

from twin.diagnosis.engine import Options, diagnose
from twin.diagnosis.verdict import Verdict

__all__ = ["Options", "Verdict", "diagnose"]
