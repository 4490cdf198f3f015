#!/bin/bash
# A block that should stick, 30 s at 63 % of its friction, with steps of 1e-3, 1e-4 and 1e-5 s: prints the slip in metres.
# Takes about two minutes. Usage: studies/stick_drift.sh build/release out/stick_drift
set -eu
talus=$1/app/talus out=$2 model=$(dirname "$0")/../examples/creeping_block/creeping_block.toml
for dt in 1e-3 1e-4 1e-5; do
  "$talus" run "$model" -o "$out/$dt" --force -q --set 'contact={joint="face"}' --set stage.stand.duration=30 --set stage.stand.time_step=$dt \
    --set output.history_interval=1 --set output.steps_interval=1
  echo "dt = $dt s: slip after 30 s $(tail -1 "$out/$dt/histories.csv" | cut -d, -f2) m"
done
