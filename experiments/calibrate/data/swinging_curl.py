"""Makes swinging_curl.csv: the tip of a finer model of another kind, with noise.

PYTHONPATH=build/release/python /usr/bin/python3 experiments/calibrate/data/swinging_curl.py
"""

from pathlib import Path

import numpy as np
import tress

FOLDER = Path(__file__).parent
NOISE = 5e-4  # m
TRUTH = {
    "material.youngs_modulus_pa": 3e9,
    "material.internal_friction_kg_m3_s": 1e-10,
    "effects.linear_drag.drag_kg_m_s": 5e-5,
}
FINER = {"model.id": "der", "strand.elements": 80, "integrator.dt_s": 5e-4, "frames_per_s": 50}

scene = tress.Scene.read(FOLDER / "swinging_curl.toml").changed({**TRUTH, **FINER})
frames = scene.run()
tips = frames.positions[1:, -1]
tips = tips + NOISE * np.random.default_rng(1).standard_normal(tips.shape)
rows = ["time_s,x_m,y_m,z_m,sigma_m"]
for t, (x, y, z) in zip(frames.times[1:], tips):
    rows.append(f"{t:.6g},{x:.6f},{y:.6f},{z:.6f},{NOISE:g}")
(FOLDER / "swinging_curl.csv").write_text("\n".join(rows) + "\n")
