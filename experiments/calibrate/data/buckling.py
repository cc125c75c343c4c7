"""Makes buckling_0.toml and its record: a rod that a gripper buckles.

PYTHONPATH=build/release/python /usr/bin/python3 experiments/calibrate/data/buckling.py

The setting is that of the example fit_buckling of dismech-newton (R. Chaiyakul, 2026,
https://github.com/ryanchaiyakul/dismech-newton): rod, motion, errors and first guess. What
differs is said in README.md of this folder.
"""

from pathlib import Path

import numpy as np
import tress
from scipy.ndimage import gaussian_filter1d
from scipy.signal import savgol_filter

FOLDER = Path(__file__).parent
LENGTH, SEGMENTS = 0.5, 24  # m
BENDING, STRETCHING, FRICTION = 10.0, 1e6, 0.3  # N m^2, N, N m^2 s
STRONG = 4  # bending stiffness in the other plane, over BENDING
MASS_PER_LENGTH = 100 * np.pi * 0.01**2  # kg/m: a tenth of water, radius 1 cm
COMPRESS, SHEAR = (0.04, 3.0), (0.03, 3.0)  # m, s
DURATION, FRAMES_PER_S, STEPS_PER_S = 8, 30, 240
POSE_ERROR = np.array([2e-4] * 3 + [np.radians(0.6)])  # of the gripper; m, rad
POSE_TIME, POSE_RAMP = 0.15, 0.2  # s: it changes in, it begins in
POINT_NOISE, FORCE_NOISE = 5e-4, 0.25  # m, N
READOUT_NOISE = np.array([5e-4] * 3 + [np.radians(0.2)])
SMOOTHED = 11  # frames
LOAD_CELL = 1e7  # N/m: spring that holds each of the last two nodes
# What the gripper's error adds to the force: as the residuals of a first fit of all frames (N).
FORCE_ERROR = 80.0
BUCKLED = 0.5  # s: records begin. Before, an error of 0.1 mm of the gripper is 200 N.
POINTS = (4, 8, 12, 16, 20)
GUESS = {"bending": 0.25, "stretching": 0.3, "friction": 3}  # over the truth


def section(bending, stretching):
    """Material of an ellipse of half-axes 2 b and b with these stiffnesses."""
    b = np.sqrt(STRONG * bending / stretching)
    area = 2 * np.pi * b**2
    torsion = 8 * np.pi * b**4 / 5  # m^4: twisting is as stiff as bending
    return {"name": "custom", "radius_m": float(np.sqrt(2) * b), "ellipticity": 2.0,
            "youngs_modulus_pa": float(stretching / area),
            "shear_modulus_pa": float(bending / torsion),
            "density_kg_m3": float(MASS_PER_LENGTH / area)}  # fmt: skip


def material(guess=None):
    part = guess or dict.fromkeys(GUESS, 1)
    return {**section(part["bending"] * BENDING, part["stretching"] * STRETCHING),
            "internal_friction_kg_m3_s": part["friction"] * FRICTION}  # fmt: skip


def smooth(t, start, time):
    s = np.clip((t - start) / time, 0, 1)
    return s * s * (3 - 2 * s)


def poses(seed):
    """(frames, 4): the gripper's x, y, z (m) and angle (rad), as it moves."""
    t = np.arange(DURATION * STEPS_PER_S + 1) / STEPS_PER_S
    margin = 4 * int(POSE_TIME * STEPS_PER_S)
    noise = np.random.default_rng(seed).standard_normal((t.size + 2 * margin, 4))
    error = gaussian_filter1d(noise, POSE_TIME * STEPS_PER_S, axis=0)[margin:-margin]
    all_poses = error / error.std(axis=0) * POSE_ERROR * smooth(t, 0, POSE_RAMP)[:, None]
    all_poses[:, 0] += COMPRESS[0] * smooth(t, 0, COMPRESS[1])
    all_poses[:, 2] += SHEAR[0] * smooth(t, COMPRESS[1], SHEAR[1])
    return all_poses[:: STEPS_PER_S // FRAMES_PER_S]


def readout(true, seed):
    """The recorded poses, smoothed in time."""
    noise = np.random.default_rng(1000 + seed).standard_normal(true.shape)
    smoothed = savgol_filter(true + noise * READOUT_NOISE, SMOOTHED, 3, axis=0)
    smoothed[0] = 0  # it starts from its mark
    return smoothed


def scene(title, gripper, of_material):
    rows = [[round(k / FRAMES_PER_S, 6), *(round(float(x), 7) for x in row)]
            for k, row in enumerate(gripper)]  # fmt: skip
    held = [{"at": 1 - k / SEGMENTS, "stiffness_n_m": LOAD_CELL,
             "target_m": [LENGTH * (1 - k / SEGMENTS), 0.0, 0.0]} for k in (0, 1)]  # fmt: skip
    return tress.Scene(
        {
            "title": title,
            "duration_s": float(DURATION),
            "frames_per_s": float(FRAMES_PER_S),
            "model": {"id": "der"},
            "integrator": {"id": "tr_bdf2", "dt_s": 1 / STEPS_PER_S},
            "material": of_material,
            "strand": {"length_m": LENGTH, "elements": SEGMENTS, "normal": [0.0, 1.0, 0.0]},
            "root": {"motion": "keyframes", "axis": [0.0, 1.0, 0.0], "keyframes": rows},
            "effects": {"gravity": {}, "tether": held},
            "gradient": {"by": ["youngs_modulus_pa", "radius_m", "internal_friction_kg_m3_s"]},
        }
    )


def record(positions, seed):
    """Points with noise, and the force on the load cell as its travel."""
    random = np.random.default_rng(100 + seed)
    travel = FORCE_NOISE / LOAD_CELL / np.sqrt(2)  # both springs together
    rows = ["time_s,point,x_m,y_m,z_m,sigma_m"]
    for k, frame in enumerate(positions[1:], 1):
        for point in POINTS:
            x = frame[point] + POINT_NOISE * random.standard_normal(3)
            rows.append(f"{k / FRAMES_PER_S:.6f},{point}," + ",".join(f"{one:.5f}" for one in x)
                        + f",{POINT_NOISE:g}")  # fmt: skip
        for point in (SEGMENTS - 1, SEGMENTS):
            x = frame[point, 0] + travel * random.standard_normal()
            rows.append(f"{k / FRAMES_PER_S:.6f},{point},{x:.10f},,,"
                        f"{FORCE_ERROR / LOAD_CELL / np.sqrt(2):.3g}")  # fmt: skip
    kept = [row for row in rows[1:] if float(row.split(",")[0]) >= BUCKLED]
    return "\n".join([rows[0], *kept]) + "\n"


def main():
    seed = 0
    title = f"a rod buckles in a gripper, trial {seed}"
    true = poses(seed)
    frames = scene(title, true, material()).run()
    (FOLDER / f"buckling_{seed}.csv").write_text(record(frames.positions, seed))
    fitted = scene(title, readout(true, seed), material(GUESS))
    (FOLDER / f"buckling_{seed}.toml").write_text(fitted.text())


main()
