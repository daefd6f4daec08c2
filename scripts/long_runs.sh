#!/bin/sh
# scripts/long_runs.sh [LINES [STEPS]]: exact lines of random affine fields against their closed form, and steps of every
# constraint by made hands. 10^7 lines (an hour or two) and 10^6 steps a constraint, unless told otherwise. Fails where one
# of them is off by more than ten times what it states, or breaks a promise of the hand.
set -eu
cd "$(dirname "$0")/.."
lines=${1:-10000000}
steps=${2:-1000000}
cmake --preset release >/dev/null
cmake --build --preset release --target exact_lines_bench constraint_steps_bench
# 20 seeds a field, both ways.
build/release/bench/exact_lines_bench $((lines / 40)) 20
build/release/bench/constraint_steps_bench "$steps"
