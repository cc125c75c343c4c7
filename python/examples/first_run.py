"""first_run.py: the tip of a hair that swings, with more and more elements."""

import tress

scene = tress.Scene.parse(tress.scene_defaults())  # or tress.Scene.read("my.toml")
for elements in (5, 10, 20):
    frames = scene.changed({"strand.elements": elements}).run()
    x, _, z = frames.positions[-1, -1]  # last frame, last point: the tip (m)
    print(f"{elements} elements: x = {x:.4f} m, z = {z:.4f} m at {frames.times[-1]:g} s")
