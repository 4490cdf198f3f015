"""Ways to have the package: a virtual environment, pip without a network, and plain words where Python is another."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

from common import BUILD, ROOT, SLOPE

PACKAGE = BUILD / "python"


def run(*line, **environment):
    clean = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
    done = subprocess.run([str(word) for word in line], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          env={**clean, "PYTHONDONTWRITEBYTECODE": "1", **environment})
    return done.returncode, done.stdout


class Install(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def test_virtual_environment(self):
        venv = self.folder / "venv"
        for _ in range(2):  # the second finds it made
            code, text = run(ROOT / "tools/python_venv.sh", BUILD, venv)
            self.assertEqual(code, 0, text)
            self.assertIn(f"{venv}/bin/python imports talus of {PACKAGE}", text)
        (self.folder / "slope.toml").write_text(SLOPE)
        code, text = run(venv / "bin/python", "-c", f"import talus; print(talus.Model(r'{self.folder}/slope.toml').run().steps)")
        self.assertEqual((code, text), (0, "1000\n"))

    def test_folder_that_is_no_environment(self):
        (self.folder / "mine").write_text("x")
        code, text = run(ROOT / "tools/python_venv.sh", BUILD, self.folder)
        self.assertEqual(code, 4)
        self.assertIn("no virtual environment: give another folder", text)
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["mine"])

    def test_pip_without_network(self):
        source = self.folder / "source"  # pip writes beside pyproject.toml
        source.mkdir()
        for part in ("pyproject.toml", "setup.py", "CMakeLists.txt", "README.md"):
            shutil.copy(ROOT / part, source)
        shutil.copytree(ROOT / "python/talus", source / "python/talus", ignore=shutil.ignore_patterns("__pycache__"))
        venv = self.folder / "venv"
        self.assertEqual(run(sys.executable, "-m", "venv", "--system-site-packages", venv)[0], 0)
        code, text = run(venv / "bin/python", "-m", "pip", "install", "--no-build-isolation", "--no-index", source, TALUS_BUILD=str(BUILD))
        self.assertEqual(code, 0, text)
        code, text = run(venv / "bin/python", "-c", "import talus, talus.study; print(talus.__file__, talus.study.program())")
        self.assertEqual(code, 0, text)
        self.assertEqual(text.split(), [str(next(venv.glob("lib/python3*/site-packages/talus/__init__.py"))), f"{venv}/bin/talus"])

    def test_python_without_numpy(self):
        code, text = run(sys.executable, "-S", "-c", "import talus", PYTHONPATH=str(PACKAGE))
        self.assertEqual(code, 1)
        self.assertIn(f"ImportError: talus wants NumPy, which {sys.executable} does not have", text)

    def test_another_python(self):
        package = self.folder / "talus"
        shutil.copytree(PACKAGE / "talus", package, ignore=shutil.ignore_patterns("_talus.*.so", "__pycache__"))
        (package / "_talus.cpython-38-x86_64-linux-gnu.so").write_text("")
        code, text = run(sys.executable, "-c", "import talus", PYTHONPATH=str(self.folder))
        self.assertEqual(code, 1)
        self.assertIn("ImportError: talus was built for another Python (_talus.cpython-38-x86_64-linux-gnu.so)", text)


if __name__ == "__main__":
    unittest.main()
