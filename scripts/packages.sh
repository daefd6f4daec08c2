# Debian packages by purpose, installing those that are missing, and configuring. Sourced by ./run and ./test.

# What every build needs: compiler, mathematics, command line, session files, window, drawing.
packages_build="g++ cmake ninja-build pkg-config ccache libtbb-dev libglm-dev libeigen3-dev nlohmann-json3-dev
  libnanovdb-dev zlib1g-dev libcli11-dev libtomlplusplus-dev libepoxy-dev libegl-dev libegl1 libgl-dev
  libgl1-mesa-dri libglfw3-dev libimgui-dev libstb-dev libboost-dev fonts-dejavu-core"
# The drivers of devices: modules that only --device opens.
packages_drivers="libusb-1.0-0-dev"
# What one program needs besides: the libraries of its helper programs. loaders/ has a folder for each.
packages_flow="libvtk9-dev libhdf5-dev libxdmf-dev libteem-dev libopenvdb-dev"
packages_grid="libvtk9-dev libhdf5-dev libxdmf-dev libteem-dev libopenvdb-dev libnifti2-dev libgdcm-dev"
packages_dtmri="libvtk9-dev libteem-dev libnifti2-dev libgdcm-dev libzip-dev"
packages_cardiac="libvtk9-dev libcgal-dev libtet1.5-dev"
packages_workbench="libceres-dev"
# The Python module.
packages_python="pybind11-dev python3-dev python3-numpy"
# The tests: framework, benchmarks, virtual display, its mouse and keyboard, style, the compiler of the sanitizers.
packages_tests="libgtest-dev libbenchmark-dev xvfb xauth clang-format clang-tidy clang lld libclang-rt-dev
  libumockdev-dev umockdev mypy xdotool libopenigtlink-dev"

apps="cardiac dtmri flow grid workbench"

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

# configure PRESET APP…: runs cmake, unless the build folder is already configured for this source folder and these
# programs. Programs that it was configured for before stay. Ninja runs cmake again by itself when a CMake file
# changes; newly installed packages ask for a fresh run.
configure() {
  preset=$1
  shift
  stamp="build/$preset/.configured"
  known=""
  [ -f "build/$preset/CMakeCache.txt" ] &&
    known=$(sed -n 's/^PALPATE_APPS:[A-Z]*=//p' "build/$preset/CMakeCache.txt" | tr ';' ' ')
  wanted=$known
  for name in "$@"; do
    case " $wanted " in
      *" $name "*) ;;
      *) wanted="$wanted $name" ;;
    esac
  done
  if [ ! -f "$stamp" ] || [ "$wanted" != "$known" ] || [ -n "${missing:-}" ]; then
    say "Configuring build/$preset"
    list=$(printf '%s' "$wanted" | tr -s ' ' ';' | sed 's/^;//')
    cmake --preset "$preset" -DPALPATE_APPS="$list" >"build-$preset.log" 2>&1 || {
      tail -n 30 "build-$preset.log" >&2
      fail "cmake failed; see build-$preset.log"
    }
    mv "build-$preset.log" "build/$preset/configure.log"
    touch "$stamp"
  fi
}
