"""talus: blocks that move, slip and break under dynamic load, from Python.

    import talus
    model = talus.Model("slope.toml", {"joint.face.friction_angle": "25 deg"})
    result = model.run("out/slope")
    talus.Results("out/slope").histories["block.displacement_x [m]"]

docs/python.md goes through it line by line beside the command line.
"""

from ._talus import Instant, Result, __version__
from .errors import Error, FileError, Finding, InputError, NumericalError
from .model import Model
from .results import Results

__all__ = ["Error", "FileError", "Finding", "InputError", "Instant", "Model", "NumericalError", "Result", "Results", "__version__"]
