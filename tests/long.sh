# Sourced by test.sh: what is too long for every day, in parts of less than half an hour each.
#
# A part is a line of this table, NAME | WHAT | COMMAND (of the release build; exit 0: passed), or the cases of a doctest
# suite "long: NAME" (one word) in any test program: TEST_SUITE("long: NAME") around them is all it takes, tests/main.cpp leaves
# such suites out unless they are asked for.
long_table="
sliding_blocks | a block slides over blocks whose joints slant, on level ground, a slope and a wall, as a point mass does | tests/families/sliding_blocks.py build/release/app/talus
tunnels | random tunnels in elastic joints end in equilibrium, or name what is loose | tests/families/tunnels.py build/release/app/talus
hard_steps | the first step of each of 100 random models that sweeps alone do not solve is solved by the chain of solvers | tests/families/hard_steps.py build/release/app/talus
schema_walk | every key of the model file with nineteen values that nobody means: a plain word, no signal, nothing that is not finite | tests/families/schema_walk.py build/release/app/talus
sliding | joints slide at their strength, whatever the mesh | build/release/studies/sliding_joints
includes | every file compiled by itself, all warnings | cmake -S . -B build/long/includes -G Ninja -DCMAKE_BUILD_TYPE=Release -DTALUS_STUDIES=OFF -DTALUS_REPORT=OFF && cmake --build build/long/includes
sanitized | under the sanitizers what the daily tests leave out there: verification, Python, suites "optimised" | tests/sanitized.sh
slurm | a study on a Slurm of two nodes, one of which dies (root, Debian's slurmctld, slurmd, slurm-client, munge; else skipped) | tests/slurm/two_nodes.sh build/release
"

long_suites() { grep -rhoE 'TEST_SUITE\("long: [^" ]+"\)|test_suite\("long: [^" ]+"\)' tests --include='*.cpp' | sed 's/.*long: \([^"]*\)".*/\1/' | sort -u; }
long_rows() { printf '%s\n' "$long_table" | sed 's/ *| */|/g; /^$/d'; }
long_parts() { { long_rows | cut -d'|' -f1; long_suites; } | sort -u; }

# long_known [NAME]: whether there is that part; says which there are if not.
long_known() {
  [ -z "$1" ] || long_parts | grep -qxF -- "$1" && return 0
  echo "no part \"$1\"; there are:"
  long_parts | sed 's/^/  /'
  return 1
}

long_commands() {
  local name what command program
  while IFS='|' read -r name what command; do
    [ "$name" != "$1" ] || echo "$command"
  done < <(long_rows)
  long_suites | grep -qxF -- "$1" || return 0
  for program in unit verification command; do
    echo "build/release/tests/$program --no-version --test-suite='long: $1'"
  done
}

# long_run [NAME]: one part or all, the minutes of each; fails when one has failed or takes more than half an hour.
long_run() {
  local part command begun left failed="" log
  mkdir -p build/long
  for part in ${1:-$(long_parts)}; do
    begun=$SECONDS log=build/long/$part.log
    : >"$log"
    while IFS= read -r command; do
      left=$((1800 - SECONDS + begun))
      timeout $((left > 0 ? left : 1)) bash -c "$command" </dev/null >>"$log" 2>&1 || {
        [ $? != 124 ] || echo "stopped: more than half an hour" >>"$log"
        case " $failed " in *" $part "*) ;; *) failed="$failed $part" ;; esac
      }
    done < <(long_commands "$part")
    if long_suites | grep -qxF -- "$part" && ! grep -qE '^\[doctest\] test cases: +[1-9]' "$log"; then
      echo "no case of the suite was run" >>"$log"
      failed="$failed $part"
    fi
    case " $failed " in *" $part "*) tail -40 "$log" ;; esac
    awk -v part="$part" -v s=$((SECONDS - begun)) -v log_file="$log" 'BEGIN { printf "long: %s: %.1f minutes, log in %s\n", part, s / 60, log_file }'
  done
  [ -z "$failed" ] || { echo "failed:$failed"; return 1; }
}
