# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""For notebooks and plain Python, in one line: `%run path/to/setup/use_workspace.py`, then `import hasel_sim`.

The notebook's Python must be that of `.venv`, or one with the same packages; nodes and messages need more:
`. setup/environment.bash` in the shell before.
"""

import sys
from pathlib import Path

_ROOT = Path(__file__).resolve().parents[1]
_PACKAGES = _ROOT / "install" / "lib" / f"python{sys.version_info[0]}.{sys.version_info[1]}" / "site-packages"
if not _PACKAGES.is_dir():
    raise SystemExit(
        f"{_PACKAGES} is not there: run `make build` in {_ROOT}, and use the Python of its .venv."
    )
if str(_PACKAGES) not in sys.path:
    sys.path.insert(0, str(_PACKAGES))
