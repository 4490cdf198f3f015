# %% [markdown]
# # A block strikes a bar
#
# The first case of Zhao, Xiao, Chen and Li (2016): the contact force between a rigid striker and a bar of sub-blocks, beside the exact solution of the
# one-dimensional wave equation. Run it from the folder of the project: `/usr/bin/python3 notebooks/bar_impact.py`, or cell by cell in an editor that knows `# %%`.

# %%
import pathlib

import matplotlib

matplotlib.use("Agg")  # figures go to files; leave it out in a notebook
import matplotlib.pyplot as pyplot
import numpy
import talus

OUT = pathlib.Path("out/notebooks/bar_impact")
OUT.mkdir(parents=True, exist_ok=True)
model = talus.Model("examples/impact_bar/impact_bar.toml", {"grid.bar.cells": [40, 1]})
model

# %% [markdown]
# ## The run, with an observer
#
# The observer is called at every step. `now.rows` are the equations of the step: the normal impulse of each contact over the length of the step is the force
# of the striker on the bar. The first of the blocks is the striker or a piece of the bar: names tell.

# %%
striker = model.blocks.index("striker")
dt = model.time_steps[0]
times, force = [], []


def watch(now):
    rows = now.rows
    contact = rows["family"] == 1
    times.append(now.time)
    force.append(rows["impulse_normal"][contact].sum() / dt)


result = model.run(OUT / "run", watch, force=True)
times, force = numpy.array(times), numpy.array(force)
result.stages

# %% [markdown]
# ## Exact
#
# With tau = c t / L and F0 = A sqrt(E rho) v0 the force is F0 exp(-1.5 tau) until the wave comes back at tau = 2, when it jumps by 2 F0; the striker
# leaves at tau = 2.683 with 0.7177 of its velocity, and the impulse is 1.7177 M v0.

# %%
E, RHO, AREA, LENGTH, V0, MASS = 1.0e7, 2700.0, 0.05 * 0.05, 0.5, 1.25, 8000 * 0.075 * 0.075 * 0.05
speed = numpy.sqrt(E / RHO)
f0 = AREA * numpy.sqrt(E * RHO) * V0
tau = times * speed / LENGTH
exact = numpy.where(tau < 2, numpy.exp(-1.5 * tau), numpy.exp(-1.5 * tau) + (2 - 3 * (tau - 2)) * numpy.exp(-1.5 * (tau - 2)))
exact = numpy.where(tau < 2.683, exact, 0) * f0

impulse = force.sum() * dt
rebound = -result.rate[striker, 0]
print(f"impulse {impulse:.4f} N s, exact {1.7177 * MASS * V0:.4f}")
print(f"rebound {rebound:.4f} m/s, exact {0.7177 * V0:.4f}")
assert abs(impulse / (1.7177 * MASS * V0) - 1) < 0.005, "forty sub-blocks: 0.0 %, the table of the example"
assert abs(rebound / (0.7177 * V0) - 1) < 0.005

# %% [markdown]
# ## A figure
#
# The force of a single step is no physical quantity: behind the front it rings. Its mean over 0.2 L/c is the thing to compare.

# %%
window = max(1, round(0.2 * LENGTH / speed / dt))
mean = numpy.convolve(force, numpy.ones(window) / window, mode="same")
given = numpy.abs(numpy.cumsum(force - exact)).max() * dt / impulse
print(f"the impulse given so far is never further than {100 * given:.1f} % of the whole from the exact one")
# the front comes back spread over some n^(-2/3) = 0.09 of L/c by dispersion (docs/theory.md 7.3): a quarter of its jump, 2 F0, over that time
assert given < 0.25 * 2 * f0 * 40 ** (-2 / 3) * LENGTH / speed / impulse

figure, axes = pyplot.subplots()
axes.plot(1e3 * times, force, color="0.8", label="step by step")
axes.plot(1e3 * times, mean, label="mean over 0.2 L/c")
axes.plot(1e3 * times, exact, "k--", label="exact")
axes.set_xlim(0, 30), axes.set_ylim(0, 2.5 * f0)
axes.set_xlabel("t [ms]"), axes.set_ylabel("force [N]"), axes.legend()
figure.savefig(OUT / "force.png", dpi=150)
print(f"{OUT}/force.png")
