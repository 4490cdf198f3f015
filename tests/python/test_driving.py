"""Runs that are taken step by step, saved states, branches.

Usage: test_driving.py BUILD_DIR  (PYTHONPATH names BUILD_DIR/python)
"""
import gc
import os
import pathlib
import pickle
import shutil
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy

import talus
from common import EXAMPLES, PROGRAM, SLOPE

# a prop that is taken away under a block, after rest: from rest to rest, as rows give and blocks go
HEAP = """talus = 1
[model]
gravity = [0, -10]
[material.m]
density = 2600
young = "1 GPa"
poisson = 0.2
[joint.face]
friction_angle = "20 deg"
[contact]
joint = "face"
[[block]]
name = "ground"
polygon = [[-1, -1], [3, -1], [3, 0], [-1, 0]]
material = "m"
kind = "fixed"
[[block]]
name = "prop"
polygon = [[0, 0], [1, 0], [1, 0.5], [0, 0.5]]
material = "m"
kind = "rigid"
[[block]]
name = "load"
polygon = [[0.2, 0.5], [1.2, 0.5], [1.2, 1.5], [0.2, 1.5]]
material = "m"
[[stage]]
name = "rest"
kind = "static"
duration = 50
integration = "implicit"
[[stage]]
name = "fall"
kind = "dynamic"
duration = "0.2 s"
time_step = "1 ms"
elasticity = "implicit"
excavate = ["prop"]
[[monitor]]
name = "load"
block = "load"
"""


def files_of(folder):
    return {name: pathlib.Path(folder, name).read_bytes() for name in ("histories.csv", "steps.csv", "joints.csv", "slips.csv")}


