#!/usr/bin/env python3
# The time that `talus check` foretells beside the time that the run takes, of examples that run for seconds.
# Static stages end when they rest: their steps are those of the run. Usage: benchmarks/foretold.py build/release
import re
import subprocess
import sys
import tempfile
import time

EXAMPLES = ["wall", "settle", "blast_hole", "pile", "hammer", "soil_layer", "shaken_slope", "bolted_tunnel",
            "meshed_tunnel", "shaken_wall"]
UNIT = {"ms": 1e-3, "s": 1.0}

talus = sys.argv[1] + "/app/talus"
print(f"{'example':<14} {'foretold [s]':>12} {'run [s]':>9} {'ratio':>6}")
for name in EXAMPLES:
    model = f"examples/{name}/{name}.toml"
    told = subprocess.run([talus, "check", model], capture_output=True, text=True).stdout
    cost = [float(v) * UNIT[u] for v, u in re.findall(r"\(([0-9.e+-]+) (ms|s) a step\)", told)]
    with tempfile.TemporaryDirectory() as folder:
        begin = time.monotonic()
        subprocess.run([talus, "run", model, "-o", folder + "/out"], capture_output=True)
        taken = time.monotonic() - begin
        summary = open(folder + "/out/summary.json").read()
    steps = [int(n) for n in re.findall(r'"kind": "(?:static|dynamic)"[^}]*?"steps": (\d+)', summary)]
    foretold = sum(c * n for c, n in zip(cost, steps))
    print(f"{name:<14} {foretold:>12.3g} {taken:>9.3g} {foretold / taken:>6.2f}", flush=True)
