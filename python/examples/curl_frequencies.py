"""Lowest frequencies of a curl by sparse shift and invert: M, K of DER and super-helices."""

import numpy as np
import scipy.sparse.linalg
import tress

for model in ("der", "super_helix"):
    strand = tress.model(
        model, elements=40, natural_curvature_per_m=100, natural_twist_per_m=30, gravity_m_s2=0
    )
    q, _ = strand.initial_state()
    mass, stiffness = strand.mass(0, q), strand.stiffness(0, q)
    squares = scipy.sparse.linalg.eigsh(
        (stiffness + stiffness.T) / 2, k=6, M=(mass + mass.T) / 2, sigma=0,
        return_eigenvectors=False,
    )  # fmt: skip
    print(model, "Hz:", np.round(np.sqrt(np.sort(squares)) / (2 * np.pi), 4))
