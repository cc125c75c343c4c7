"""Words of the statements about families of hairs and rods."""
from .words import counted, duration

# Names of the properties of a hair, and the units of their thresholds.
PARAMETERS = {
    "gravito_bending": ("the gravito-bending number Γ", ""),
    "winding_rad": ("the winding of the natural shape", "rad"),
    "damping_time_s": ("the damping time", "s"),
    "drag_kg_m_s": ("the air-drag coefficient", "kg/(m s)"),
    "ellipticity": ("the ellipticity of the section", ""),
    "length_m": ("the length", "m"),
    "radius_m": ("the radius", "m"),
    "youngs_modulus_pa": ("Young's modulus", "Pa"),
    "drive_level": ("the strength of the drive", ""),
    "frequency_hz": ("the frequency of the drive", "Hz"),
    "natural_curvature_per_m": ("the natural curvature", "1/m"),
}

# The statements as pages print them; the tables have them without marks of code.
_TWIST = "without twist, the tip moves by"
_SWEEPS = "the error of `xpbd_bdf2` is at most 1.2 times that of `xpbd`, with steps of"
STATEMENTS = {
    "exact_step_100ms": "`backward_euler` with the exact Jacobian is stable at every step tried up to 100 ms",
    "exact_step_100ms_bend": '`backward_euler` without twist (`modes = "bend"`) is stable at every step tried up to 100 ms',
    "super_helix_step_longer": "`super_helix` is stable at steps at least as long as `der`",
    "twist_straight_negligible": f"{_TWIST} less than 1 % of the length, for the hair straightened at rest",
    "twist_curly_matters": f"{_TWIST} more than 1 % of the length, for the hair with its own curls",
    **{f"bdf_order2_at_{error}": f"BDF needs no more evaluations with order 2 than with order 5, for a tip error of {error}"
       for error in ("1e-2", "1e-3", "1e-4")},
    "esdirk_steps_at_1e-3": "ESDIRK takes no more steps than BDF of any order, for a tip error of 1e-3",
    "esdirk_work_at_1e-3": "ESDIRK needs no more evaluations than BDF of any order, for a tip error of 1e-3",
    "reduced_cheaper": "`super_helix` needs less time than `der` for a tip error of 1 %",
    **{f"sweep_order2_at_{rate}x{sweeps}": f"{_SWEEPS} {duration(1 / rate)} and {counted(sweeps, 'sweep')}"
       for rate, sweeps in ((300, 4), (300, 20), (1500, 4), (1000, 1))},
}
