#!/bin/sh
# What a maintainer runs before a release: each row builds, and runs its tests, in a folder of its own. One line a row
# is printed at the end; the logs lie in build/matrix.
#   scripts/matrix.sh             all rows
#   scripts/matrix.sh gcc clang   those
set -eu
self=$(cd "$(dirname "$0")" && pwd)/$(basename "$0")
cd "$(dirname "$0")/.."
. scripts/packages.sh

rows="gcc clang clang-newest asan tsan minimal packages"
wanted=${*:-$rows}
for row in $wanted; do
  case " $rows " in
    *" $row "*) ;;
    *) fail "There is no row \"$row\"; rows are: $rows" ;;
  esac
done

# Under a virtual display where there is none.
tested() {
  if [ -n "${DISPLAY:-}" ]; then "$@"; else xvfb-run -a -s "-screen 0 1280x1024x24" "$@"; fi
}

run_gcc() { ./test; }
# built_by_clang ROW SUFFIX: everything, by clang++SUFFIX.
built_by_clang() {
  cmake -S . -B "build/matrix/$1" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON \
    -DPALPATE_WARNINGS_AS_ERRORS=ON -DCMAKE_CXX_COMPILER="clang++$2" -DCMAKE_C_COMPILER="clang$2"
  cmake --build "build/matrix/$1"
  tested ctest --test-dir "build/matrix/$1" -LE "tidy|style" --output-on-failure
}
run_clang() { built_by_clang clang ""; }
# The newest one that is packaged for the system: clang-19 in Debian 12 (apt-get install clang-19).
newest_clang() {
  for version in 21 20 19 18 17 16 15; do
    if command -v "clang++-$version" >/dev/null 2>&1; then echo "$version"; return; fi
  done
}
run_clang_newest() { built_by_clang clang-newest "-$(newest_clang)"; }
run_asan() {
  cmake --preset asan && cmake --build build/asan --target fast_tests
  tested ctest --preset asan
}
run_tsan() {
  cmake --preset tsan && cmake --build build/tsan --target fast_tests
  tested ctest --preset tsan
}
# Each program alone: none may need what only another brings.
run_minimal() {
  for app in $apps; do
    cmake -S . -B "build/matrix/$app" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DPALPATE_APPS="$app"
    cmake --build "build/matrix/$app"
    "build/matrix/$app/bin/$app" --version
  done
}
# Packages, and what Debian's checker says of them.
run_packages() {
  scripts/package.sh
  if command -v lintian >/dev/null 2>&1; then
    lintian --fail-on error build/release/packages/*.deb
  else
    say "lintian is not installed: the packages are not checked"
  fi
}

mkdir -p build/matrix
if [ -n "${PALPATE_MATRIX_ROW:-}" ]; then
  "run_$(echo "$PALPATE_MATRIX_ROW" | tr - _)"
  exit 0
fi
summary=""
failed=0
for row in $wanted; do
  if [ "$row" = clang-newest ] && [ -z "$(newest_clang)" ]; then
    summary="$summary$(printf '%-14s%s' "$row" "left out: no clang++-19 is installed")
"
    continue
  fi
  say "Row $row: build/matrix/$row.log"
  start=$(date +%s)
  # A shell of its own: -e does not hold within a condition.
  if PALPATE_MATRIX_ROW=$row "$self" >"build/matrix/$row.log" 2>&1; then result=passed; else result=FAILED; failed=1; fi
  summary="$summary$(printf '%-14s%-8s%6d s' "$row" "$result" "$(($(date +%s) - start))")
"
done
printf '\n%s, %s\n%s' "$(uname -sm)" "$(. /etc/os-release && echo "$PRETTY_NAME")" "$summary"
exit "$failed"
