"""A recording beside its models: scores, ceilings, and all that the page shows."""

from twin.compare.comparison import Comparison, ModelRun
from twin.compare.run import compare

__all__ = ["Comparison", "ModelRun", "compare"]
