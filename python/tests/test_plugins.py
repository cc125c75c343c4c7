import unittest

import tress


class Plugins(unittest.TestCase):
    def test_what_is_none_is_refused(self):
        with self.assertRaisesRegex(tress.InputError, "no plug-in of tress"):
            tress.load_plugin(__file__)
        with self.assertRaisesRegex(tress.InputError, "none.so"):
            tress.load_plugin("none.so")


if __name__ == "__main__":
    unittest.main()
