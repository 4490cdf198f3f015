# %% [markdown]
# # How much friction does the slope need?
#
# A bedded rock slope under an earthquake, run for several friction angles of its bedding: a study. Its runs are processes of the program talus, several
# side by side; runs that are done are kept, and the same call goes on where it was stopped.

# %%
import pathlib

import matplotlib

matplotlib.use("Agg")  # figures go to files; leave it out in a notebook
import matplotlib.pyplot as pyplot
import numpy
import talus

OUT = pathlib.Path("out/notebooks/slope_study")
OUT.mkdir(parents=True, exist_ok=True)
MODEL = "examples/many_runs/slope.toml"
motion = str(pathlib.Path("examples/record/motion.csv").resolve())
model = talus.Model(MODEL, {"variables.motion": motion})
print(model.check())

# %%
study = talus.Study({
    "talus_study": 1,
    "title": "Bedded slope: friction of the bedding",
    "model": MODEL,
    "set": {"variables.motion": motion, "stage.earthquake.duration": "2 s"},
    # Of the slope, not of one joint: the largest slip of all joints is that of its smallest sliver, which differs with every step size.
    "answers": {"crest": {"formula": "sqrt(crest.displacement_x.residual^2 + crest.displacement_y.residual^2)", "unit": "m"}},
    "vary": [{"key": "variables.phi", "name": "phi", "values": ["27 deg", "30 deg", "33 deg", "36 deg"]}],
})
print(study.dry_run())
found = study.run(OUT / "study")
found.table

# %% [markdown]
# ## What came out
#
# The table has a column for what varies and one for each answer.

# %%
table = found.table
phi, crest = table["phi [deg]"], table["crest [m]"]
for angle, way in zip(phi, crest):
    print(f"{angle:.0f} deg: the crest comes to {100 * way:.2f} cm")
assert len(phi) == 4 and all(status == "finished" for status in table["status"])
assert crest[0] > 2 * crest[1] and crest[1] > 2 * crest[2], "more friction, a shorter way"

# %%
worst = found.run(0)
frame = worst.frame()
print(f"{len(frame.polygons)} blocks at {frame.time:g} s; the crest has come to {worst.histories['crest.displacement_x [m]'][-1]:.3f} m")
figure, (left, right) = pyplot.subplots(1, 2, figsize=(11, 4))
left.plot(phi, 100 * crest, "o-")
left.set_xlabel("friction angle of the bedding [deg]"), left.set_ylabel("way of the crest [cm]")
frame.plot("displacement", axes=right)
figure.tight_layout()
figure.savefig(OUT / "slope.png", dpi=150)
print(f"{OUT}/slope.png")
