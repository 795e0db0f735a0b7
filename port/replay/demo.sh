#!/bin/sh
# Builds roadpose-replay, plays a fixture drive, and prints the poses beside the truth. On a fresh Debian machine it
# installs the compiler, CMake and make first (as root, or through sudo).
#   sh port/replay/demo.sh                        the rendered drive fixtures/roll-sweep
#   sh port/replay/demo.sh RECORDING [options]    another recording that has a truth.csv; options of roadpose-replay
# Environment: ROADPOSE_DEMO_BUILD, the build folder (default build-demo).
set -eu

root=$(cd "$(dirname "$0")/../.." && pwd)
build=${ROADPOSE_DEMO_BUILD:-$root/build-demo}

as_root() {
    if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi
}

# A compiler without the C library's headers is no compiler.
can_compile() {
    command -v cc >/dev/null && echo '#include <dirent.h>' | cc -E - >/dev/null 2>&1
}

install_missing() {
    missing=
    can_compile || missing="$missing gcc libc6-dev"
    command -v cmake >/dev/null || missing="$missing cmake"
    command -v make >/dev/null || missing="$missing make"
    [ -n "$missing" ] || return 0
    echo "Installing:$missing" >&2
    command -v apt-get >/dev/null || { echo "demo.sh: there is no apt-get: install$missing yourself" >&2; exit 1; }
    as_root apt-get -q update >&2
    # shellcheck disable=SC2086 # one argument a package is meant
    as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -y --no-install-recommends install $missing >&2
}

build_replay() {
    mkdir -p "$build"
    { cmake -S "$root" -B "$build" -DCMAKE_BUILD_TYPE=Release &&
        cmake --build "$build" --target roadpose-replay; } >"$build/demo.log" 2>&1 || {
        cat "$build/demo.log" >&2
        exit 1
    }
}

# Joins what was printed with the truth of the same frame. Columns are found by their names.
print_table() {
    awk -F, '
        function number(text) { return text == "" ? "-" : sprintf("%.3f", text) }
        function difference(column, digits) {
            if ($at[column] == "" || truth[$at["frame"], column] == "") return "-"
            error = $at[column] - truth[$at["frame"], column]
            sum[column] += error < 0 ? -error : error
            compared[column]++
            return sprintf("%+." digits "f", error)
        }
        function mean(column, digits) {
            return compared[column] ? sprintf("%." digits "f", sum[column] / compared[column]) : "-"
        }
        { sub(/\r$/, "") }
        FNR == 1 { files++; split("", at); for (i = 1; i <= NF; i++) at[$i] = i; next }
        files == 1 {
            road[$at["frame"]] = $at["road"]
            for (name in at) truth[$at["frame"], name] = $at[name]
            next
        }
        !printed++ {
            print "          pitch, degrees            roll, degrees             height, metres"
            print "frame     truth    pose   error     truth    pose   error     truth    pose    error   status"
        }
        {
            frame = $at["frame"]
            if ($at["status"] == "ok") accepted++
            if (road[frame] == "0" && $at["status"] == "ok") wrong++
            printf "%5s  %8s%8s%8s  %8s%8s%8s  %8s%8s%9s   %s%s\n", frame,
                number(truth[frame, "pitch_deg"]), number($at["pitch_deg"]), difference("pitch_deg", 3),
                number(truth[frame, "roll_deg"]), number($at["roll_deg"]), difference("roll_deg", 3),
                number(truth[frame, "height_m"]), number($at["height_m"]), difference("height_m", 4),
                $at["status"], road[frame] == "0" ? " (there is no road)" : ""
        }
        END {
            printf "\n%d of %d frames with a pose", accepted, printed
            if (wrong) printf ", %d of them without a road", wrong
            if (compared["pitch_deg"])
                printf "; mean absolute error: pitch %s degrees, roll %s degrees, height %s m",
                    mean("pitch_deg", 4), mean("roll_deg", 4), mean("height_m", 4)
            print ""
        }' "$1" "$2"
}

recording=${1:-$root/fixtures/roll-sweep}
[ $# -eq 0 ] || shift
[ -f "$recording/truth.csv" ] || { echo "demo.sh: $recording has no truth.csv to compare with" >&2; exit 1; }
install_missing
build_replay
"$build/port/replay/roadpose-replay" "$@" "$recording" >"$build/poses.csv"
echo "roadpose-replay $recording"
print_table "$recording/truth.csv" "$build/poses.csv"
