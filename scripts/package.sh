#!/bin/sh
# Builds the programs and packs them: Debian packages, in build/PRESET/packages.
#   scripts/package.sh [PRESET]    a preset of CMakePresets.json: release, unless another is named
set -eu
cd "$(dirname "$0")/.."
. scripts/packages.sh
preset=${1:-release}

# shellcheck disable=SC2086 # the lists are meant to be split
ensure_packages $packages_build $packages_drivers $packages_flow $packages_grid $packages_dtmri $packages_cardiac \
  $packages_workbench $packages_python dpkg-dev gzip cmark-gfm
# shellcheck disable=SC2086
configure "$preset" $apps
say "Building the programs"
# shellcheck disable=SC2086
cmake --build "build/$preset" --target $apps palpate palpate_python
say "Packing"
(cd "build/$preset" && rm -rf packages && cpack -G DEB -B packages && rm -rf packages/_CPack_Packages)
ls -l "build/$preset/packages"
