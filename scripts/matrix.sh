#!/bin/sh
# What a maintainer runs before a release: each row builds, and runs its tests, in a folder of its own. One line a row
# is printed at the end; the logs lie in build/matrix.
#   scripts/matrix.sh             all rows
#   scripts/matrix.sh gcc clang   those
set -eu
self=$(cd "$(dirname "$0")" && pwd)/$(basename "$0")
cd "$(dirname "$0")/.."
. scripts/packages.sh

rows="gcc clang asan tsan minimal packages"
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
run_clang() {
  cmake -S . -B build/matrix/clang -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON \
    -DPALPATE_WARNINGS_AS_ERRORS=ON -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_C_COMPILER=clang
  cmake --build build/matrix/clang
  tested ctest --test-dir build/matrix/clang -LE "tidy|style" --output-on-failure
}
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
  "run_$PALPATE_MATRIX_ROW"
  exit 0
fi
summary=""
failed=0
for row in $wanted; do
  say "Row $row: build/matrix/$row.log"
  start=$(date +%s)
  # A shell of its own: -e does not hold within a condition.
  if PALPATE_MATRIX_ROW=$row "$self" >"build/matrix/$row.log" 2>&1; then result=passed; else result=FAILED; failed=1; fi
  summary="$summary$(printf '%-10s%-8s%6d s' "$row" "$result" "$(($(date +%s) - start))")
"
done
printf '\n%s, %s\n%s' "$(uname -sm)" "$(. /etc/os-release && echo "$PRETTY_NAME")" "$summary"
exit "$failed"
