"""The Python package: errors, runs that have the bits of the command's, observers, views, threads, results.

Usage: test_talus.py BUILD_DIR  (PYTHONPATH names BUILD_DIR/python)
"""
import contextlib
import gc
import io
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy

import talus
from common import EXAMPLES, PROGRAM, ROOT, SLOPE


class Errors(unittest.TestCase):
    def test_five_wrong_inputs(self):
        wrong = [
            ("density = \"2600 kg/m3\"", "density = \"-1 kg/m3\"", "material.rock.density", 5),
            ("friction_angle = \"15 deg\"", "friction_angle = 15", "joint.face.friction_angle", 7),
            ("material = \"rock\"\nkind = \"rigid\"", "material = \"rok\"\nkind = \"rigid\"", "block.block.material", 18),
            ("time_step = \"1 ms\"\n[[stage]]", "time_stp = \"1 ms\"\n[[stage]]", "stage.slide.time_stp", 24),
            ("joint = \"face\"", "joint = \"faze\"", "contact.joint", 9),
        ]
        for right, bad, key, line in wrong:
            with self.subTest(key), self.assertRaises(talus.InputError) as caught:
                talus.Model.from_text(SLOPE.replace(right, bad, 1), file="slope.toml")
            found = [f for f in caught.exception.findings if f.key == key]
            self.assertEqual([(f.severity, f.file, f.line) for f in found], [("error", "slope.toml", line)], caught.exception)
            self.assertTrue(found[0].message)
            self.assertIn("slope.toml:%d:" % line, str(caught.exception))

    def test_overrides_and_files(self):
        with self.assertRaises(talus.InputError) as caught:
            talus.Model.from_text(SLOPE, {"stage.slide.duration": "1 parsec"})
        self.assertIn("stage.slide.duration", caught.exception.findings[0].key)
        with self.assertRaises(talus.FileError):
            talus.Model("no such file.toml")
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "mine.txt").write_text("kept")
            with self.assertRaises(talus.FileError):
                talus.Model.from_text(SLOPE).run(folder)
            self.assertEqual(pathlib.Path(folder, "mine.txt").read_text(), "kept")
        with self.assertRaises(ValueError):
            talus.Model.from_text(SLOPE).run(until="no stage")
        for wrong in ({"every": 0}, {"threads": -1}):
            with self.assertRaises(ValueError):
                talus.Model.from_text(SLOPE).run(**wrong)

    def test_a_dictionary_is_the_same_model(self):
        import tomllib
        for text in (SLOPE, (EXAMPLES / "wall/wall.toml").read_text()):
            model = talus.Model.from_dict(tomllib.loads(text))
            self.assertEqual(tomllib.loads(model.text), tomllib.loads(text))
            self.assertEqual(model.blocks, talus.Model.from_text(text).blocks)


    def test_odd_values(self):
        import tomllib
        odd = {"title": 'quotes " and \\ and \x7f and \n', "material": {"r\U0001f600": {"density": 1e3}, "a.b": {"density": numpy.float64(2)}},
               "load": [], "x": {"y": [[1, 2.5], ["z"]]}}
        text = talus.model.text_of(odd)
        self.assertEqual(tomllib.loads(text), {k: v for k, v in odd.items() if k != "load"})
        for wrong in ({"a": object()}, {1: 2}, {"a": {None: 1}}):
            with self.assertRaises(TypeError):
                talus.model.text_of(wrong)
        for wrong, error in (([], TypeError), ("a=b", TypeError), ({"a=b": 1}, ValueError), ({1: 1}, ValueError)):
            with self.assertRaises(error):
                talus.Model.from_text(SLOPE, wrong)
        with self.assertRaises(TypeError):
            talus.Model({"talus": 1})

    def test_a_file_is_read_as_the_command_reads_it(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "crlf.toml")
            file.write_bytes(SLOPE.replace("\n", "\r\n").encode())
            talus.Model(file).run(pathlib.Path(folder, "py"))
            subprocess.run([PROGRAM, "run", file, "-o", pathlib.Path(folder, "cmd"), "-q"], check=True)
            for name in ("model.toml", "histories.csv"):
                self.assertEqual(pathlib.Path(folder, "py", name).read_bytes(), pathlib.Path(folder, "cmd", name).read_bytes())

    def test_names_of_folders(self):
        with tempfile.TemporaryDirectory() as folder:
            for wrong in ("", "a\0b"):
                with self.assertRaises(ValueError):
                    talus.Model.from_text(SLOPE).run(wrong)
            place = pathlib.Path(folder, "bytes")
            talus.Model.from_text(SLOPE).run(os.fsencode(place))
            self.assertTrue((place / "summary.json").exists())


