#!/bin/bash
# The seven cases of the paper's figures 8 and 9, and finer bars: runs, table, figures.
# Usage: examples/impact_bar/run.sh BUILD_DIR OUTPUT_DIR
set -eu
talus=$1/app/talus table=$1/examples/impact_bar_table out=$2
model=$(dirname "$0")/impact_bar.toml

# run NAME YOUNG VELOCITY CELLS: the window of the mean force is 0.2 L/c, the duration 3.2 L/c
run() {
  local window duration
  window=$(awk "BEGIN { printf \"%.10g\", 0.2 * 0.5 / sqrt($2 / 2700) }")
  duration=$(awk "BEGIN { printf \"%.10g\", 3.2 * 0.5 / sqrt($2 / 2700) }")
  "$talus" run "$model" -o "$out/$1" --force --quiet --set material.bar.young="$2" --set block.striker.velocity="[$3, 0]" \
    --set grid.bar.cells="[$4, 1]" --set monitor.impact.window="$window" --set stage.impact.duration="$duration" \
    --set output.field_interval="$(awk "BEGIN { print $duration / 50 }")"
}

echo "running $model: seven cases, then finer bars"
run E0.5625e7 0.5625e7 1.25 10
run E1e7 1e7 1.25 10
run E2.25e7 2.25e7 1.25 10
run E9e7 9e7 1.25 10
run v2.5 1e7 2.5 10
run v3.75 1e7 3.75 10
run v5 1e7 5 10
run N20 1e7 1.25 20
run N40 1e7 1.25 40
run N80 1e7 1.25 80

echo
"$table" "$out/E0.5625e7:0.5625e7:1.25" "$out/E1e7:1e7:1.25" "$out/E2.25e7:2.25e7:1.25" "$out/E9e7:9e7:1.25" \
  "$out/v2.5:1e7:2.5" "$out/v3.75:1e7:3.75" "$out/v5:1e7:5" "$out/N20:1e7:1.25" "$out/N40:1e7:1.25" "$out/N80:1e7:1.25"
echo
echo "E..: Young's modulus at 1.25 m/s, v..: velocity at 1e7 Pa, each with 10 sub-blocks; N..: finer bars at 1e7 Pa, 1.25 m/s."
echo "The peak is that of the force as mean over 0.2 L/c, for the reason given in examples/impact_bar/README.md."
echo

column=impact.mean_normal_force
"$talus" plot "$out/E0.5625e7" "$out/E1e7" "$out/E2.25e7" "$out/E9e7" -c $column -o "$out/figure8" --time-unit ms --limit-t 0 32 --limit-y 0 2500 \
  -l "E = 0.56e7 Pa" -l "E = 1.0e7 Pa" -l "E = 2.25e7 Pa" -l "E = 9.0e7 Pa" \
  -r "$out/E0.5625e7/exact.csv" -r "$out/E1e7/exact.csv" -r "$out/E2.25e7/exact.csv" -r "$out/E9e7/exact.csv" \
  --title "Contact force for four moduli (10 sub-blocks, mean over 0.2 L/c)"
"$talus" plot "$out/E1e7" "$out/v2.5" "$out/v3.75" "$out/v5" -c $column -o "$out/figure9" --time-unit ms --limit-t 0 26 --limit-y 0 3300 \
  -l "v = 1.25 m/s" -l "v = 2.5 m/s" -l "v = 3.75 m/s" -l "v = 5.0 m/s" \
  -r "$out/E1e7/exact.csv" -r "$out/v2.5/exact.csv" -r "$out/v3.75/exact.csv" -r "$out/v5/exact.csv" \
  --title "Contact force for four velocities (10 sub-blocks, mean over 0.2 L/c)"
"$talus" plot "$out/E1e7" "$out/N20" "$out/N40" "$out/N80" -c $column -o "$out/refinement" --time-unit ms --limit-t 0 26 --limit-y 0 850 \
  -l "10 sub-blocks" -l "20" -l "40" -l "80" -r "$out/E1e7/exact.csv" \
  --title "Contact force for finer bars (E = 1e7 Pa, v = 1.25 m/s, mean over 0.2 L/c)"
"$talus" report "$out/E1e7" "$out/N80" -o "$out/report.html" || true   # there is no page where npm was missing
