#!/bin/bash
# Time of cutting against the number of blocks, interleaved over the sizes, medians of five, and a chart beside N log N.
# Usage: benchmarks/cut_time.sh build/release out/cut_time
set -eu
build=$1 out=$2
mkdir -p "$out"
spacings="9 6 3 2 1.34 0.95 0.67 0.3"
: > "$out/all.csv"
for round in 1 2 3 4 5; do
  for s in $spacings; do "$build/benchmarks/cut_time" "$s" >> "$out/all.csv"; done
done
python3 - "$out" <<'PY'
import math, statistics, sys
out = sys.argv[1]
rows = {}
for line in open(f"{out}/all.csv"):
    spacing, blocks, cpu, wall, memory = (float(v) for v in line.split(","))
    rows.setdefault(int(blocks), []).append((cpu, wall, memory))
med = {n: [statistics.median(v[i] for v in r) for i in range(3)] for n, r in sorted(rows.items())}
first = next(n for n in med if n > 4000)
with open(f"{out}/cut_time.csv", "w") as f:
    f.write("blocks,processor time [s],wall time [s],peak memory [MB],N log N from %d blocks [s]\n" % first)
    for n, (cpu, wall, memory) in med.items():
        line = med[first][0] * n * math.log(n) / (first * math.log(first))
        f.write(f"{n},{cpu:.4g},{wall:.4g},{memory:.4g},{line:.4g}\n")
        print(f"| {n:,} | {cpu:.3g} | {1e6 * cpu / n:.3g} | {cpu / line:.2f} | {memory:.0f} |")
PY
"$build/benchmarks/cut_time" --chart "$out/cut_time.csv" "$out/cut_time"
