#!/bin/sh
# Plays a recording onto a virtual CAN interface in several ways and captures what comes. Runs in the virtual machine, or
# in a network namespace of a kernel that has CAN. Needs ip, candump and the modules loaded.
#   drive.sh REPLAY CANDUMP RECORDING OUTPUT SCENARIO...
# Writes OUTPUT/<scenario>.log (capture), .csv (poses), .txt (what the replay said), .status (its exit status).
set -u

replay=$1
candump=$2
recording=$3
output=$4
shift 4
interface=vcan0

up() {
    ip link add dev vcan0 type vcan 2>/dev/null
    ip link set dev vcan0 up
}

gone() {
    ip link del dev vcan0 2>/dev/null
}

# The kernel lists who listens to all interfaces; 10 seconds at most.
wait_for_listener() {
    tries=0
    until grep -q raw /proc/net/can/rcvlist_all || [ "$tries" -ge 100 ]; do
        tries=$((tries + 1))
        sleep 0.1
    done
}

wait_for_silence() {
    before=-1
    now=$(wc -l <"$output/$scenario.log")
    while [ "$now" -ne "$before" ]; do
        sleep 0.5
        before=$now
        now=$(wc -l <"$output/$scenario.log")
    done
}

# begin SCENARIO [options]: listener first, then the replay in the background. "any": it survives an interface that goes.
begin() {
    scenario=$1
    shift
    "$candump" -L -D any >"$output/$scenario.log" 2>/dev/null &
    listener=$!
    wait_for_listener
    { "$replay" --can "$interface" "$@" "$recording" >"$output/$scenario.csv" 2>"$output/$scenario.txt"
      echo $? >"$output/$scenario.status"; } &
    player=$!
}

finish() {
    wait "$player"
    wait_for_silence
    kill "$listener"
    wait "$listener" 2>/dev/null
    gone
}

steady() {
    up
    begin steady --speed 0
    finish
}

# Two outages: one of a few cycles, one that takes the counters of profile 1 once round.
down_and_up() {
    up
    begin down_and_up
    sleep 2
    ip link set dev vcan0 down
    sleep 0.5
    ip link set dev vcan0 up
    sleep 0.8
    ip link set dev vcan0 down
    sleep 1.7
    ip link set dev vcan0 up
    finish
}

missing_at_first() {
    gone
    begin missing_at_first
    sleep 2
    up
    finish
}

removed_and_back() {
    up
    begin removed_and_back --e2e 5
    sleep 2
    gone
    sleep 1
    up
    finish
}

# A line that nobody reads until frames were dropped, 20 seconds at most. What then comes on the line goes to full.line.
# Only in the virtual machine.
full() {
    /stuck-line "$output/full.line" >"$output/full.name" &
    line=$!
    until [ -s "$output/full.name" ] || ! kill -0 "$line"; do sleep 0.1; done
    interface=$(cat "$output/full.name")
    ip link set dev "$interface" up
    begin full
    tries=0
    until grep -q "queue is full" "$output/full.txt" || [ "$tries" -ge 200 ]; do
        tries=$((tries + 1))
        sleep 0.1
    done
    sleep 1
    kill -USR1 "$line"
    finish
    sleep 1
    kill "$line"
}

for scenario in "$@"; do
    "$scenario"
    echo "$scenario done"
done
