#!/bin/sh
# Installs the packages in a bare Debian, starts each program there, and purges them: what a user has who never saw Palpate.
#   scripts/bare_install.sh FOLDER-OF-PACKAGES [SUITE [ROOT]]   SUITE: bookworm, unless another is named; ROOT: build/bare/SUITE
# As root, with debootstrap and the network. ROOT is made by debootstrap once, and is as it was after each run: what differs
# then is a fault. One line a step; at the first that fails it stops. Pictures of the windows lie in ROOT/pictures.
set -eu
[ $# -ge 1 ] || { echo "usage: scripts/bare_install.sh FOLDER-OF-PACKAGES [SUITE [ROOT]]" >&2; exit 2; }
. "$(dirname "$0")/packages.sh"
packages=$(cd "$1" && pwd)
suite=${2:-bookworm}
root=${3:-$(dirname "$0")/../build/bare/$suite}
[ "$(id -u)" -eq 0 ] || fail "bare_install: a chroot is for root"
# Mounts of this run end with it.
[ -n "${PALPATE_BARE:-}" ] || PALPATE_BARE=1 exec unshare --mount --propagation private "$0" "$packages" "$suite" "$root"
command -v debootstrap >/dev/null 2>&1 || fail "bare_install: debootstrap is missing (apt-get install debootstrap)"
if [ ! -x "$root/usr/bin/dpkg" ]; then
  say "A bare $suite in $root"
  mkdir -p "$root"
  debootstrap --variant=minbase "$suite" "$root" >"$root.log" 2>&1 || fail "debootstrap: see $root.log"
fi
root=$(cd "$root" && pwd)
mount -t proc proc "$root/proc"
mount --rbind /dev "$root/dev"
mount -t tmpfs tmpfs "$root/tmp"
cp /etc/resolv.conf "$root/etc/resolv.conf"
mkdir "$root/tmp/packages"
cp "$packages"/*.deb "$root/tmp/packages"

within() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }
apt() { within apt-get -qq -o Dpkg::Use-Pty=0 -y "$@" >"$root/tmp/log" 2>&1 || { tail -n 20 "$root/tmp/log" >&2; fail "apt-get $*"; }; }
# Every file that is no log, list or index of what has been installed, with what is in it; folders by their names.
everything() {
  (cd "$root" && find . -xdev \( -path ./var/log -o -path ./var/lib/dpkg -o -path ./var/lib/apt -o -path ./var/cache/apt \
    -o -path ./var/cache/ldconfig -o -path ./var/cache/man -o -path ./pictures -o -path ./home -o -path ./run \) -prune -o \
    \( -type f -exec sha256sum {} + -o ! -type f -printf '%y  %p %l\n' \) | grep -v ' ./etc/ld.so.cache$' | LC_ALL=C sort)
}

say "What the packages need, and a desktop's tools to start them"
# Updates lie beside what debootstrap took.
sources="$root/etc/apt/sources.list"
grep -q security "$sources" || sed -i -n -E "p; h; s#/debian/? $suite #/debian-security $suite-security #p; g; s# $suite # $suite-updates #p" "$sources"
apt update
# A package with the same needs: what others leave behind when they go is not laid on these.
needs=$(for deb in "$packages"/*.deb; do dpkg-deb -f "$deb" Depends; done | tr ',' '\n' | sed 's/^ *//' |
  grep -v -E '^(lib)?palpate|^$' | LC_ALL=C sort -u | paste -sd, -)
mkdir -p "$root/tmp/needs/DEBIAN"
printf '%s\n' "Package: needs-of-palpate" "Version: 1" "Architecture: all" "Maintainer: nobody <nobody@palpate.example>" \
  "Description: what the packages of Palpate need" "Depends: $needs" >"$root/tmp/needs/DEBIAN/control"
dpkg-deb --root-owner-group -b "$root/tmp/needs" "$root/tmp/needs.deb" >/dev/null
apt install --no-install-recommends /tmp/needs.deb xvfb xauth xdotool xterm libglib2.0-bin shared-mime-info desktop-file-utils \
  hicolor-icon-theme man-db bash-completion
