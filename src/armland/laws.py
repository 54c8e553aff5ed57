"""The UAV's laws as pure functions of one sample, compiled; each law's page is in docs/laws.

| name | is |
|---|---|
| `UavParameters` | mass, kg; inertia (3, 3), kg·m²; lever (3,), m, centre of mass to pivot, body |
| `BacksteppingGains`, `ExactGains` | k1, k2 (6,), attitude first; k3 of both, or one for each |
| `Reference` | q_d, omega_d, omega_dot_d, r_d, v_d, a_d of a moving reference |
| `paper_law`, `lyapunov` | (29), and (26) with its rate (30) |
| `exact_law`, `exact_lyapunov` | (X.1): true lever arm, moving reference; and its V₂ with the rate |
"""

from armland.control.laws.backstepping import lyapunov, paper_law
from armland.control.laws.exact import Reference, exact_law, exact_lyapunov
from armland.control.laws.rigid_body import BacksteppingGains, ExactGains, UavParameters

__all__ = [
    "BacksteppingGains",
    "ExactGains",
    "Reference",
    "UavParameters",
    "exact_law",
    "exact_lyapunov",
    "lyapunov",
    "paper_law",
]