class Driving(unittest.TestCase):
    def test_pieces_have_the_bits_of_the_whole(self):
        for text in (SLOPE, HEAP):
            with tempfile.TemporaryDirectory() as folder:
                model = talus.Model.from_text(text)
                whole = model.run(pathlib.Path(folder, "whole"))
                with model.start(pathlib.Path(folder, "parts")) as run:
                    while run.advance(steps=7):
                        self.assertFalse(run.over)
                self.assertTrue(run.over)
                self.assertFalse(run.advance(steps=7))
                self.assertTrue(numpy.array_equal(run.displacement, whole.displacement))
                self.assertEqual(files_of(pathlib.Path(folder, "whole")), files_of(pathlib.Path(folder, "parts")))
                self.assertFalse(run.result.interrupted)
                self.assertTrue(run.result.valid)

    def test_pauses(self):
        run = talus.Model.from_text(SLOPE).start()
        self.assertEqual((run.step, run.stage, run.over), (0, "", False))
        self.assertTrue(run.advance(steps=10))
        self.assertEqual((run.step, run.stage), (10, "slide"))
        self.assertTrue(run.advance(time=0.1))
        self.assertEqual(run.step, 100)
        self.assertTrue(run.advance(stage_end=True))
        self.assertEqual((run.step, run.stage), (500, "slide"))
        self.assertTrue(run.advance(steps=0))
        self.assertEqual(run.stage, "on")
        self.assertFalse(run.advance())
        self.assertEqual([s["steps"] for s in run.result.stages], [500, 500])
        for wrong, error in (({"steps": -1}, ValueError), ({"steps": 2 ** 70}, ValueError), ({"steps": 1.5}, TypeError),
                             ({"time": float("nan")}, ValueError), ({"time": "soon"}, ValueError)):
            with self.assertRaises(error):
                talus.Model.from_text(SLOPE).start().advance(**wrong)

    def test_a_result_is_how_far_it_has_come(self):
        run = talus.Model.from_text(SLOPE).start()
        run.advance(steps=10)
        then = run.result
        run.advance(steps=10)
        self.assertEqual((then.steps, then.stages[0]["steps"], run.result.steps), (10, 10, 20))
        self.assertAlmostEqual(then.time, 0.01)
        self.assertIn("goes on", repr(then))
        run.finish()
        self.assertIn("stopped", repr(run.result))

    def test_between_steps(self):
        run = talus.Model.from_text(SLOPE).start()
        view = run.displacement
        run.advance(steps=100)
        self.assertTrue(numpy.shares_memory(view, run.displacement))
        way = float(view[1, 0])
        run.advance(steps=1)
        self.assertAlmostEqual((view[1, 0] - way) / 1e-3, run.rate[1, 0], places=9)  # way of a step over its length
        self.assertAlmostEqual(float(run.contacts["normal"].sum()), 2600 * 8.495709, delta=1)
        self.assertEqual(run.stress.shape, (2, 2, 2))
        del run
        gc.collect()
        self.assertGreater(view[1, 0], way)

    def test_what_is_left_is_a_run_that_was_interrupted(self):
        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder, "run")
            with self.assertRaises(KeyError), talus.Model.from_text(SLOPE).start(place) as run:
                run.advance(steps=30)
                raise KeyError("mine")
            self.assertEqual(talus.Results(place).summary["status"], "interrupted")
            self.assertEqual(talus.Results(place).times[-1], 0.03)
            run = talus.Model.from_text(SLOPE).start(place, force=True)
            run.advance(steps=40)
            del run
            gc.collect()
            self.assertEqual(talus.Results(place).summary["status"], "interrupted")
            # and goes on by the command
            saved = sorted(pathlib.Path(place, "saved").iterdir())[-1]
            file = pathlib.Path(folder, "model.toml")
            file.write_text(SLOPE)
            subprocess.run([PROGRAM, "run", file, "--from", saved, "-q"], check=True)
            self.assertEqual(talus.Results(place).times[-1], 1)

    def test_one_caller_at_a_time(self):
        run = talus.Model.from_text(SLOPE).start(observer=lambda now: run.advance(steps=1))
        with self.assertRaises(ValueError):
            run.advance(steps=2)
        model = talus.Model.from_text(SLOPE)
        done = {}

        def drive(name):
            with model.start() as mine:
                while mine.advance(steps=10 + name):
                    pass
            done[name] = float(mine.displacement[1, 0])

        drivers = [threading.Thread(target=drive, args=(k,)) for k in range(3)]
        [d.start() for d in drivers]
        [d.join() for d in drivers]
        self.assertEqual(len(done), 3)
        self.assertEqual(len(set(done.values())), 1)

    def test_who_holds_each_other_is_freed_and_its_folder_too(self):
        class Watcher:
            def __init__(self, folder):
                self.run = talus.Model.from_text(SLOPE).start(folder, self.look, force=True)

            def look(self, now):
                pass

        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder, "run")
            watcher = Watcher(place)
            watcher.run.advance(steps=5)
            with self.assertRaises(talus.FileError) as caught:
                Watcher(place)
            self.assertIn("finish() that one first", str(caught.exception))
            del watcher, caught
            gc.collect()
            self.assertEqual(talus.Results(place).summary["status"], "interrupted")
            Watcher(place).run.finish()

    def test_the_end_of_the_interpreter_ends_its_runs(self):
        script = """
import sys, threading, time, talus
sys.path.insert(0, {tests!r}); sys.argv = ["x"]
from common import SLOPE
long = {{"stage.slide.duration": "20000 s"}}
def look(now): global seen; seen = run if "run" in globals() else None
run = talus.Model.from_text(SLOPE, long).start({one!r}, look)
run.advance(steps=10)
threading.Thread(target=lambda: talus.Model.from_text(SLOPE, long).run({two!r}, lambda now: None), daemon=True).start()
time.sleep(0.5)
"""
        with tempfile.TemporaryDirectory() as folder:
            one, two = str(pathlib.Path(folder, "one")), str(pathlib.Path(folder, "two"))
            tests = str(pathlib.Path(__file__).parent)
            done = subprocess.run([sys.executable, "-c", script.format(tests=tests, one=one, two=two)], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            for place in (one, two):
                self.assertEqual(talus.Results(place).summary["status"], "interrupted")
                self.assertFalse(pathlib.Path(place, "talus_lock.txt").exists())

    def test_a_copy_of_the_process_leaves_it_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder, "run")
            run = talus.Model.from_text(SLOPE).start(place, threads=2)
            run.advance(steps=10)
            child = os.fork()
            if child == 0:
                try:
                    run.advance(steps=1)
                except ValueError:
                    del run
                    gc.collect()
                    os._exit(7)
                os._exit(1)
            self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), 7)
            self.assertFalse(run.advance())
            self.assertEqual(talus.Results(place).summary["status"], "finished")

    def test_a_lost_folder_ends_it(self):
        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder, "run")
            run = talus.Model.from_text(SLOPE).start(place)
            run.advance(steps=10)
            shutil.rmtree(place)
            with self.assertRaises(talus.FileError):
                run.advance()
            self.assertTrue(run.over)
            self.assertFalse(run.advance())
            self.assertTrue(run.result.interrupted)

    def test_another_thread_waits_its_turn(self):
        stepped = threading.Event()

        def look_within(now):
            run.contacts  # by who takes it on
            if now.step >= 100:
                stepped.set()

        run = talus.Model.from_text(SLOPE, {"stage.slide.duration": "20000 s"}).start(observer=look_within, every=100)
        driver = threading.Thread(target=run.advance)
        driver.start()
        self.assertTrue(stepped.wait(60))
        refused = 0
        for look in (lambda: run.contacts, lambda: run.result, run.save, lambda: run.advance(steps=1)):
            try:
                look()
            except ValueError:
                refused += 1
        run._run.interrupt()
        driver.join()
        self.assertEqual(refused, 4)
        self.assertGreater(len(run.contacts), 0)

    def test_bad_numbers_end_it(self):
        model = talus.Model.from_text(HEAP, {"stage.rest.duration": 0.002, "block.load.velocity": [0, 3]})
        with self.assertRaises(talus.NumericalError) as caught, model.start() as run:
            while run.advance(steps=1):
                pass
        self.assertIn("did not come to rest", str(caught.exception))
        self.assertTrue(run.over)
        self.assertIn("did not come to rest", run.result.failure)
        self.assertIn("failed", repr(run))


