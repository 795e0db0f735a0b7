#!/usr/bin/env python3
"""The same recording gives the same CSV, byte for byte, whatever compiler, optimisation, ABI or sanitizer built roadpose-replay.

Builds the program with plain compiler calls, plays every recording with several settings, and compares with the first
build. A sanitizer that reports anything ends its program, which is a difference too.
"""
import argparse
import concurrent.futures
import os
import pathlib
import shlex
import subprocess
import sys

SANITIZERS = "-O1 -g -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer"
BUILDS = ["-O0", "-O2", "-O3", "-Os", SANITIZERS]
# What processors of ECUs do otherwise than this one: plain char without sign, short enums, 32-bit pointers and long.
# Debian's gcc-12-multilib alone leaves the kernel's headers where only the 64-bit compiler looks.
GCC_BUILDS = ["-O2 -funsigned-char -fshort-enums", "-O2 -m32 -idirafter /usr/include/x86_64-linux-gnu"]
# Long recordings are played with the first two only.
LONG = 20  # frames
SETTINGS = ["", "--method 1", "--method 1 --no-refine", "--no-refine", "--corridor 0", "--points 10 --seed 7 --no-refine"]


def can_link(compiler, options, folder):
    program = folder / "probe"
    run = subprocess.run([compiler, *shlex.split(options), "-x", "c", "-", "-o", program], capture_output=True, text=True,
                         input="int main(void) { return 0; }\n", check=False)
    return run.returncode == 0 and subprocess.run([program], check=False).returncode == 0


def build(arguments, number, compiler, options):
    program = pathlib.Path(arguments.folder, f"replay-{number}")
    command = [compiler, "-std=c99", *shlex.split(options), *[f"-D{name}" for name in arguments.definitions],
               *[f"-I{folder}" for folder in arguments.includes], *arguments.sources, "-o", str(program)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    if run.returncode:
        sys.exit(f"{shlex.join(command)}\n{run.stderr}")
    return program


def play(program, recording, settings):
    command = [str(program), *shlex.split(settings), str(recording)]
    run = subprocess.run(command, capture_output=True, check=False)
    if run.returncode or run.stderr:
        sys.exit(f"exit status {run.returncode} from: {shlex.join(command)}\n{run.stderr.decode()}")
    return run.stdout


def first_difference(name, left, right):
    for number, (one, other) in enumerate(zip(left.splitlines(), right.splitlines()), 1):
        if one != other:
            return f"{name}, line {number}:\n  {one.decode()}\n  {other.decode()}"
    return f"{name}: one of them is longer"


def settings_of(recording):
    return SETTINGS if len(list(recording.glob("disparity/*.pgm"))) <= LONG else SETTINGS[:2]


def cases_of(fixtures):
    """(recording, settings) of all that is to be played."""
    folders = [fixtures]
    if real := os.environ.get("ROADPOSE_RECORDINGS"):
        folders.append(real)
    else:
        print("ROADPOSE_RECORDINGS is not set: only the fixtures are played")
    recordings = [path.parent for folder in folders for path in sorted(pathlib.Path(folder).glob("*/rig.yml"))]
    return [(recording, settings) for recording in recordings for settings in settings_of(recording)]


def play_all(program, cases):
    return [play(program, recording, settings) for recording, settings in cases]


def variants(arguments):
    folder = pathlib.Path(arguments.folder)
    found = [(compiler, options) for compiler in arguments.compilers for options in BUILDS]
    found += [(arguments.compilers[0], options) for options in GCC_BUILDS]
    for compiler, options in list(found):
        if "-m32" in options and not can_link(compiler, options, folder):
            print(f"SKIPPED: {compiler} cannot link with {options}")
            found.remove((compiler, options))
    return found


def parse():
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ["--folder", "--fixtures"]:
        parser.add_argument(name, required=True)
    for name in ["--compilers", "--sources", "--includes", "--definitions"]:
        parser.add_argument(name, nargs="+", required=True)
    return parser.parse_args()


def main():
    arguments = parse()
    pathlib.Path(arguments.folder).mkdir(parents=True, exist_ok=True)
    cases = cases_of(arguments.fixtures)
    builds = variants(arguments)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        programs = list(pool.map(lambda item: build(arguments, item[0], *item[1]), enumerate(builds)))
        outputs = list(pool.map(lambda program: play_all(program, cases), programs))
    differences = [first_difference(f"{builds[0]} against {variant}, {recording.name} {settings}", one, other)
                   for variant, output in zip(builds, outputs)
                   for (recording, settings), one, other in zip(cases, outputs[0], output) if one != other]
    print("\n".join(differences[:20]) or f"{len(builds)} builds give the same {sum(map(len, outputs[0]))} bytes over "
          f"{len(cases)} recordings and settings")
    sys.exit(1 if differences or not cases else 0)


if __name__ == "__main__":
    main()