names=$(for deb in "$packages"/*.deb; do dpkg-deb -f "$deb" Package; done)
within dpkg-query -W -f='${Package}\n' | grep -E '^(lib|python3-)?palpate' >"$root/tmp/there" || true
# shellcheck disable=SC2046 # what a run that failed has left
[ ! -s "$root/tmp/there" ] || apt purge $(cat "$root/tmp/there")
within userdel --remove visitor 2>/dev/null || true
within useradd --create-home visitor
everything >"$root/tmp/before"

say "Installing"
within sh -c 'apt-get -qq -o Dpkg::Use-Pty=0 -y install --no-install-recommends /tmp/packages/*.deb' >"$root/tmp/log" 2>&1 ||
  { tail -n 20 "$root/tmp/log" >&2; fail "apt install ./*.deb"; }

# As a user who is not root, whose home is new.
visit() { within su -s /bin/sh - visitor -c "$1"; }
visited() { visit "$1" >"$root/tmp/said" 2>&1 || { cat "$root/tmp/said" >&2; fail "$1"; }; }
for app in $apps; do
  visited "palpate-$app --help && palpate $app --version"
  visited "MANWIDTH=80 man palpate-$app"
  grep -q "^NAME" "$root/tmp/said" || fail "man palpate-$app has no NAME"
  visited "bash -c '. /usr/share/bash-completion/bash_completion && . /usr/share/bash-completion/completions/palpate-$app'"
done
visited "man palpate"
visited "palpate-flow info --example abc && palpate-flow render --example tornado --size 320x240 --out flow.png"
visited "palpate-grid info --example shells && palpate-grid render --example shells --size 320x240 --out grid.png"
visited "palpate-cardiac info --example ventricle && palpate-cardiac render --example ventricle --size 320x240 --out cardiac.png"
visited "palpate-dtmri info --example helix && palpate-dtmri render --example helix --size 320x240 --out dtmri.png"
visited "palpate-workbench example tracker --out poses.csv && palpate-workbench calibrate tracker poses.csv --out workbench.toml"
visited "palpate-grid clip --example shells --box 0,0,0,15,15,15 --out shells.nrrd"
visited "palpate-grid info shells.nrrd && gio info -a standard::content-type shells.nrrd"
grep -q x-nrrd "$root/tmp/said" || fail "the desktop does not know shells.nrrd: $(cat "$root/tmp/said")"
visited "python3 -c 'import palpate; print(palpate.__file__)'"
say "Command lines, manual pages, pictures without a display and kinds of files: in order"

# The window that the desktop entry starts, seen by its name, closed by its key.
mkdir -p "$root/pictures"
for entry in "$root"/usr/share/applications/palpate-*.desktop; do
  name=$(basename "$entry" .desktop)
  [ "$name" = palpate-session ] && continue  # opens files alone
  within desktop-file-validate "/usr/share/applications/$name.desktop" || fail "$name.desktop"
  cat >"$root/tmp/start.sh" <<START
gio launch /usr/share/applications/$name.desktop &
for second in \$(seq 120); do
  sleep 1
  id=\$(xdotool search --onlyvisible --name '.' 2>/dev/null | tail -n 1) && [ -n "\$id" ] && break
done
[ -n "\$id" ] || { echo "no window after 120 s"; exit 1; }
sleep 5
xdotool getwindowname "\$id"
cp "\$FRAMES/Xvfb_screen0" /tmp/frames/$name.xwd
# A program that runs in a terminal goes with it.
if grep -q '^Terminal=true' /usr/share/applications/$name.desktop; then
  xdotool windowkill "\$id"
else
  xdotool windowfocus "\$id" key ctrl+q
fi
for second in \$(seq 60); do
  sleep 1
  pgrep -u visitor -f "bin/$name" >/dev/null || { echo closed; exit 0; }
done
echo "the window does not close"
exit 1
START
  chmod 644 "$root/tmp/start.sh"
  mkdir -p "$root/tmp/frames" && chmod 777 "$root/tmp/frames"
  visited "export FRAMES=/tmp/frames; xvfb-run -a -s '-screen 0 1280x1024x24 -fbdir /tmp/frames' sh /tmp/start.sh"
  python3 "$(dirname "$0")/screen_picture.py" "$root/tmp/frames/$name.xwd" "$root/pictures/$name.png"
  say "$name.desktop opens \"$(head -n 1 "$root/tmp/said")\": $root/pictures/$name.png"
done

say "Purging"
# shellcheck disable=SC2086 # the list is meant to be split
within dpkg -L $names | LC_ALL=C sort -u >"$root/tmp/listed"
# shellcheck disable=SC2086
apt purge $names
everything >"$root/tmp/after"
diff "$root/tmp/before" "$root/tmp/after" >"$root/tmp/left" || { head -n 20 "$root/tmp/left" >&2; fail "purge leaves these, or takes them (< before, > after)"; }
within userdel --remove visitor 2>/dev/null || true
say "Nothing is left of $(wc -l <"$root/tmp/listed") files and folders; bare $suite ($(cat "$root/etc/debian_version")): passed"
