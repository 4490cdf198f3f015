#!/bin/bash
# Runs examples/xianglushan in all its variants with one ground motion, two at a time, and prints their tables.
# A variant whose results are there already is left as it is. About two hours on two cores.
# Usage: studies/tunnel_variants.sh MOTION.csv OUT        (MOTION.csv from `talus record`)
set -eu
[ $# = 2 ] || { sed -n '2,5s/^# //p' "$0"; exit 2; }
motion=$(realpath "$1") out=$(realpath -m "$2")
cd "$(dirname "$0")/.."
model=examples/xianglushan/xianglushan.toml talus=${TALUS:-build/release/app/talus}
mkdir -p "$out"

declare -A keys=(
  [base]=""
  [grouted]="bolt_pattern.ring.use=true"
  [half_step]="stage.shake.time_step='0.45 ms'"
  [superposed]="bolt_pattern.smeared.use=true"
  [k0_1]="in_situ.k0=1"
  [viscous_top]="boundary.top.use=true"
  [incident]="boundary.base.motion=upgoing"
  [cohesion_kept]="joint.natural.residual_cohesion='0.4 MPa'"
  [explicit]="stage.shake.elasticity=explicit|stage.shake.time_step='0.45 ms'|stage.shake.moment_clamp=true"
)
order="base grouted half_step superposed k0_1 viscous_top incident cohesion_kept explicit"

run_one() {
  local name=$1 set=() key
  while IFS= read -r key; do [ -z "$key" ] || set+=(--set "$key"); done < <(tr '|' '\n' <<<"$2")
  [ -e "$out/$name/slips.csv" ] && grep -q '"status": "finished"' "$out/$name/summary.json" && return
  echo "$name: running"
  "$talus" run "$model" -o "$out/$name" --force --threads 1 --set "history.north.file=$motion" "${set[@]}" >"$out/$name.log" 2>&1 ||
    echo "$name: failed, see $out/$name.log"
}

for name in $order; do
  run_one "$name" "${keys[$name]}" &
  while [ "$(jobs -rp | wc -l)" -ge 2 ]; do wait -n; done
done
wait

runs=()
for name in $order; do
  [ ! -e "$out/$name/slips.csv" ] || runs+=("$name=$out/$name")
done
build/release/studies/tunnel_variants "$motion" "${runs[@]}"