class States(unittest.TestCase):
    def test_going_on_has_the_bits_of_the_whole(self):
        for text, pause in ((SLOPE, {"steps": 333}), (HEAP, {"steps": 3}), (HEAP, {"stage_end": True})):
            model = talus.Model.from_text(text)
            whole = model.run()
            run = model.start()
            run.advance(**pause)
            state = run.save()
            self.assertTrue(numpy.array_equal(model.run(state=state).displacement, whole.displacement))
            self.assertTrue(numpy.array_equal(model.run(state=pickle.loads(pickle.dumps(state))).displacement, whole.displacement))
            run.advance()  # that a state was taken changes nothing
            self.assertTrue(numpy.array_equal(run.displacement, whole.displacement))

    def test_in_the_folder_of_the_run(self):
        with tempfile.TemporaryDirectory() as folder:
            whole, place = pathlib.Path(folder, "whole"), pathlib.Path(folder, "run")
            model = talus.Model.from_text(SLOPE)
            model.run(whole)
            model.run(place, until="slide")
            model.run(place, state=place / "saved/stage_01.h5")
            self.assertEqual(files_of(whole), files_of(place))
            with self.assertRaises(ValueError):
                model.run(pathlib.Path(folder, "new"), state=place / "saved/stage_02.h5", until="slide")
            self.assertFalse(pathlib.Path(folder, "new").exists())

    def test_branches(self):
        with tempfile.TemporaryDirectory() as folder:
            run = talus.Model.from_text(HEAP).start(pathlib.Path(folder, "parent"))
            run.advance(stage_end=True)
            state = run.save()
            run.finish()
            for name, parent in (("of memory", state), ("of file", pathlib.Path(folder, "parent/saved/stage_01.h5"))):
                place = pathlib.Path(folder, name)
                result = talus.Model.from_text(HEAP, {"stage.fall.duration": "0.1 s"}).run(place, state=parent)
                self.assertEqual(result.stages[-1]["steps"], 100)
                self.assertTrue(result.valid)
                self.assertAlmostEqual(talus.Results(place).times[-1], result.time)
            # one of a state that wrote no results
            run = talus.Model.from_text(HEAP).start()
            run.advance(stage_end=True)
            place = pathlib.Path(folder, "bare")
            self.assertTrue(talus.Model.from_text(HEAP).run(place, state=run.save()).valid)
            with self.assertRaises(talus.InputError) as caught:
                talus.Model.from_text(HEAP, {"material.m.density": 2000}).run(state=state)
            self.assertIn("material.m.density", str(caught.exception))

    def test_files(self):
        with tempfile.TemporaryDirectory() as folder:
            run = talus.Model.from_text(SLOPE).start()
            run.advance(steps=100)
            file = pathlib.Path(folder, "state.h5")
            run.save().write(file)
            self.assertEqual(talus.State(file).size, file.stat().st_size)
            self.assertEqual(talus.Model.from_text(SLOPE).run(state=file).steps, 1000)
            model = pathlib.Path(folder, "model.toml")
            model.write_text(SLOPE)
            subprocess.run([PROGRAM, "run", model, "--from", file, "-o", pathlib.Path(folder, "branch"), "-q"], check=True)
            self.assertEqual(talus.Results(pathlib.Path(folder, "branch")).times, [0.1, 0.5, 1])
            broken = bytearray(file.read_bytes())
            broken[-100] ^= 1
            file.write_bytes(broken)
            with self.assertRaises(talus.FileError):
                talus.Model.from_text(SLOPE).run(state=file)
            with self.assertRaises(talus.FileError):
                talus.State(pathlib.Path(folder, "none.h5"))

    def test_saving_side_by_side(self):
        # the library of the files serves one thread at a time
        model = talus.Model.from_text(SLOPE)
        sizes = []

        def save():
            with model.start() as run:
                while run.advance(steps=20):
                    sizes.append(run.save().size)

        savers = [threading.Thread(target=save) for _ in range(4)]
        [s.start() for s in savers]
        [s.join() for s in savers]
        self.assertEqual(len(sizes), 4 * 49)


if __name__ == "__main__":
    unittest.main()
