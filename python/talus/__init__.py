"""talus: blocks that move, slip and break under dynamic load, from Python.

    import talus
    model = talus.Model("slope.toml", {"joint.face.friction_angle": "25 deg"})
    result = model.run("out/slope")
    talus.Results("out/slope").histories["block.displacement_x [m]"]

docs/python.md goes through it line by line beside the command line; docs/python_api.md has every name.
"""

import glob as _glob
import os as _os
import sys as _sys

try:
    import numpy as _numpy  # noqa: F401
except ImportError as _error:
    raise ImportError(f"talus wants NumPy, which {_sys.executable} does not have: start /usr/bin/python3 with Debian's "
                      "python3-numpy, or install numpy for this one") from _error
try:
    from ._talus import Instant, Result, __version__
except ImportError as _error:
    _built = [_os.path.basename(f) for f in _glob.glob(_os.path.join(_os.path.dirname(__file__), "_talus.*.so"))]
    _this = "cpython-%d%d" % _sys.version_info[:2]
    if not _built or any(f"_talus.{_this}-" in name for name in _built):
        raise
    raise ImportError(f"talus was built for another Python ({', '.join(_built)}); {_sys.executable} is {_this}") from _error
from .cut import Cut
from .errors import Error, FileError, Finding, InputError, NumericalError
from .model import Model
from .results import Frame, Results
from .run import Run, State
from .study import Study, StudyResults

__all__ = [
    "Cut", "Error", "FileError", "Finding", "Frame", "InputError", "Instant", "Model", "NumericalError", "Result", "Results", "Run",
    "State", "Study", "StudyResults", "__version__",
]
