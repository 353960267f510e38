#!/usr/bin/env bash
# What is too slow for every change: all tests, whether they notice small faults, the kernels with their index checks on, and the
# demo from a fresh environment. Every step is run, whatever became of those before; the exit status is 1 if one failed.
set -euo pipefail
[[ ${1:-} != -h && ${1:-} != --help ]] || { sed -n '2,/^set/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit; }
cd "$(dirname "${BASH_SOURCE[0]}")/.."

environment=.venv-nightly
scratch=$(mktemp -d)
failed=()
trap 'rm -rf "$scratch"' EXIT
trap 'exit 130' INT # a step may take Ctrl-C for its own end: the next one would begin

step() { # step NAME COMMAND...: run it, say how long it took, and remember it if it fails
    local name=$1 start=$SECONDS
    shift
    printf '== %s\n' "$name"
    "$@" || failed+=("$name (status $?)")
    printf '== %s: %d s\n\n' "$name" $((SECONDS - start))
}

rm -rf "$environment"
python3 -m venv "$environment"
"$environment/bin/pip" install --quiet '.[test,browser,docs]'
PATH=$PWD/$environment/bin:$PATH

step "all tests" pytest -n auto --dist worksteal -m "slow or not slow" --hypothesis-profile=nightly --durations=20 -rs

step "small faults planted in the code" \
    python scripts/planted/plant_faults.py --count 60 --minutes 240 --output "$scratch/faults.jsonl"

# numba reads past the end of an array without a word unless asked; machine code with the checks in it is kept apart.
step "kernels with index checks" env NUMBA_BOUNDSCHECK=1 WATCHSIM_CACHE="$scratch/checked" \
    pytest tests/candidates tests/contact tests/dynamics tests/simulation

mkdir -p "$scratch/images" "$scratch/reports"
step "an hour of each lever, a locked day" python scripts/reports/long_runs.py --page "$scratch/reports/long-runs.md"
step "the other method" python scripts/reports/convergence.py --quick --page "$scratch/reports/convergence.md"
step "kinks, orientations, curves of many arcs" \
    python scripts/reports/ordinary.py --page "$scratch/reports/ordinary-mechanisms.md"
step "the pages of these" cat "$scratch"/reports/{long-runs,convergence,ordinary-mechanisms}.md

step "random mechanisms, others every night" \
    python scripts/hunt/hunt_mechanisms.py --seed "$(date +%Y%m%d)" --count 1000 --jobs "$(nproc)"
step "what is concluded of random oscillators" python scripts/hunt/hunt_conclusions.py --seed "$(date +%Y%m%d)" --count 200
for signal in KILL INT TERM; do
    step "commands at random moments: $signal" python scripts/fuzz/stops.py --signal "$signal" --count 70
done
step "a disk that fails" python scripts/fuzz/disk.py
step "damaged scenes" python scripts/fuzz/scenes.py --count 2000
step "oiled mechanisms" python scripts/fuzz/oiled.py --count 300
step "damaged results" python scripts/fuzz/results.py --count 500

step "benchmarks" watchsim verify --slow
step "restitution and friction from 0 to 1" python scripts/reports/stability.py grid "$scratch/grid.csv"
step "the site" python scripts/make_site.py
step "demo" watchsim demo -o "$scratch/demo"

[ ${#failed[@]} -eq 0 ] || { printf 'Failed: %s\n' "${failed[@]}"; exit 1; }
printf 'All passed in %d s.\n' "$SECONDS"
