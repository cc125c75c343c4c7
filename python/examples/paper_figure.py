"""paper_figure.py [figure.pdf]: shapes of a strand that falls, and its energies."""

import sys
from pathlib import Path

import matplotlib
import tress

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

scene = tress.Scene.read(Path(__file__).parents[2] / "scenes" / "cantilever.toml")
frames = scene.changed({"duration_s": 0.2, "strand.elements": 10}).run()
figure, (left, right) = pyplot.subplots(1, 2, figsize=(7, 2.5), layout="constrained")
for t, x in zip(frames.times, 100 * frames.positions):
    left.plot(x[:, 0], x[:, 2], color=pyplot.cm.viridis(t / frames.times[-1]))
left.set(xlabel="x (cm)", ylabel="z (cm)", aspect="equal")
for name in ("kinetic_j", "elastic_j", "gravity_j"):
    right.plot(frames.times, 1e6 * frames.series[name], label=name.removesuffix("_j"))
right.set(xlabel="t (s)", ylabel="energy (µJ)")
right.legend(frameon=False)
out = sys.argv[1] if len(sys.argv) > 1 else "figure.pdf"
figure.savefig(out)
print("wrote", out)
