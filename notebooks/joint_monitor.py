# %% [markdown]
# # A joint monitor of one's own
#
# talus records monitors that the model names. What nobody has thought of is an observer: here the share of its strength that a joint between two blocks
# uses, and the point where its force acts, step by step. The block is pulled until it slides.

# %%
import pathlib

import matplotlib

matplotlib.use("Agg")  # figures go to files; leave it out in a notebook
import matplotlib.pyplot as pyplot
import numpy
import talus

OUT = pathlib.Path("out/notebooks/joint_monitor")
OUT.mkdir(parents=True, exist_ok=True)
FRICTION = 30.0
model = talus.Model.from_dict({
    "talus": 1,
    "title": "A block that is pulled",
    "model": {"gravity": [0, -9.81]},
    "material": {"rock": {"density": 2600.0}},
    "joint": {"face": {"friction_angle": f"{FRICTION} deg", "normal_stiffness": "2 GPa/m", "shear_stiffness": "2 GPa/m"}},
    "contact": {"joint": "face"},
    "block": [
        {"name": "table", "polygon": [[-1, -1], [4, -1], [4, 0], [-1, 0]], "material": "rock", "kind": "fixed"},
        {"name": "block", "polygon": [[0, 0], [2, 0], [2, 1], [0, 1]], "material": "rock", "kind": "rigid"},
    ],
    "history": {"pull": {"time": ["0 s", "2 s"], "value": [0.0, 8.0]}},
    "load": [{"name": "pull", "acceleration_x": "pull"}],
    "stage": [{"name": "pull", "kind": "dynamic", "duration": "2 s", "time_step": "1 ms"}],
})
model


# %%
class JointMonitor:
    """Of the contact between two blocks: resultant [N], where it acts [m], and the share of the friction that it uses."""

    def __init__(self, model, first, second, friction_angle):
        self.pair = {model.blocks.index(first), model.blocks.index(second)}
        self.tan = numpy.tan(numpy.radians(friction_angle))
        self.rows = []

    def __call__(self, now):
        points = now.points
        mine = points[[{a, b} == self.pair for a, b in zip(points["block_a"], points["block_b"])]]
        normal, shear = mine["normal"].sum(), mine["shear"].sum()
        if normal > 0:
            place = (mine["normal"] * mine["x"]).sum() / normal
            self.rows.append((now.time, normal, shear, place, abs(shear) / (self.tan * normal)))


monitor = JointMonitor(model, "table", "block", FRICTION)
with model.start(observer=monitor) as run:
    while run.advance(steps=100):
        time, normal, shear, place, used = monitor.rows[-1]
        if round(run.step) % 400 == 0:
            print(f"t = {time:.2f} s: {used:6.1%} of the friction is used, the force acts at x = {place:.3f} m")
time, normal, shear, place, used = numpy.array(monitor.rows).T

# %% [markdown]
# ## Is it right?
#
# The pull grows by 4 m/s2 a second: the block slides when it reaches g tan(30 deg), at 1.416 s. Until then the moment about the base moves the force by
# half the height times the pull over g.

# %%
WEIGHT = 2 * 1 * 2600 * 9.81
slides = time[numpy.argmax(used > 1 - 1e-9)]
print(f"slides from {slides:.3f} s, exact {9.81 * monitor.tan / 4:.3f} s")
assert abs(slides - 9.81 * monitor.tan / 4) < 0.02
assert abs(normal / WEIGHT - 1)[time > 0.2].max() < 0.02
during = (time > 0.2) & (time < 1.3)
moved = place - 1
assert numpy.abs(moved - 0.5 * 4 * time / 9.81)[during].max() < 0.02

figure, axes = pyplot.subplots()
axes.plot(time, used)
axes.axvline(9.81 * monitor.tan / 4, color="k", linestyle="--", label="slides, exact")
axes.set_xlabel("t [s]"), axes.set_ylabel("share of the friction used"), axes.legend()
figure.savefig(OUT / "friction.png", dpi=150)
print(f"{OUT}/friction.png")
