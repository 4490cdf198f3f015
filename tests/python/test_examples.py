"""Every example runs from Python, with the bits of the command; and the notebooks run.

Usage: test_examples.py BUILD_DIR  (PYTHONPATH names BUILD_DIR/python)
"""
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

import talus
from common import EXAMPLES, PROGRAM, ROOT

# run for so long, then by so many steps [s], []
FOR, STEPS = 1.0, 50


class Examples(unittest.TestCase):
    def test_all(self):
        done = {"run": 0, "begun": 0, "cut": 0, "study": 0}
        for file in sorted(EXAMPLES.glob("*/*.toml")):
            text = file.read_text()
            with self.subTest(file.name), tempfile.TemporaryDirectory() as folder:
                if "talus_study = 1" in text or "../../out/motions" in text:
                    continue  # below
                if "\n[[stage]]" not in text or "\n[[map]]" in text:
                    self.cut(file, folder)
                    done["cut"] += 1
                else:
                    done["run" if self.whole(file, folder) else "begun"] += 1
        self.assertGreater(done["run"] + done["begun"], 25)
        self.assertGreater(done["run"], 10)  # how many end in time is a matter of the machine
        self.assertGreater(done["cut"], 4)

    def cut(self, file, folder):
        cut = talus.Cut(file)
        cut.write(pathlib.Path(folder, "py"))
        subprocess.run([PROGRAM, "cut", file, "-o", pathlib.Path(folder, "command")], check=True, capture_output=True)
        for name in ("blocks.json", "report.txt", "cut.svg"):
            self.assertEqual(pathlib.Path(folder, "py", name).read_bytes(), pathlib.Path(folder, "command", name).read_bytes(), name)

    def whole(self, file, folder):
        model = talus.Model(file)
        begun = time.monotonic()
        with model.start(pathlib.Path(folder, "py")) as run:
            while run.advance(steps=STEPS) and time.monotonic() < begun + FOR:
                pass
        if run.result.interrupted:
            self.assertGreaterEqual(run.step, STEPS)
            return False
        subprocess.run([PROGRAM, "run", file, "-o", pathlib.Path(folder, "command"), "-q"], check=True)
        for name in ("histories.csv", "joints.csv"):
            self.assertEqual(pathlib.Path(folder, "py", name).read_bytes(), pathlib.Path(folder, "command", name).read_bytes(), name)
        return True

    def test_studies_and_their_models(self):
        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder, "examples/many_runs")
            place.mkdir(parents=True)
            for file in (EXAMPLES / "many_runs").glob("*.toml"):
                (place / file.name).write_text(file.read_text())
            for number in range(1, 31):  # one for all: what differs is not looked at
                motion = pathlib.Path(folder, f"out/motions/m{number:02d}/motion.csv")
                motion.parent.mkdir(parents=True)
                motion.write_bytes((EXAMPLES / "record/motion.csv").read_bytes())
            self.assertIn("15 runs", talus.Study(place / "friction.toml").dry_run())
            self.assertIn("900 runs", talus.Study(place / "fragility.toml").dry_run())
            for name in ("slope", "wall"):
                with talus.Model(place / f"{name}.toml").start() as run:
                    self.assertTrue(run.advance(steps=STEPS))

    def test_notebooks(self):
        for notebook in sorted((ROOT / "notebooks").glob("*.py")):
            with self.subTest(notebook.name), tempfile.TemporaryDirectory() as folder:
                pathlib.Path(folder, "examples").symlink_to(EXAMPLES)
                done = subprocess.run([sys.executable, notebook], cwd=folder, capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(len(list(pathlib.Path(folder, "out/notebooks", notebook.stem).glob("*.png"))), 1)


if __name__ == "__main__":
    unittest.main()
