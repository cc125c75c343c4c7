import tempfile
import unittest
from pathlib import Path

import numpy as np
import tress
from test_gradients import curl

BY = ["youngs_modulus_pa", "internal_friction_kg_m3_s", "linear_drag.drag_kg_m_s"]


def record(scene, noise=0.0):
    """The tip at its frames, as columns."""
    frames = scene.run()
    tips = frames.positions[1:, -1]
    tips = tips + noise * np.random.default_rng(1).standard_normal(tips.shape)
    return dict(zip(["time_s", "x_m", "y_m", "z_m"], [frames.times[1:], *tips.T]))


class Fits(unittest.TestCase):
    def start(self):
        return curl({"duration_s": 0.2, "effects.linear_drag.drag_kg_m_s": 5e-5,
                     "material.youngs_modulus_pa": 4e9})  # fmt: skip

    def truth(self):
        return curl({"duration_s": 0.2})

    def test_finds_the_values_of_a_run(self):
        scene = self.truth().changed({"material.youngs_modulus_pa": 3e9})
        seen = []
        found = tress.fit(
            self.start(), record(scene), BY, progress=lambda n, rms: seen.append((n, rms))
        )
        # The run of World and that of the derivatives agree to the last bits.
        np.testing.assert_allclose(found.values, [3e9, 1e-10, 1e-4], rtol=1e-5)
        self.assertEqual([n for n, _ in seen], list(range(1, found.evaluations + 1)))
        self.assertLess(found.rms, 1e-9)
        self.assertEqual(found.names, BY)
        self.assertEqual(found.units[0], "Pa")
        self.assertEqual(found[BY[0]][0], found.values[0])
        np.testing.assert_allclose(found.fitted[0], found.measured[0], atol=1e-8)
        self.assertEqual(found.singular_values.shape, (3,))

    def test_of_a_file_with_noise_bounds_and_priors(self):
        columns = record(self.truth(), 3e-4)
        columns["sigma_m"] = np.full(columns["time_s"].size, 3e-4)
        columns["y_m"][2] = np.nan  # not measured
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "tip.csv"
            lines = [",".join(columns)] + [
                ",".join("" if np.isnan(x) else repr(float(x)) for x in row)
                for row in zip(*columns.values())
            ]
            file.write_text("\n".join(lines) + "\n")
            found = tress.fit(self.start(), file, BY[2], priors={BY[2]: (1e-4, 1e-6)})
            same = tress.fit(self.start(), columns, BY[2], priors={BY[2]: (1e-4, 1e-6)})
        np.testing.assert_array_equal(found.values, same.values)
        self.assertEqual(found.measured[0].size, 3 * columns["time_s"].size - 1)
        self.assertAlmostEqual(found.values[0], 1e-4, delta=2e-6)
        self.assertTrue(found.low[0] < found.values[0] < found.high[0])
        held = tress.fit(self.start(), columns, BY[2], bounds={BY[2]: (1e-5, 6e-5)})
        self.assertEqual(held.statuses, ["at_bound"])
        self.assertAlmostEqual(held.values[0], 6e-5, delta=1e-12)

    def test_names_what_is_not_determined(self):
        scene = self.truth()
        found = tress.fit(scene, record(scene, 1e-4), [*BY, "density_kg_m3"], shifts=False)
        self.assertIn("motion depends on their ratios alone", found.undetermined)
        self.assertEqual(found.status, "not_identified")
        self.assertTrue(np.isnan(found.low).all())

    def test_refusals(self):
        scene = self.truth()
        columns = record(scene)
        with self.assertRaisesRegex(tress.InputError, "does not say what to fit"):
            tress.fit(scene, columns)
        with self.assertRaisesRegex(tress.InputError, "equal lengths"):
            tress.fit(scene, {**columns, "x_m": columns["x_m"][1:]}, BY)
        with self.assertRaisesRegex(tress.InputError, "unknown column 'w_m'"):
            tress.fit(scene, {**columns, "w_m": columns["x_m"]}, BY)
        with self.assertRaisesRegex(tress.InputError, "2 scenes for 1 records"):
            tress.fit([scene, scene], [columns], BY)
        with self.assertRaisesRegex(tress.InputError, "cannot be read"):
            tress.fit(scene, "none.csv", BY)
        with self.assertRaisesRegex(tress.InputError, "sigma_m"):
            tress.fit(scene, columns, BY, priors={BY[0]: (3e9, 1e8)})
        with self.assertRaisesRegex(tress.InputError, r"\(bounds\): give a lower limit"):
            tress.fit(scene, columns, BY, bounds={BY[0]: (4e9, 1e9)})
        with self.assertRaisesRegex(tress.InputError, r"\(bounds\): give two finite numbers"):
            tress.fit(scene, columns, BY, bounds={BY[0]: (1e9, np.inf)})
        with self.assertRaisesRegex(tress.InputError, r"\(priors\): give a sigma above 0"):
            tress.fit(scene, columns, BY, priors={BY[0]: (3e9, 0)})
        with self.assertRaisesRegex(tress.InputError, r"has no strand 1 \(record 0:2:"):
            strands = np.ones(columns["time_s"].size, dtype=int)
            tress.fit(scene, {**columns, "strand": strands}, BY)
        for bad, place in ((5, "record"), ([], "record"), ({}, "record 0"), ([{}], "record 0")):
            with self.assertRaisesRegex(tress.InputError, rf"\({place}\): give") as caught:
                tress.fit(scene, bad, BY)
            self.assertNotIn("\n", str(caught.exception))
        for three in ((1, 2, 3), 1, ("a", "b")):
            with self.assertRaisesRegex(tress.InputError, r"no two numbers \(bounds\): give"):
                tress.fit(scene, columns, BY, bounds={BY[0]: three})
        with self.assertRaisesRegex(tress.InputError, r"int is no scene \(scene\)"):
            tress.fit(5, columns, BY)
        with self.assertRaisesRegex(tress.InputError, r"1 is no name \(by\)"):
            tress.fit(scene, columns, [1])
        late = columns["time_s"] + 0.1
        with self.assertRaisesRegex(tress.InputError, "which lasts 0.2 s .*set duration_s"):
            tress.fit(scene, {**columns, "time_s": late}, BY)

    def test_progress_may_end_it(self):
        def stop(evaluations, rms):
            raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            tress.fit(self.start(), record(self.truth()), BY, progress=stop)


if __name__ == "__main__":
    unittest.main()
