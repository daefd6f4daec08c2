#!/bin/sh
# Builds the programs and packs them: Debian packages, in build/release/packages.
set -eu
cd "$(dirname "$0")/.."
. scripts/packages.sh

# shellcheck disable=SC2086 # the lists are meant to be split
ensure_packages $packages_build $packages_drivers $packages_flow $packages_grid $packages_dtmri $packages_cardiac \
  $packages_workbench $packages_python dpkg-dev gzip cmark-gfm
# shellcheck disable=SC2086
configure release $apps
say "Building the programs"
# shellcheck disable=SC2086
cmake --build build/release --target $apps palpate palpate_python
say "Packing"
(cd build/release && rm -rf packages && cpack -G DEB -B packages && rm -rf packages/_CPack_Packages)
ls -l build/release/packages
