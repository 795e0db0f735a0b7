#!/usr/bin/env python3
"""test_cost.py: what docs/can.md says of instructions in the camera's interrupt and of memory, on a Cortex-M4. The code is
compiled as the documentation says, and the instructions are counted in the machine code: there must be no loop, so their
number is more than any path through them."""
import pathlib
import re
import subprocess
import sys
import tempfile

PROJECT = pathlib.Path(__file__).resolve().parents[2]
COMPILE = ["arm-none-eabi-gcc", "-mcpu=cortex-m4", "-mthumb", "-std=c99", "-Os", f"-I{PROJECT / 'include'}", "-c"]
INSTRUCTION = re.compile(r"^ *([0-9a-f]+):\t[0-9a-f ]+\t(\S+)\t?(.*)$")
FUNCTIONS = {"roadpose_camera_frame_ready", "is_ready", "enter", "leave", "release"}
OBJECTS = ["roadpose_can_transmit_t", "roadpose_can_receive_t", "roadpose_camera_port_t"]


def run(*command):
    return subprocess.run(list(map(str, command)), capture_output=True, text=True, check=True).stdout


def functions(listing):
    """{name: [(address, mnemonic, operands)]}"""
    found, name = {}, None
    for line in listing.splitlines():
        if re.match(r"^[0-9a-f]+ <.*>:$", line):
            name = line.split("<")[1].rstrip(">:")
            found[name] = []
        match = INSTRUCTION.match(line)
        if match and not match.group(2).startswith("."):
            found[name].append((int(match.group(1), 16), match.group(2), match.group(3)))
    return found


def target_of(operands):
    """(address, function) of a branch, or None."""
    target = re.search(r"([0-9a-f]+) <([^+>]+)(\+0x[0-9a-f]+)?>", operands)
    return target and (int(target.group(1), 16), target.group(2))


def successors(name, code):
    """{address: addresses that may be executed next}, and the other functions that are called or jumped to."""
    after, called = {}, set()
    addresses = [address for address, _, _ in code] + [None]
    for (address, mnemonic, operands), following in zip(code, addresses[1:]):
        target = target_of(operands) if mnemonic.startswith(("b", "cb")) else None
        ends = mnemonic in ("b.n", "b.w", "bx") or (mnemonic.startswith(("pop", "ldmia")) and "pc" in operands)
        after[address] = [] if ends else [following]
        if target and target[1] == name:
            after[address].append(target[0])
        elif target:
            called.add(target[1])
    return after, called


def has_loop(after, address, path=()):
    return address in path or any(has_loop(after, following, path + (address,)) for following in after.get(address, []))


def interrupt_cost(folder):
    """All instructions of the interrupt's side, and what is wrong with it."""
    run(*COMPILE, PROJECT / "port" / "camera" / "camera_port.c", "-o", folder / "camera.o")
    found = functions(run("arm-none-eabi-objdump", "-d", folder / "camera.o"))
    seen, faults, left = set(), [], {"roadpose_camera_frame_ready"}
    while left:
        name = left.pop()
        seen.add(name)
        after, called = successors(name, found.get(name, []))
        faults += [f"a loop in {name}"] if after and has_loop(after, min(after)) else []
        faults += [f"{name} calls {other}" for other in called - FUNCTIONS]
        left |= called & FUNCTIONS - seen
    return sum(len(found.get(name, [])) for name in seen), faults


def sizes(folder):
    source = folder / "sizes.c"
    lines = [f"char size_{index}[sizeof({name})];" for index, name in enumerate(OBJECTS)]
    source.write_text('#include "roadpose/camera_port.h"\n#include "roadpose/can.h"\n' + "\n".join(lines) + "\n")
    run(*COMPILE, source, "-o", folder / "sizes.o")
    listing = run("arm-none-eabi-nm", "-S", folder / "sizes.o")
    return [int(re.search(rf"[0-9a-f]+ ([0-9a-f]+) \w size_{index}$", listing, re.MULTILINE).group(1), 16)
            for index in range(len(OBJECTS))]


def main():
    text = " ".join((PROJECT / "docs" / "can.md").read_text(encoding="utf-8").split())
    limit = int(re.search(r"interrupt executes fewer than (\d+) instructions", text).group(1))
    with tempfile.TemporaryDirectory() as name:
        instructions, faults = interrupt_cost(pathlib.Path(name))
        transmit, receive, camera = sizes(pathlib.Path(name))
    if not 0 < instructions < limit:
        faults.append(f"{instructions} instructions in the interrupt, docs/can.md says fewer than {limit}")
    memory = f"sender and receiver need {transmit} and {receive} bytes, the camera port {camera}"
    if memory not in text:
        faults.append(f"docs/can.md does not say: {memory}")
    print("\n".join(faults) or f"{instructions} instructions in the interrupt; {memory}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
