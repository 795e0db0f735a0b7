#!/bin/sh
# Writes docs/evaluation from nothing: installs what is missing, builds, renders the full fixture set (about a quarter of an
# hour), evaluates everything, draws the figures. The tests do not need any of it. Needs Debian 12 and, to install, root
# or sudo, and the Python Package Index.
#   sh host_tests/evaluation/run.sh
# Environment: ROADPOSE_BUILD_DIR    default build-evaluation
#              ROADPOSE_FULL_SET     folder of `roadpose-make-fixtures DIR --full`: used as it is, nothing is rendered
#              ROADPOSE_RECORDINGS   folder of the real drives, where there are any
set -eu

here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
build=${ROADPOSE_BUILD_DIR:-$root/build-evaluation}
mkdir -p "$build"
build=$(cd "$build" && pwd)
work=$build/results
full=${ROADPOSE_FULL_SET:-$build/full-set}
packages='gcc g++ cmake make libopencv-dev valgrind python3 python3-venv ca-certificates'

as_root() {
    if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi
}

install_packages() {
    missing=
    for package in $packages; do
        dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing="$missing $package"
    done
    [ -n "$missing" ] || return 0
    as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=600 update
    # shellcheck disable=SC2086 # one argument a package is meant
    as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=600 --no-install-recommends install $missing
}

# matplotlib, NumPy and Open3D, in an environment that nothing else uses.
install_python() {
    if cmp -s "$here/requirements.txt" "$build/python/requirements.txt"; then return 0; fi
    rm -rf "$build/python"
    python3 -m venv "$build/python"
    "$build/python/bin/pip" install --disable-pip-version-check --requirement "$here/requirements.txt"
    cp "$here/requirements.txt" "$build/python/"
}

step() { printf '\n== %s\n' "$1"; }

# Moves a finished table into place, so that an interrupted run leaves none that is cut short.
into() {
    target=$1
    shift
    "$@" >"$target.part"
    mv "$target.part" "$target"
}

# Those of the full set that fit the default limits: the build that is timed.
standard_sets() {
    for name in roll-sweep level speed-bump traffic weak-texture block-matcher crown dirt no-road; do
        printf '%s ' "$full/$name"
    done
}

count_instructions() {
    "$build/python/bin/python" "$here/count_instructions.py" "$build/roadpose-count" "$work/counted" \
        "$full/roll-sweep" 0 4 8 12 16 20 24 28 32 36 40 -- "$full/level" 2 6 10 14 18
}

evaluate_drives() {
    drives=
    for name in street-lidar straight-motion; do
        [ ! -f "${ROADPOSE_RECORDINGS:-/nonexistent}/$name/rig.yml" ] || drives="$drives $ROADPOSE_RECORDINGS/$name"
    done
    [ -n "$drives" ] || return 0
    step 'Real drives'
    # shellcheck disable=SC2086 # one argument a drive is meant
    into "$work/drives.csv" "$build/roadpose-evaluate-large" $drives
    # shellcheck disable=SC2086
    into "$work/open3d-drives.csv" "$build/python/bin/python" "$here/open3d_peer.py" --cropped $drives
}

step 'Packages'
install_packages
install_python
step 'Programs'
cmake -S "$here" -B "$build" >/dev/null
cmake --build "$build" -j "$(nproc)"
mkdir -p "$work"
if [ -z "${ROADPOSE_FULL_SET:-}" ] && [ ! -f "$full/complete" ]; then
    step 'Full fixture set'
    "$build/fixture_generator/roadpose-make-fixtures" "$full" --full
    touch "$full/complete"
fi
sets=$(standard_sets)
step 'Every candidate on every frame'
# shellcheck disable=SC2086 # one argument a recording is meant
into "$work/results.csv" "$build/roadpose-evaluate" $sets
into "$work/results-large.csv" "$build/roadpose-evaluate-large" "$full/wide-rig"
step 'Open3D on the same frames'
# shellcheck disable=SC2086
into "$work/open3d.csv" "$build/python/bin/python" "$here/open3d_peer.py" $sets
step 'Instructions, counted'
into "$work/instructions.csv" count_instructions
step 'Sensitivity, and the share of the points'
into "$work/share.csv" "$build/roadpose-share" "$full/roll-sweep"
into "$work/sensitivity.csv" "$build/roadpose-sensitivity" "$full/roll-sweep" "$full/level"
evaluate_drives
step 'Page'
"$build/python/bin/python" "$here/page.py" --programs "$build" --work "$work" --full "$full" --fixtures "$root/fixtures" \
    --out "$root/docs/evaluation"
echo "docs/evaluation/index.html"
