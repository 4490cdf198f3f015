"""Results, cuts, studies and figures, and what notebooks show of them.

Usage: test_folders.py BUILD_DIR  (PYTHONPATH names BUILD_DIR/python)
"""
import contextlib
import json
import os
import pathlib
import signal
import tempfile
import unittest

import matplotlib
import numpy

import talus
from common import EXAMPLES, SLOPE

matplotlib.use("Agg")


class Folders(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name, "<slope> & run")
        cls.model = talus.Model.from_text(SLOPE, {"new:output.field_interval": "0.25 s"})
        cls.taken = cls.model.start(cls.folder)
        cls.taken.advance()
        cls.results = talus.Results(cls.folder)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_frames(self):
        self.assertEqual(self.results.times, [0, 0.25, 0.5, 0.75, 1])
        exact = 0.5 * 9.81 * (0.5 - numpy.tan(numpy.radians(15)) * numpy.cos(numpy.radians(30)))
        for k, time in enumerate(self.results.times):
            frame = self.results.frame(k)
            self.assertEqual(frame.time, time)
            way = exact * time ** 2
            self.assertAlmostEqual(frame.of_blocks("centroid displacement")[1, 0], way, places=6)
            self.assertAlmostEqual(frame.of_blocks("velocity")[1, 0], 2 * exact * time, delta=1e-5)
            self.assertTrue(numpy.allclose(frame.polygons[1], numpy.array([[0, 0], [1, 0], [1, 1], [0, 1]]) + [way, 0], atol=1e-6))
        with self.assertRaises(KeyError) as caught:
            frame.of_blocks("temperature")
        self.assertIn("stress xx", str(caught.exception))
        self.assertEqual(self.results.contact_frame()["Points"].shape, (2, 3))

    def test_a_folder_that_is_none(self):
        for place in ("/", self.folder / "fields"):
            with self.assertRaises(talus.FileError):
                talus.Results(place)
        with self.assertRaises(talus.FileError):
            self.results.table("no.csv")

    def test_damaged_tables(self):
        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder)
            (place / "summary.json").write_text("[]")
            with self.assertRaises(talus.FileError):
                talus.Results(place)
            (place / "summary.json").write_text('{"status": "finished"}')
            results = talus.Results(place)
            for text, line in ((b"a,b\n1,2\n3\n", ":3:"), (b"a\n\xff\n", "a.csv")):
                (place / "a.csv").write_bytes(text)
                with self.assertRaises(talus.FileError) as caught:
                    results.table("a.csv")
                self.assertIn(line, str(caught.exception))
            (place / "a.csv").write_text("slip,name,one\n,1_0,x\n0.5,ground,2\n")
            table = results.table("a.csv")
            self.assertTrue(numpy.isnan(table["slip"][0]) and table["slip"][1] == 0.5)
            self.assertEqual((table["name"], table["one"]), (["1_0", "ground"], ["x", "2"]))
        with self.assertRaises(IndexError) as caught:
            self.results.frame(99)
        self.assertIn("has 5", str(caught.exception))

    def test_figures(self):
        axes = self.results.plot("block.displacement_x")
        line = axes.get_lines()[0]
        self.assertTrue(numpy.array_equal(line.get_ydata(), self.results.histories["block.displacement_x [m]"]))
        self.assertEqual(axes.get_ylabel(), "[m]")
        self.assertTrue(self.results.plot().get_lines())
        with self.assertRaises(KeyError):
            self.results.plot("nobody")
        axes = self.results.frame().plot("velocity")
        blocks = axes.collections[0]
        self.assertEqual(len(blocks.get_paths()), 2)
        self.assertAlmostEqual(blocks.get_array()[1], 2 * self.results.frame().of_blocks("centroid displacement")[1, 0], places=4)
        self.assertEqual(blocks.get_array()[0], 0)

    def test_what_notebooks_show(self):
        shown = self.results._repr_html_()
        self.assertIn("&lt;slope&gt; &amp; run", shown)
        self.assertNotIn("<slope>", shown)
        cut = talus.Cut(EXAMPLES / "slope/slope.toml")
        for html in (shown, self.taken._repr_html_(), self.taken.result._repr_html_(), self.model._repr_html_(), cut._repr_html_()):
            # an image of its own: names within pictures would be mixed up
            self.assertEqual(html.count('<img style="max-width: 100%; background: white" src="data:image/svg+xml;base64,'), 1)
            self.assertNotIn("<svg", html)
        self.assertIn("500", self.taken._repr_html_())
        self.assertIn("1000", repr(self.taken))

    def test_check(self):
        self.assertIn("no errors, 0 warnings", self.model.check())
        self.assertIn("500 steps of 0.001 s", self.model.check())


