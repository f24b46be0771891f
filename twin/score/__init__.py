"""How near a simulated series comes to a measured one: R(p), psi, NRMSE, lag, gain, peaks (S0 eq. 1; S1 eqs. 2, 3)."""

from twin.score.channel import Score, pearson, psi, score
from twin.score.lag import best_lag

__all__ = ["Score", "best_lag", "pearson", "psi", "score"]
