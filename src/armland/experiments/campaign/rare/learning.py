"""Cross-entropy in stages: where to draw from next, by what all flights so far have shown.

Each flight has a score: how near it came to the failure, at or above 0 if it failed. While few have failed, those that came nearest
show the way: the next stage is drawn near the best tenth of the last one. When flights that failed weigh as much as `ENOUGH` equal
ones, or after `MOST` stages, learning ends. Flights of all stages count for where to go, each weighed by the mean density of all
stages; none of them counts for the rate, for which other flights are made.

Source: P.-T. de Boer, D. P. Kroese, S. Mannor, R. Y. Rubinstein: A tutorial on the cross-entropy method, Annals of Operations Research
134, 2005; weights of several stages: E. Veach, L. Guibas: Optimally combining sampling techniques, 1995 (balance heuristic).
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.special import logsumexp

from armland.experiments.campaign.rare.proposal import WIDE as WIDE_LAST
from armland.experiments.campaign.rare.proposal import Proposal, effective, fitted, nominal
from armland.rotations import Array

BEST = 0.1
"""Share of a stage that shows the way."""
ENOUGH = 20.0
FEW = 10
"""Failures that are worth more than those flights that came near."""
MOST = 20
"""Stages of learning."""
WIDE = 0.3
"""Share of the wide part while it is learnt."""


class Stage(NamedTuple):
    """Flights that were drawn from the same mixture."""

    proposal: Proposal
    z: Array
    """(k, d), see `proposal`."""
    score: Array
    """(k,): 0 and above failed; −∞ where nothing says how near it came."""

    @property
    def failed(self) -> int:
        """How many failed."""
        return int((self.score >= 0.0).sum())

    @property
    def level(self) -> float:
        """Score of the best tenth's last."""
        return float(np.sort(self.score)[-max(int(BEST * len(self.score)), 1)])


class Next(NamedTuple):
    """Where to draw from next."""

    proposal: Proposal
    learnt: bool
    """Whether the next flights count for the rate."""


def following(stages: Sequence[Stage], d: int) -> Next:
    """What follows the `stages`, all of the same number of flights, in a space of `d` directions."""
    if not stages:
        return Next(nominal(d), False)
    z = np.vstack([s.z for s in stages])
    score = np.concatenate([s.score for s in stages])
    mean_density = logsumexp([s.proposal.density(z) for s in stages], axis=0) - np.log(len(stages))
    weights = np.exp(-0.5 * (z**2).sum(axis=1) - mean_density)
    failed = score >= 0.0
    learnt = len(stages) >= MOST or (failed.sum() >= FEW and effective(weights[failed]) >= ENOUGH)
    if failed.sum() < FEW:
        failed = (score >= min(stages[-1].level, 0.0)) & np.isfinite(score)
    if not failed.any():
        return Next(nominal(d), learnt)
    return Next(fitted(z[failed], weights[failed], WIDE_LAST if learnt else WIDE), learnt)
