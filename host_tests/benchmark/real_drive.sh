#!/bin/sh
# real_drive.sh GATE NAME: runs the accuracy gate on a real drive; exit status 77 (skipped) where there is none.
set -eu
if [ -z "${ROADPOSE_RECORDINGS:-}" ]; then
    echo "SKIPPED: set ROADPOSE_RECORDINGS to the folder that holds the real drive $2"
    exit 77
fi
exec "$1" "$2" "$ROADPOSE_RECORDINGS/$2"
