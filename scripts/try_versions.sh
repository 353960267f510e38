#!/usr/bin/env bash
# Do the demo and the short tests pass with every Python that is here, with the lowest and the newest dependencies?
#
#   scripts/try_versions.sh [PYTHON[=lowest|=newest] ...]     default: python3.10 to python3.14, those that are found
#
# Lowest: the versions that pyproject.toml names, or the oldest that have wheels for that Python. A combination without wheels is
# reported as left out, not as failed.
set -euo pipefail
[[ ${1:-} != -h && ${1:-} != --help ]] || { sed -n '2,/^set/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit; }
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
interpreters=("$@")
[ $# -gt 0 ] || interpreters=(python3.10 python3.11 python3.12 python3.13 python3.14)
tests=(tests/storage tests/commands tests/test_package.py tests/test_stopping.py tests/test_cache_files.py tests/results/test_results.py)
failed=0

try() { # interpreter, word, constraints
    local place="$scratch/$(basename "$1")-$2"
    "$1" -m venv "$place"
    if ! "$place/bin/pip" install --quiet --only-binary :all: -c "$3" '.[test]' >"$place.log" 2>&1; then
        echo "$1 $2: left out, no wheels: $(grep -m1 ERROR "$place.log")"
        return
    fi
    if WATCHSIM_CACHE="$place/cache" "$place/bin/watchsim" demo -o "$place/demo" >"$place.log" 2>&1 &&
        WATCHSIM_CACHE="$place/cache" "$place/bin/pytest" -q "${tests[@]}" >>"$place.log" 2>&1; then
        echo "$1 $2: fine; $(tail -1 "$place.log")"
    else
        echo "$1 $2: FAILED"
        tail -20 "$place.log"
        failed=1
    fi
}

: >"$scratch/newest"
sed -n '/^dependencies = \[/,/^\]/s/^ *"\([A-Za-z0-9_-]*\)>=\([0-9.]*\).*/\1==\2.*/p' pyproject.toml >"$scratch/lowest"
for wanted in "${interpreters[@]}"; do
    interpreter=${wanted%%=*}
    if ! command -v "$interpreter" >/dev/null; then
        echo "$interpreter: not here"
        continue
    fi
    for which in lowest newest; do
        case $wanted in *=*) [ "${wanted#*=}" = "$which" ] || continue ;; esac
        try "$interpreter" "$which" "$scratch/$which"
    done
done
exit "$failed"
