#!/bin/sh
# same_output.sh PROGRAM PROGRAM FIXTURES: both print the same about every recording that fits both.
set -eu
played=0
for rig in "$3"/*/rig.yml; do
    recording=$(dirname "$rig")
    first=$("$1" "$recording") || { echo "$recording does not fit $1"; continue; }
    if [ "$first" != "$("$2" "$recording")" ]; then
        echo "$recording: $1 and $2 disagree"
        exit 1
    fi
    played=$((played + 1))
done
echo "$played recordings give the same output"
[ "$played" -gt 0 ]
