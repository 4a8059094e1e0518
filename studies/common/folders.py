"""Where the tools are. Importing this puts their folders on the path, for a study uses checks and drawings of others.

One way: common <- tests/acceptance <- gallery <- accuracy <- demo, effects, aids, method, peers, border, exact.
"""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FIGURES = ROOT / "docs" / "figures"  # the pictures that the repository holds

for _folder in ("tests/acceptance", "studies/gallery", "studies/accuracy"):
    sys.path.append(str(ROOT / _folder))
