#!/usr/bin/env python3
"""What Python costs a step: no observer, one that does nothing, one that takes a view, one that takes the contacts, and a run that is driven
step by step; in turn, medians of five.

Usage: PYTHONPATH=BUILD_DIR/python benchmarks/python_observer.py
"""
import pathlib
import statistics
import time

import talus

EXAMPLE = pathlib.Path(__file__).resolve().parents[1] / "examples/incline/incline.toml"
OBSERVERS = {"none": None, "empty": lambda now: None, "view": lambda now: now.displacement, "contacts": lambda now: now.contacts}


def driven(model):
    begun = time.perf_counter()
    with model.start() as run:
        while run.advance(steps=1):
            pass
    return time.perf_counter() - begun, run.step


def main():
    model = talus.Model(EXAMPLE, {"stage.slide.duration": "20 s", "joint.face.friction_angle": "31 deg"})
    took = {name: [] for name in (*OBSERVERS, "driven")}
    for _ in range(5):
        for name, observer in OBSERVERS.items():
            result = model.run(observer=observer)
            took[name].append(1e6 * result.wall_seconds / result.steps)
        seconds, steps = driven(model)
        took["driven"].append(1e6 * seconds / steps)
    base = statistics.median(took["none"])
    for name, times in took.items():
        print(f"{name:8} {statistics.median(times):6.2f} us a step, {statistics.median(times) - base:+.2f}")


if __name__ == "__main__":
    main()
