"""use_wheel.py SCENE.toml: imports the installed module, runs a scene and checks that it moves."""

import sys

import tress

frames = tress.Scene.read(sys.argv[1]).run()
assert frames.positions[-1, -1, 2] < frames.positions[0, -1, 2], "the tip did not sink"
assert tress.__version__ in tress.version_text()
assert "site-packages" in tress.__file__, tress.__file__
print(tress.version_text())
