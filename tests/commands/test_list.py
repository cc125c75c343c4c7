"""./tress list in the tree that is tested: it rebuilds nothing and lists the experiments."""

import os
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import tress_test  # noqa: E402


class Listing(tress_test.TressTest):
    def test_experiments_are_listed(self):
        query = self.work / "dpkg-query"
        query.write_text('#!/bin/bash\nprintf "installed %s\\n" "${@:3}"\n')
        query.chmod(0o755)
        done = tress_test.run("list", PATH=f"{self.work}:{os.environ['PATH']}")
        self.ends(0, "(?m)^experiments: .*stability_limit", done)
        self.assertIn("super_helix", done.stdout)


if __name__ == "__main__":
    unittest.main()
