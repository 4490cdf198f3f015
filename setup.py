"""What pip runs: builds the extension and the program with CMake, in build/pip.

TALUS_BUILD names a build folder that has both already; nothing is built then.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py

ROOT = pathlib.Path(__file__).resolve().parent


def built():
    """The build folder, with the extension for this Python and the program in it."""
    if "TALUS_BUILD" in os.environ:
        return pathlib.Path(os.environ["TALUS_BUILD"])
    build = ROOT / "build/pip"
    off = ("TESTS", "STUDIES", "MAPS", "REPORT", "INSTALL")
    options = [f"-DTALUS_{part}=OFF" for part in off] + ["-DTALUS_QUICK_BUILD=ON", "-DCMAKE_BUILD_TYPE=Release"]
    try:
        import pybind11
        options.append(f"-Dpybind11_DIR={pybind11.get_cmake_dir()}")
    except ImportError:
        pass  # Debian's pybind11-dev is where CMake looks
    subprocess.run(["cmake", "-S", ROOT, "-B", build, "-G", "Ninja", f"-DPython_EXECUTABLE={sys.executable}", *options], check=True)
    if subprocess.run(["cmake", "--build", build, "--target", "talus_python", "talus_app"]).returncode:
        sys.exit("talus: the extension was not built; it wants the packages that ./run.sh --python installs")
    return build


class WithExtension(build_py):
    def run(self):
        super().run()
        build = built()
        modules = list(build.glob("python/talus/_talus.*.so"))
        if len(modules) != 1:
            sys.exit(f"talus: {build}/python/talus has {len(modules)} extensions, and one is wanted")
        shutil.copy(modules[0], pathlib.Path(self.build_lib) / "talus")
        bin = ROOT / "build/pip-bin"
        bin.mkdir(parents=True, exist_ok=True)
        shutil.copy(build / "app/talus", bin / "talus")


class WithBinaries(Distribution):
    def has_ext_modules(self):
        return True


setup(
    version=re.search(r"project\(talus VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1),
    cmdclass={"build_py": WithExtension},
    distclass=WithBinaries,
    data_files=[("bin", ["build/pip-bin/talus"])],
)
