#!/bin/sh
# What a listener on the bus sees: plays a fixture drive as CAN frames, shows the raw frames of two cycles, then every cycle
# as an ECU with the library's receiver checks and decodes it. Needs no CAN hardware; builds what is missing.
#   sh port/socketcan/demo.sh                        the rendered drive fixtures/roll-sweep
#   sh port/socketcan/demo.sh RECORDING [options]    another recording; options of roadpose-replay
# Environment: ROADPOSE_DEMO_BUILD, the build folder (default build-demo).
set -eu

root=$(cd "$(dirname "$0")/../.." && pwd)
build=${ROADPOSE_DEMO_BUILD:-$root/build-demo}
recording=${1:-$root/fixtures/roll-sweep}
[ $# -eq 0 ] || shift

# The first demo knows what a fresh machine lacks, and configures the build folder.
ROADPOSE_DEMO_BUILD=$build sh "$root/port/replay/demo.sh" >/dev/null
cmake --build "$build" --target roadpose-listen >"$build/demo.log" 2>&1 || {
    cat "$build/demo.log" >&2
    exit 1
}

"$build/port/replay/roadpose-replay" --candump "$build/demo-can.log" "$@" "$recording" >/dev/null
echo "On the bus (candump -L), first two cycles:"
head -n 6 "$build/demo-can.log"
echo
echo "Checked (AUTOSAR E2E) and decoded:"
"$build/port/socketcan/roadpose-listen" "$build/demo-can.log" | awk -F, '
    NR == 1 {
        for (i = 1; i <= NF; i++) at[$i] = i
        print "  time  status            pitch     roll   height      yaw  support  residual    road seen  refused  e2e"
        print "     s                  degrees  degrees   metres  degrees        %    pixels       metres           pose/quality/status"
        next
    }
    function known(name, form) { return $at[name] == "" ? "-" : sprintf(form, $at[name]) }
    {
        printf "%6.1f  %-14s %8s %8s %8s %8s %8s %9s %12s %8s  %s\n", $at["time_s"], $at["status"],
            known("pitch_deg", "%.3f"), known("roll_deg", "%.3f"), known("height_m", "%.4f"), known("yaw_deg", "%.2f"),
            known("support_percent", "%d"), known("residual_px", "%.3f"),
            $at["range_near_m"] == "" ? "-" : $at["range_near_m"] "..." $at["range_far_m"],
            known("refused_count", "%d"), $at["e2e"]
    }'
