#!/usr/bin/env bash
# What is too slow for every change: all tests, whether they notice small faults, the kernels with their index checks on, and the
# demo from a fresh environment.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

environment=.venv-nightly
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
rm -rf "$environment"
python3 -m venv "$environment"
"$environment/bin/pip" install --quiet '.[test]'

echo "== all tests"
"$environment/bin/pytest" -n auto --dist worksteal -m "slow or not slow" --hypothesis-profile=nightly --durations=20

echo "== small faults planted in the code"
"$environment/bin/python" scripts/checks/plant_faults.py --count 60 --minutes 240 --output "$scratch/faults.jsonl"

# numba reads past the end of an array without a word unless asked; machine code with the checks in it is kept apart.
echo "== kernels with index checks"
NUMBA_BOUNDSCHECK=1 WATCHSIM_CACHE="$scratch/checked" "$environment/bin/pytest" tests/candidates tests/contact tests/dynamics tests/simulation

echo "== an hour of each lever, a locked day, and the other method"
mkdir -p "$scratch/images" "$scratch/reports"
"$environment/bin/python" scripts/reports/measure_long_runs.py --page "$scratch/reports/long-runs.md"
"$environment/bin/python" scripts/reports/study_convergence.py --quick --page "$scratch/reports/convergence.md"
cat "$scratch/reports/long-runs.md" "$scratch/reports/convergence.md"

echo "== kinks, orientations, curves of many arcs"
"$environment/bin/python" scripts/reports/ordinary/measure_ordinary_mechanisms.py --page "$scratch/ordinary-mechanisms.md"
cat "$scratch/ordinary-mechanisms.md"

echo "== random mechanisms, others every night"
"$environment/bin/python" scripts/hunt/hunt_mechanisms.py --seed "$(date +%Y%m%d)" --count 1000 --jobs "$(nproc)"
echo "== killed, interrupted, damaged, out of room"
for signal in KILL INT TERM; do "$environment/bin/python" scripts/fuzz/stops.py --signal "$signal" --count 70; done
"$environment/bin/python" scripts/fuzz/disk.py
"$environment/bin/python" scripts/fuzz/scenes.py --count 2000
"$environment/bin/python" scripts/fuzz/results.py --count 500

echo "== benchmarks and demo"
"$environment/bin/watchsim" verify --slow
"$environment/bin/python" scripts/checks/measure_grid.py "$scratch/grid.csv"
"$environment/bin/watchsim" demo -o "$scratch/demo"
