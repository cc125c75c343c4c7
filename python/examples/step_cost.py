"""step_cost.py SCENE COUNT: seconds of a step of a scene, the least of five runs."""

import sys
import time

import tress

scene = tress.Scene.read(sys.argv[1])
count = int(sys.argv[2])
least = float("inf")
for _ in range(5):
    run = scene.start()
    begin = time.perf_counter()
    for k in range(1, count + 1):
        run.advance(k * scene.step)
    least = min(least, time.perf_counter() - begin)
print(least / count)
