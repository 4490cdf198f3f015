#!/usr/bin/env python3
# The time that `talus check` foretells beside the time that the run takes, of examples that run for seconds.
# Usage: benchmarks/foretold.py build/release
import re
import subprocess
import sys
import tempfile
import time

EXAMPLES = ["wall", "settle", "blast_hole", "pile", "hammer", "soil_layer", "shaken_slope", "bolted_tunnel",
            "meshed_tunnel", "shaken_wall"]
UNIT = {"us": 1e-6, "ms": 1e-3, "s": 1.0, "min": 60.0, "h": 3600.0}

talus = sys.argv[1] + "/app/talus"
print(f"{'example':<14} {'foretold [s]':>12} {'run [s]':>9} {'ratio':>6}")
for name in EXAMPLES:
    model = f"examples/{name}/{name}.toml"
    told = subprocess.run([talus, "check", model], capture_output=True, text=True).stdout
    found = re.search(r"time +about ([0-9.]+) (us|ms|s|min|h)(?: ([0-9]+) s)?", told)
    foretold = float(found[1]) * UNIT[found[2]] + float(found[3] or 0)
    with tempfile.TemporaryDirectory() as folder:
        begin = time.monotonic()
        subprocess.run([talus, "run", model, "-o", folder + "/out"], capture_output=True)
        taken = time.monotonic() - begin
    print(f"{name:<14} {foretold:>12.3g} {taken:>9.3g} {foretold / taken:>6.2f}", flush=True)