class Page(unittest.TestCase):
    def test_the_examples_of_the_documentation_run(self):
        page = (ROOT / "docs/python.md").read_text()
        told = io.StringIO()
        with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder), contextlib.redirect_stdout(told):
            pathlib.Path("examples").symlink_to(EXAMPLES)
            names = {}
            for part in page.split("```python\n")[1:]:
                exec(part.split("```")[0], names)
        self.assertRegex(told.getvalue(), r"1\.000 s, step 1000: [0-9.]+ m/s, 2 contact points")

    def test_the_reference_is_what_the_docstrings_say(self):
        done = subprocess.run([sys.executable, ROOT / "tools/python_api.py", "--check"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)


class Runs(unittest.TestCase):
    def test_bits_of_the_command(self):
        for example in ("incline", "dominoes", "impact_bar"):
            file = EXAMPLES / example / f"{example}.toml"
            with tempfile.TemporaryDirectory() as folder:
                result = talus.Model(file).run(pathlib.Path(folder, "py"), lambda now: None)
                subprocess.run([PROGRAM, "run", file, "-o", pathlib.Path(folder, "cmd"), "-q"], check=True)
                for name in ("histories.csv", "joints.csv"):
                    self.assertEqual(pathlib.Path(folder, "py", name).read_bytes(), pathlib.Path(folder, "cmd", name).read_bytes())
                self.assertTrue(result.valid)
                found = talus.Results(result.folder)
                self.assertEqual(found.summary["status"], "finished")
                self.assertEqual(found.histories["t [s]"][-1], result.time)

    def test_way_of_a_sliding_block(self):
        result = talus.Model.from_text(SLOPE).run()
        exact = 0.5 * 9.81 * (0.5 - numpy.tan(numpy.radians(15)) * numpy.cos(numpy.radians(30)))
        self.assertAlmostEqual(result.displacement[1, 0], exact, delta=1e-6 * exact)
        self.assertEqual(result.steps, 1000)

    def test_loose_steps(self):
        loose = talus.Model.from_text(SLOPE, {"solver.tolerance": 1e-300}).run()
        self.assertEqual(loose.failure, "")
        self.assertGreater(loose.loose_steps, 200)
        self.assertEqual(loose.failed_steps, 0)
        self.assertEqual(talus.Model.from_text(SLOPE).run().loose_steps, 0)

    def test_penalty_and_until(self):
        model = talus.Model.from_text(SLOPE, {"model.formulation": "penalty", "new:penalty.largest_displacement": 1e-3})
        result = model.run(until="slide", observer=lambda now: None)
        self.assertAlmostEqual(result.time, 0.5)
        self.assertEqual(model.stages, ["slide", "on"])


class Observers(unittest.TestCase):
    def test_views_are_no_copies_and_outlive_the_run(self):
        seen = []

        def look(now):
            seen.append((now.time, now.stage, now.displacement, now.displacement[1, 0], now.velocity[1, 0]))

        result = talus.Model.from_text(SLOPE).run(observer=look)
        views = [entry[2] for entry in seen]
        self.assertEqual(len({v.__array_interface__["data"] for v in views}), 1)  # one memory, through both stages
        self.assertTrue(all(not v.flags.writeable and not v.flags.owndata for v in views))
        self.assertTrue(numpy.shares_memory(views[0], result.displacement))
        with self.assertRaises(ValueError):
            views[0][1, 0] = 0
        self.assertEqual({s[1] for s in seen}, {0, 1})
        rates = (result.rate, result.rate_gradient)
        self.assertTrue(all(not r.flags.writeable and not r.flags.owndata for r in rates))
        self.assertEqual((rates[0].shape, rates[1].shape), ((2, 2), (2, 2, 2)))
        # what was read at each instant moved on; the velocity is that of the way
        ways, times = [s[3] for s in seen], [s[0] for s in seen]
        self.assertLess(ways[10], ways[500])
        self.assertAlmostEqual(seen[500][4] * 1.0, 2 * ways[500] / times[500], places=6)
        last, whole = float(result.displacement[1, 0]), result.displacement.tobytes()
        rate = result.rate
        del result, seen
        gc.collect()
        [bytearray(1 << 20) for _ in range(50)]
        self.assertEqual(views[0][1, 0], last)
        self.assertEqual(views[0].tobytes(), whole)  # by memcpy, which the sanitizers watch
        self.assertEqual(len(rate.copy()), 2)

    def test_an_instant_is_over_afterwards(self):
        kept = []
        talus.Model.from_text(SLOPE).run(observer=kept.append, every=100)
        self.assertGreater(len(kept), 9)
        with self.assertRaises(ValueError):
            kept[0].time
        self.assertEqual(kept[0].displacement.shape, (2, 2))

    def test_contacts(self):
        rows = []
        talus.Model.from_text(SLOPE).run(observer=lambda now: rows.append(now.contacts), every=250)
        pressed = rows[-1][rows[-1]["normal"] > 0]
        self.assertAlmostEqual(float(pressed["normal"].sum()), 2600 * 8.495709, delta=1)
        self.assertAlmostEqual(abs(float(pressed["shear"].sum())), float(numpy.tan(numpy.radians(15))) * 2600 * 8.495709, delta=1)

    def test_false_ends_a_run_and_errors_pass(self):
        result = talus.Model.from_text(SLOPE).run(observer=lambda now: now.step < 20)
        self.assertTrue(result.interrupted)
        self.assertEqual(result.steps, 21)  # the step that was under way

        # NumPy's too; what is merely empty goes on
        result = talus.Model.from_text(SLOPE).run(observer=lambda now: numpy.hypot(*now.velocity.T).max() < 0.1)
        self.assertTrue(result.interrupted)
        self.assertLess(result.steps, 100)
        for answer in (None, 0, [], numpy.True_, True):
            self.assertEqual(talus.Model.from_text(SLOPE).run(observer=lambda now: answer).steps, 1000)

        def fails(now):
            raise KeyError("mine")

        with self.assertRaises(KeyError):
            talus.Model.from_text(SLOPE).run(observer=fails)

    def test_rates_are_those_of_the_step_that_follows(self):
        seen = []
        talus.Model.from_text(SLOPE).run(observer=lambda now: seen.append((now.displacement[1, 0], now.rate[1, 0], now.last)))
        for (way, rate, last), (then, _, _) in zip(seen, seen[1:]):
            if not last:
                self.assertAlmostEqual(rate * 1e-3, then - way, delta=1e-15)
        self.assertEqual(seen[-1][1], seen[-2][1])  # none follows

    def test_what_is_no_observer(self):
        async def later(now):
            pass

        with tempfile.TemporaryDirectory() as folder:
            for wrong in (5, "look", later):
                with self.assertRaises(TypeError):
                    talus.Model.from_text(SLOPE).run(pathlib.Path(folder, "run"), wrong)
                self.assertFalse(pathlib.Path(folder, "run").exists())

    def test_ctrl_c(self):
        long = talus.Model.from_text(SLOPE, {"stage.slide.duration": "2000 s"})
        signal.signal(signal.SIGALRM, lambda *_: signal.raise_signal(signal.SIGINT))
        signal.setitimer(signal.ITIMER_REAL, 0.3)
        begun = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            long.run()
        self.assertLess(time.monotonic() - begun, 5)

    def test_others_go_on_meanwhile_and_runs_stand_beside_each_other(self):
        ticks, ended, results = [], threading.Event(), {}

        def tick():
            while not ended.is_set():
                ticks.append(time.monotonic())
                time.sleep(0.005)

        def run(name, angle):
            results[name] = talus.Model.from_text(SLOPE, {"joint.face.friction_angle": f"{angle} deg"}).run(observer=lambda now: None)

        clock = threading.Thread(target=tick)
        clock.start()
        runs = [threading.Thread(target=run, args=(k, 10 + k)) for k in range(4)]
        [t.start() for t in runs]
        [t.join() for t in runs]
        ended.set()
        clock.join()
        self.assertGreater(len(ticks), 3)
        for k in range(4):
            alone = talus.Model.from_text(SLOPE, {"joint.face.friction_angle": f"{10 + k} deg"}).run()
            self.assertEqual(results[k].displacement[1, 0], alone.displacement[1, 0])


if __name__ == "__main__":
    unittest.main()
