"""From where the flights of a rare failure are drawn: nearer to the failures than the campaign's own distribution, and by how much.

All parameters that a campaign draws are one point z (d,) of a space in which its own distribution is standard normal: Φ(z) is the share
of a parameter's distribution that lies below its value. Flights are drawn from a mixture q of normal distributions

    q(z) = a N(0, 1) + b N(0, W² 1) + c N(m, C) + c N(m', C'),    2c = 1 − a − b,    C'⁻¹ = (C⁻¹ + 1)/2,    m' = C' C⁻¹ m/2

and each counts with the weight w = N(z; 0, 1)/q(z). The mean of w over flights that fail is the rate of failures without bias, whatever
m and C are, and whatever else chance does in a flight: seeds are drawn as in any campaign. Because of its first part no weight is above
1/a, so what lies where nobody looked for it is underrated no more than by a campaign of a times as many flights; the second part
reaches further out. The third is fitted to the failures. The fourth stands between it and the campaign's own: where chance decides
beside the parameters, the best density is that of the campaign times the square root of the probability to fail, which is this one.

Source: T. Hesterberg: Weighted average importance sampling and defensive mixture distributions, Technometrics 37(2), 1995;
R. Y. Rubinstein, D. P. Kroese: The cross-entropy method, 2004, 3.
"""

from typing import NamedTuple, Self

import numpy as np
from scipy.special import logsumexp, ndtri

from armland.rotations import Array

PLAIN, WIDE = 0.1, 0.1
"""Shares a and b of the mixture."""
WIDENED = 2.0
"""W: standard deviations of the wide part."""


class Part(NamedTuple):
    """One normal distribution of the mixture."""

    share: float
    mean: Array
    """(d,)."""
    root: Array
    """(d, d), lower triangular: the covariance is its square."""

    def density(self, z: Array) -> Array:
        """Logarithm (k,) of the density at the points `z` (k, d) over (2π)^(−d/2)."""
        within = np.linalg.solve(self.root, (z - self.mean).T)
        return -0.5 * (within**2).sum(axis=0) - np.log(np.diag(self.root)).sum()

    def half_way(self) -> Self:
        """What stands between it and the standard normal distribution: the geometric mean of both densities."""
        precision = np.linalg.inv(self.root @ self.root.T)
        covariance = np.linalg.inv(0.5 * (precision + np.eye(len(self.mean))))
        root = np.linalg.cholesky(0.5 * (covariance + covariance.T)).astype(float)
        return self._replace(mean=0.5 * covariance @ precision @ self.mean, root=root)


class Proposal(NamedTuple):
    """The mixture; its first part is the campaign's own distribution."""

    parts: tuple[Part, ...]

    def places(self, shares: Array) -> Array:
        """Points (k, d) for `shares` (k, d + 1), uniform in (0, 1): the first chooses the part, the others the place in it."""
        normal = ndtri(shares[:, 1:])
        ends = np.cumsum([p.share for p in self.parts])[:-1]
        chosen = np.searchsorted(ends, shares[:, 0], "right")
        drawn = np.stack([p.mean + normal @ p.root.T for p in self.parts])
        return drawn[chosen, np.arange(len(normal))]

    def density(self, z: Array) -> Array:
        """Logarithm (k,) of q at the points `z` (k, d) over (2π)^(−d/2)."""
        return logsumexp([np.log(p.share) + p.density(z) for p in self.parts], axis=0)

    def weights(self, z: Array) -> Array:
        """Weights w (k,) of the points `z` (k, d)."""
        return np.exp(self.parts[0].density(z) - self.density(z))


def nominal(d: int) -> Proposal:
    """Where the search begins: wide in all `d` directions, for nothing is known."""
    return Proposal(_known(d, 1.0 - PLAIN))


def fitted(z: Array, weights: Array, wide: float = WIDE) -> Proposal:
    """The mixture whose third part is nearest, by cross-entropy, to the campaign's distribution where it fails.

    That is the normal one with weighted mean and covariance of the points. Few points make a covariance too small, and flights outside
    of it would weigh too much; so d + 1 points of the campaign's own are taken to be among them.

    Args:
        z: points (k, d), k ≥ 1, at which flights fail.
        weights: (k,) of each.
        wide: share b.
    """
    d, share = z.shape[1], weights / weights.sum()
    mean = share @ z
    found, many = (share * (z - mean).T) @ (z - mean), effective(weights)
    root = np.linalg.cholesky((many * found + (d + 1) * np.eye(d)) / (many + d + 1))
    near = Part(0.5 * (1.0 - PLAIN - wide), mean, root)
    return Proposal((*_known(d, wide), near, near.half_way()))


def effective(weights: Array) -> float:
    """How many points of equal weight say as much as those with `weights` (k,) do, which are not all zero."""
    return float(weights.sum() ** 2 / (weights**2).sum())


def _known(d: int, wide: float) -> tuple[Part, Part]:
    return Part(PLAIN, np.zeros(d), np.eye(d)), Part(wide, np.zeros(d), WIDENED * np.eye(d))
