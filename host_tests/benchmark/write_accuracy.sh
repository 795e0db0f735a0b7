#!/bin/sh
# write_accuracy.sh BUILD [FULL_SET] >docs/accuracy.md: measures everything that docs/accuracy.md tells.
# BUILD: a build folder of the host tests. FULL_SET: folder made by `roadpose-make-fixtures FULL_SET --full`.
# Environment: ROADPOSE_RECORDINGS, the folder of the real drives, where there is one.
set -eu
[ $# -ge 1 ] || { echo "usage: write_accuracy.sh BUILD [FULL_SET]" >&2; exit 2; }
benchmark=$1/host_tests/benchmark/roadpose-benchmark
speed=$1/host_tests/benchmark/roadpose-speed
full=${2:-}
root=$(cd "$(dirname "$0")/../.." && pwd)
fixtures=$root/fixtures

cat <<'TEXT'
# Accuracy and speed

This page is written by a program:

    sh host_tests/run.sh -N                                      # builds
    build-host-tests/host_tests/fixture_generator/roadpose-make-fixtures full --full
    sh host_tests/benchmark/write_accuracy.sh build-host-tests full >docs/accuracy.md

Errors are estimate minus truth, over the accepted frames. *Least squares* rows are references in double precision that know
which pixels are road (`road/*.pbm` of the fixtures): what a perfect choice of pixels reaches on the same disparities.
*Trimmed* means that pixels more than a band (1.5, 0.6, 0.35 px) off the plane are dropped. Most of the pitch error in the
rendered sets is the matcher's own bias of +0.03 px, which all estimators share.

What to know when reading it:
- The rendered scenes are cleaner than a camera: noise is 0.12 px (0.4 px in `weak-texture`), nearly every pixel has a match,
  and the lane of `crown` is gentler than the one of `street-lidar`. The real drives count for more.
- `street-lidar`: the truth is a plane through laser points of the lane, itself uncertain by about 0.15° and 3 cm, the same
  over the whole drive, with 0.1° of noise from frame to frame. A plain least-squares plane of all disparities within ±2 m is
  0.10° off it in roll; the soft edge of the corridor makes that 0.05°. One centimetre of corridor is 0.02° there.
- `straight-motion` has no truth; steadiness is what can be measured.
- Frames on top of a speed bump are refused (`poor_fit`) when the bump fills most of the near road.
- Speed is a ratio within one run: the machine it was written on is shared and noisy.
TEXT

drives=
if [ -n "${ROADPOSE_RECORDINGS:-}" ]; then
    drives="$ROADPOSE_RECORDINGS/street-lidar $ROADPOSE_RECORDINGS/straight-motion"
fi

printf '\n# Fixtures and real drives\n\n'
# shellcheck disable=SC2086 # no drives: no arguments
"$benchmark" "$fixtures/roll-sweep" "$fixtures/level" "$fixtures/speed-bump" "$fixtures/traffic" \
    "$fixtures/weak-texture" "$fixtures/block-matcher" "$fixtures/crown" "$fixtures/dirt" "$fixtures/no-road" $drives
if [ -n "$full" ]; then
    printf '\n# Full set: more frames of each kind, other seeds, and a second rig\n\n'
    "$benchmark" "$full"/*
fi
printf '\n# Speed\n\nWhole pipeline on one 640 x 480 frame, and one plain C v-disparity pass over the same buffer, -O2, one core.\n\n'
"$speed" "$fixtures/roll-sweep"
printf '\n'
"$speed" "$fixtures/traffic"
