"""talus: blocks that move, slip and break under dynamic load, from Python.

    import talus
    model = talus.Model("slope.toml", {"joint.face.friction_angle": "25 deg"})
    result = model.run("out/slope")
    talus.Results("out/slope").histories["block.displacement_x [m]"]

docs/python.md goes through it line by line beside the command line; docs/python_api.md has every name.
"""

from ._talus import Instant, Result, __version__
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
