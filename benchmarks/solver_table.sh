#!/bin/bash
# Time of a step by either solver over the number of blocks, hard masonry and jointed rock with stiffness: the
# table behind solver.method = "auto" (docs/performance.md). Usage: benchmarks/solver_table.sh build/release OUT
set -eu
talus=$1/app/talus out=$2
mkdir -p "$out"
grep -v "^unbalanced" examples/shaken_wall/shaken_wall.toml >"$out/wall.toml"  # its first stage runs as a dynamic one
# run NAME MODEL METHOD OVERRIDES...: appends a line to the table
run() {
  local name=$1 model=$2 method=$3
  shift 3
  rm -rf "$out/run"
  timeout 30 "$talus" run "$model" -o "$out/run" -q --threads 1 --set "solver.method=\"$method\"" --set 'solver.on_failure="continue"' \
    --set solver.tolerance=1e-8 --set solver.limit=1e-8 --set solver.second_solver=false --set solver.max_sweeps=2000 "$@" >/dev/null 2>&1 || true
  python3 - "$out/run" "$name" "$method" <<'PY' | tee -a "$out/solver_table.csv"
import json, sys
s = json.load(open(sys.argv[1] + "/summary.json"))
n = max(1, s["solver"]["contact_solves"])
print(f'{sys.argv[2]},{sys.argv[3]},{s["blocks"]["all"]},{s["contacts"]["contact_points_most"]},'
      f'{1e3 * s["cpu_time [s]"] / n:.4g},{s["solver"]["failed_steps"]},{n},{s["solver"]["contact_error_worst [m]"]:.2g}')
PY
}
echo "scene,method,blocks,contact_points,ms_per_step,failed_steps,steps,worst_error_m" | tee "$out/solver_table.csv"
for size in 1x1 2x1 3x2 6x3 12x5; do
  w=${size%x*} h=${size#*x}
  for method in newton gauss_seidel; do
    run "wall $size" "$out/wall.toml" "$method" --set "region.wall.polygon=[[0,0],[$w,0],[$w,$h],[0,$h]]" \
      --set 'monitor.top.point=[0.25,0.4]' --set 'stage.settle.kind="dynamic"' --set 'stage.settle.duration="60 ms"' \
      --set 'stage.shake.duration="20 ms"'
  done
done
for size in 12x12 20x20; do
  w=${size%x*} h=${size#*x}
  for method in newton gauss_seidel; do
    run "rock $size" examples/settle/settle.toml "$method" --set "region.rock.polygon=[[0,0],[$w,0],[$w,$h],[0,$h]]" \
      --set "block.right.polygon=[[$w,0],[$((w + 10)),0],[$((w + 10)),310],[$w,310]]" \
      --set "block.floor.polygon=[[-10,-10],[$((w + 10)),-10],[$((w + 10)),0],[-10,0]]" --set 'stage.settle.duration="30 ms"'
  done
done
