"""What the tests share."""

import subprocess
from pathlib import Path

import tress

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "scenes"
BUILD = ROOT / "build" / "release"

# The curl of reference.cpp: 10 cm, radius 40 um, curvature 100/m, twist 30/m, no weight.
CURL = dict(
    length_m=0.1, radius_m=40e-6, poisson_ratio=0.5, natural_curvature_per_m=100,
    natural_twist_per_m=30, root_tangent="x", gravity_m_s2=0,
)  # fmt: skip


def curl(model="super_helix", elements=20, **options):
    return tress.model(model, elements=elements, **CURL, **options)


def reference(*words):
    """What C++ says: the numbers that python_reference prints."""
    program = BUILD / "python" / "python_reference"
    done = subprocess.run(
        [program, *map(str, words)], check=True, capture_output=True, text=True
    )
    return [float(line) for line in done.stdout.split()]


def random_state(system, rng, size=0.01):
    """Off the initial state by a part of the typical sizes."""
    q, v = system.initial_state()
    q_typ, v_typ = system.scale()
    return q + size * q_typ * rng.standard_normal(system.n), (
        v + size * v_typ * rng.standard_normal(system.n)
    )