class Cuts(unittest.TestCase):
    def test_a_cut(self):
        with tempfile.TemporaryDirectory() as folder:
            cut = talus.Cut(EXAMPLES / "slope/slope.toml")
            self.assertEqual(len(cut.blocks), len(cut.polygons))
            self.assertEqual(len(cut.blocks), cut.summary["after"]["blocks"])
            x, y = numpy.array(cut.polygons[0]).T
            area = 0.5 * numpy.sum(x * numpy.roll(y, -1) - numpy.roll(x, -1) * y)
            self.assertGreater(area, 0)
            cut.write(pathlib.Path(folder, "cut"))
            written = json.loads(pathlib.Path(folder, "cut/cut.json").read_text())
            self.assertEqual(written, cut.summary)
            with self.assertRaises(talus.FileError):
                cut.write(pathlib.Path(folder, "cut"))
            cut.write(pathlib.Path(folder, "cut"), force=True)

    def test_what_is_wrong(self):
        with self.assertRaises(talus.InputError) as caught:
            talus.Cut({"talus": 1, "material": {"m": {"density": 1000.0}}})
        self.assertIn("there is nothing to cut", " ".join(f.message for f in caught.exception.findings if f.severity == "error"))


class Tables(unittest.TestCase):
    def test_names_of_digits_are_names(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "monitors.csv")
            path.write_text("monitor,quantity,stage,at_end\n1,x,007,1\n2,x,007,2\n")
            table = talus.results.read_table(str(path))
            self.assertEqual(table["monitor"], ["1", "2"])
            self.assertEqual(table["stage"], ["007", "007"])
            self.assertEqual(list(table["at_end"]), [1, 2])


class Studies(unittest.TestCase):
    def test_a_study(self):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "slope.toml").write_text(SLOPE)
            sections = {
                "talus_study": 1, "title": "angles", "model": str(pathlib.Path(folder, "slope.toml")), "set": {"stage.on.duration": "0.1 s"},
                "answers": {"way": "block.displacement_x.at_end"},
                "vary": [{"key": "joint.face.friction_angle", "name": "phi", "values": ["10 deg", "15 deg"]}],
            }
            study = talus.Study(sections)
            self.assertIn("2 runs", study.dry_run())
            found = study.run(pathlib.Path(folder, "study"), jobs=2)
            for angle, way in zip((10, 15), found.table["way [m]"]):
                exact = 0.5 * 9.81 * (0.5 - numpy.tan(numpy.radians(angle)) * numpy.cos(numpy.radians(30))) * 0.6 ** 2
                self.assertAlmostEqual(way, exact, delta=1e-5 * exact)
            self.assertEqual(found.run(1).summary["status"], "finished")
            self.assertIn("finished", found._repr_html_())
            self.assertEqual(study.run(pathlib.Path(folder, "study")).table["way [m]"][0], found.table["way [m]"][0])
            os.environ["TALUS_PROGRAM"] = "/no/such/program"
            try:
                with self.assertRaises(talus.FileError):
                    study.dry_run()
            finally:
                del os.environ["TALUS_PROGRAM"]
            with self.assertRaises(ValueError):
                study.run(pathlib.Path(folder, "study"), jobs=-1)
            with self.assertRaises(talus.InputError) as caught:
                talus.Study({**sections, "vary": [{"key": "joint.face.friction_angel", "values": ["1 deg"]}]}).dry_run()
            self.assertIn("friction_angel", str(caught.exception))

    def test_a_study_that_is_stopped_stops_its_runs(self):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "slope.toml").write_text(SLOPE)
            study = talus.Study({"talus_study": 1, "model": str(pathlib.Path(folder, "slope.toml")), "set": {"stage.slide.duration": "20000 s"},
                                 "vary": [{"key": "joint.face.friction_angle", "values": ["10 deg", "15 deg"]}]})
            signal.signal(signal.SIGALRM, lambda *_: signal.raise_signal(signal.SIGINT))
            signal.setitimer(signal.ITIMER_REAL, 1)
            place = pathlib.Path(folder, "stopped")
            with self.assertRaises(KeyboardInterrupt):
                study.run(place, jobs=2)
            left = []
            for process in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
                with contextlib.suppress(OSError):  # it has ended meanwhile
                    left += [process.parent.name] if os.fsencode(place) in process.read_bytes() else []
            self.assertEqual(left, [])


if __name__ == "__main__":
    unittest.main()
