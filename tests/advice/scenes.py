"""Random scenes: single strands that vary in length, radius, modulus, curl, friction, drive,
contact and wind; hairs, wires, soft rods, small grooms. The same seed gives the same scene."""
import math


def generator(seed):
    """Returns a function that draws numbers in [0, 1) by mulberry32, in 32-bit integers."""
    state = seed % 2**32

    def draw():
        nonlocal state
        state = (state + 0x6D2B79F5) % 2**32
        t = (state ^ state >> 15) * (1 | state) % 2**32
        t ^= (t + (t ^ t >> 7) * (61 | t)) % 2**32
        return (t ^ t >> 14) / 2**32

    return draw


# Young's modulus E (Pa), radius (m), density (kg/m^3) and length (m) of a kind are drawn between
# these, uniformly in their logarithms; tau (s) is internal friction over E I, drag in kg/(m s),
# curl the largest curvature (1/m). Measured hair has E/G = 4.4; isotropic materials have
# Poisson's ratio.
HAIR = {"E": (2.7e9, 5.3e9), "radius": (30e-6, 45e-6), "density": (1300, 1320), "shear": 4.4,
        "tau": (1e-3, 3e-3), "drag": (8e-5, 2e-4)}
KINDS = {
    "hair": {**HAIR, "weight": 5, "length": (0.05, 0.3), "curl": 150},
    "soft hair": {"weight": 2, "E": (1e7, 5e8), "radius": (35e-6, 60e-6), "density": (1300, 1320),
                  "length": (0.05, 0.25), "shear": 4.4, "tau": (1e-3, 2e-2), "drag": (2e-5, 2e-4), "curl": 150},
    "wire": {"weight": 2, "E": (5e10, 2.1e11), "radius": (5e-5, 3e-4), "density": (6450, 7850),
             "length": (0.1, 0.6), "poisson": 0.3, "tau": (1e-6, 1e-4), "drag": (1e-5, 2e-4), "curl": 20},
    "rod": {"weight": 2, "E": (3e5, 3e6), "radius": (1e-3, 5e-3), "density": (1070, 1200),
            "length": (0.1, 0.4), "poisson": 0.48, "tau": (1e-3, 2e-2), "drag": (1e-3, 1e-1), "curl": 30},
    "groom": {**HAIR, "weight": 1, "length": (0.05, 0.2), "curl": 80},
}


def number(x):
    return f"{x:.4g}"


class Draws:
    def __init__(self, seed):
        self.random = generator(seed * 7919 + 17)
        for _ in range(8):
            self.random()

    def between(self, bounds):
        """Draws uniformly in the logarithm."""
        low, high = bounds
        return low * math.exp(self.random() * math.log(high / low))

    def linear(self, low, high):
        return low + self.random() * (high - low)

    def pick(self, items):
        return items[math.floor(self.random() * len(items))]


def drive(draws, groom):
    """Returns the lines of [root]. Every seed draws the parameters of all drives."""
    drives = {
        "fixed": [],
        "shake": [f"direction = [{draws.pick(['1, 0, 0', '0, 1, 0', '1, 1, 0'])}]",
                  f"amplitude_m = {number(draws.linear(0.005, 0.03))}",
                  f"frequency_hz = {number(draws.linear(1, 3))}"],
        "swing": ["direction = [1, 0, 0]", f"amplitude_m = {number(draws.linear(0.02, 0.06))}",
                  f"frequency_hz = {number(draws.linear(0.5, 2))}"],
        "stop": ["direction = [0, 1, 0]", f"speed_m_s = {number(draws.linear(0.5, 2))}",
                 f"time_s = {number(draws.linear(0.01, 0.05))}"],
    }
    name = "fixed" if groom else draws.pick(list(drives))
    return ["[root]", f'motion = "{name}"', *drives[name]]


def curls(draws, kind, groom):
    if groom:
        return ['shape = "wavy"', f"wave_per_m = {number(draws.linear(5, kind['curl']))}",
                f"wavelength_m = {number(draws.linear(0.03, 0.08))}"]
    return ['shape = "helix"', f"curl_radius_m = {number(1 / draws.linear(10, kind['curl']))}",
            f"curl_pitch_m = {number(draws.linear(0.02, 0.1))}"]


def random_scene(seed):
    """Returns the name of the scene and its text."""
    draws = Draws(seed)
    name = draws.pick([name for name, kind in KINDS.items() for _ in range(kind["weight"])])
    kind, groom = KINDS[name], name == "groom"
    E, radius, length = (draws.between(kind[key]) for key in ("E", "radius", "length"))
    friction = draws.between(kind["tau"]) * E * (math.pi / 4) * radius**4
    down = draws.random() < 0.5
    lines = [
        f'title = "{name} {seed}"', f"duration_s = {number(draws.linear(0.5, 2))}",
        "[model]", 'id = "super_helix"',
        "[integrator]", 'id = "backward_euler"', "dt_s = 0.002",
        "[material]", 'name = "custom"', f"radius_m = {number(radius)}", f"youngs_modulus_pa = {number(E)}",
        f"shear_modulus_pa = {number(E / kind['shear'])}" if "shear" in kind
        else f"poisson_ratio = {kind['poisson']}",
        f"density_kg_m3 = {number(draws.between(kind['density']))}",
        f"internal_friction_kg_m3_s = {number(friction)}",
    ]
    lines += ["[groom]", f"count = {math.floor(draws.linear(5, 80))}"] if groom else ["[strand]"]
    lines += [f"length_m = {number(length)}", "elements = 20"]
    if not groom:
        lines.append(f"root_tangent = {'[0, 0, -1]' if down else '[1, 0, 0]'}")
    if draws.random() < 0.5:
        lines += curls(draws, kind, groom)
    lines += [*drive(draws, groom), "[effects.gravity]"]
    if draws.random() < 0.25:
        lines += ["[effects.wind]",
                  f"velocity_m_s = [{number(draws.linear(0.5, 3))}, {number(draws.linear(0, 1))}, 0]",
                  'profile = "sine"', f"frequency_hz = {number(draws.linear(0.5, 2))}", 'law = "quadratic"',
                  f"strand_radius_m = {number(radius)}"]
    lines += ["[effects.linear_drag]", f"drag_kg_m_s = {number(draws.between(kind['drag']))}"]
    if not groom and not down and draws.random() < 0.3:
        centre = ", ".join(number(part * length) for part in (0.5, 0.05, -0.35))
        lines += ["[effects.body]", 'shape = "sphere"', f"centre_m = [{centre}]",
                  f"radius_m = {number(0.3 * length)}", f"friction = {number(draws.linear(0, 0.4))}"]
    return name.replace(" ", "_"), "\n".join(lines) + "\n"
