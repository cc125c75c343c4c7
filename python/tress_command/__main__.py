"""Entry of the launcher, ./tress, which runs this folder with any python3."""

import os
import sys

if sys.version_info < (3, 11):
    sys.exit("tress: needs Python 3.11 or later; %s is %s" % (sys.executable, sys.version.split()[0]))
sys.path[0] = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))

from tress_command.main import main  # noqa: E402

sys.exit(main())
