#!/bin/sh
# Makes the pictures of the pages again, by the programs: scripts/pictures.sh BIN DATA [PICTURE …]
# BIN has the programs (build/check/bin), DATA the sample data (../shared/data). Without names, all. One line a
# picture; each is put into docs/ once it is whole. Look at each before it is committed. Needs xvfb and python3 for the
# window. It does not make the pictures of the study (docs/guide/study_*.png): these are of windows with a participant.
set -eu
[ $# -ge 2 ] || { echo "usage: scripts/pictures.sh BIN DATA [PICTURE ...]" >&2; exit 2; }
bin=$(cd "$1" && pwd)
data=$(cd "$2" && pwd)
shift 2
wanted=$*
root=$(cd "$(dirname "$0")/.." && pwd)
made=$(mktemp -d)
trap 'rm -rf "$made"' EXIT
cd "$made"
# By their own names, so that the commands in the pictures' text are what a reader would type.
find "$data" -type f -exec ln -s {} . \; 2>/dev/null || true
export XDG_CONFIG_HOME="$made" XDG_CACHE_HOME="$made" XDG_STATE_HOME="$made"

# picture FILE PROGRAM ARGUMENTS…: a picture that a program writes, FILE below docs/.
picture() {
  file=$1
  program=$2
  shift 2
  case " ${wanted:-$file} " in *" $file "*) ;; *) return 0 ;; esac
  "$bin/$program" "$@" --out "$(basename "$file")" -q
  mv "$(basename "$file")" "$root/docs/$file"
  echo "docs/$file"
}

# window FILE SECONDS PROGRAM ARGUMENTS…: the window, panel included, after so many seconds.
window() {
  file=$1
  seconds=$2
  program=$3
  shift 3
  case " ${wanted:-$file} " in *" $file "*) ;; *) return 0 ;; esac
  # shellcheck disable=SC2016
  xvfb-run -a -s "-screen 0 1280x800x24 -fbdir $made" sh -c '
    seconds=$1; shift
    "$@" & program=$!
    sleep "$seconds"
    python3 "'"$root"'/scripts/screen_picture.py" Xvfb_screen0 screen.png
    kill "$program" || { echo "the program has ended before its picture" >&2; exit 1; }
    wait "$program" || true' sh "$seconds" "$bin/$program" "$@" >window.log 2>&1 || { cat window.log >&2; exit 1; }
  mv screen.png "$root/docs/$file"
  echo "docs/$file"
}

# A hand that follows a streamline of the carotid upstream, leaves it by two voxels, and rests: data units, seconds. In the
# window it rests for a minute, since a hand that says nothing for longer than 50 ms counts as gone.
"$bin/flow" trace carotid.vtk --seeds point:148.246,103.522,10 --direction backward --out line.csv -q
awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; print "t,x,y,z"; next }
  $at["arc"] < 16 {
    printf "%.3f,%s,%s,%.6f\n", 0.01 * n++, $at["x"], $at["y"], $at["z"] + 2 * $at["arc"] / 16 }' line.csv >path.csv
awk -F, '{ print; t = $1; rest = $2 "," $3 "," $4 }
  END { while (t < 60) printf "%.3f,%s\n", t += 0.01, rest }' path.csv >held.csv

window window.png 20 flow carotid.vtk --device replay:held.csv --camera 200,20,0,1.3
picture followed.png flow render carotid.vtk --path path.csv --camera 200,20,0,1.35 --force --size 1280x960
picture flow_volume.png flow render bluntfinxyz.bin --solution bluntfinq.bin --volume Density --resample 128 --seeds line:-4,0.5,0,-4,0.5,4,28 --lens sphere:0,0,2,0.9,tf=boundaries --camera 20,15,0,1.8 --size 800x600
picture tooth.png grid render tooth.nhdr --camera 25,10,0,1.2 --size 900x620
picture wall.png cardiac render --example ventricle --layer 0.5 --walls both --cut 0,1,0,0 --camera 180,25,0,1.3 --size 960x720
picture two_hearts.png cardiac render --example ventricle --layer 0.5 --cut 0,1,0,0 --compare-angle depth --camera 180,25,0,1.2 --size 1200x480
picture heart.png cardiac render heart.exelem.gz --layer 0.5 --camera 200,10,0,1.3 --size 960x720
picture head.png dtmri render 3000_DTI_PA-ortho_cl.nii.gz --camera 20,40,0,1.5 --size 960x720
picture lens.png dtmri render 3000_DTI_PA-ortho_cl.nii.gz --volume fa --lens sphere:0,0,20,45 --slices none --camera 20,50,0,1.5 --size 720x540
