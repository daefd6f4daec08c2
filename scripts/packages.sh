# Debian packages by purpose, and installing those that are missing. Sourced by ./run and ./test.

# What every build needs.
packages_build="g++ cmake ninja-build pkg-config ccache libtbb-dev libglm-dev libeigen3-dev nlohmann-json3-dev
  libnanovdb-dev"
# The explorers: command line, session files, window, drawing.
packages_explorer="libcli11-dev libtomlplusplus-dev libceres-dev libepoxy-dev libegl-dev libegl1 libgl-dev libgl1-mesa-dri
  libglfw3-dev libimgui-dev libstb-dev fonts-dejavu-core"
# The loaders' helper programs.
packages_loaders="libvtk9-dev libteem-dev libnifti2-dev libgdcm-dev libopenvdb-dev zlib1g-dev libzip-dev"
# The drivers of devices: modules that only --device opens.
packages_drivers="libusb-1.0-0-dev libboost-dev"
# The mesher of cardiac.
packages_mesher="libcgal-dev libtet1.5-dev"
# The tests: framework, benchmarks, virtual display, style, the compiler of the sanitizers.
packages_tests="libgtest-dev libbenchmark-dev xvfb xauth clang-format clang-tidy clang libclang-rt-dev
  libumockdev-dev umockdev"

say() { printf '==> %s\n' "$*" >&2; }
fail() { printf '==> %s\n' "$*" >&2; exit 1; }

# ensure_packages NAME…: installs those that are missing, and says so; does nothing where none is.
ensure_packages() {
  missing=""
  for package in "$@"; do
    status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
    [ "$status" = "install ok installed" ] || missing="$missing $package"
  done
  [ -z "$missing" ] && return 0
  command -v apt-get >/dev/null 2>&1 ||
    fail "These packages are missing and there is no apt-get to install them:$missing"
  as_root=""
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null 2>&1 || fail "Run this once as root: apt-get install --no-install-recommends$missing"
    as_root="sudo"
  fi
  say "Installing Debian packages:$missing"
  log=$(mktemp)
  # shellcheck disable=SC2086 # the list is meant to be split
  if ! { $as_root env DEBIAN_FRONTEND=noninteractive apt-get update &&
         $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $missing; } \
       >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    rm -f "$log"
    fail "Installing failed. Its last lines stand above; with a working package source, run this command again."
  fi
  rm -f "$log"
}

# configure PRESET: runs cmake unless the build folder is already configured for this source folder.
# Ninja runs it again by itself when a CMake file changes; newly installed packages ask for a fresh one.
configure() {
  stamp="build/$1/.configured"
  if [ ! -f "$stamp" ] || [ -n "${missing:-}" ]; then
    say "Configuring build/$1"
    cmake --preset "$1" >"build-$1.log" 2>&1 || { tail -n 30 "build-$1.log" >&2; fail "cmake failed; see build-$1.log"; }
    mv "build-$1.log" "build/$1/configure.log"
    touch "$stamp"
  fi
}
