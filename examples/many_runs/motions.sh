#!/bin/sh
# Thirty synthetic motions of 5 s for the studies of this folder, into out/motions of the present folder.
# Usage: examples/many_runs/motions.sh [TALUS]
set -eu
talus=${1:-build/release/app/talus}
[ -x "$talus" ] || talus=talus  # one that is installed
for seed in $(seq 1 30); do
  "$talus" record --synthetic --seed "$seed" --pga 3 --duration 5 --rise 0.7 --strong 2.2 --decay 2 --force \
    --out "out/motions/m$(printf %02d "$seed")" > /dev/null
done
echo "out/motions: 30 motions"
