#!/usr/bin/env python3
"""The component gives the same poses, statuses and CAN frames, byte for byte, on every machine.

Builds roadpose-firmware for every target of targets.py, plays frames of the fixtures there, and compares the CSV, the CAN log
and every field of each frame's results with those of the host's roadpose-firmware, in the default size and in the small
profile. Checks the symbols of each library as well. roadpose-replay, which is built for larger images, must say the same:
its CAN log is compared with the default settings only, because how well a refused plane is supported may depend on the
limits (include/roadpose/limits.h)."""
import argparse
import concurrent.futures
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

import symbols
import targets

# What roadpose-firmware is told, and what makes roadpose-replay do the same.
SETTINGS = {"": "", "method-1": "--method 1", "method-1 no-refine e2e-2": "--method 1 --no-refine --e2e 2",
            "no-refine e2e-5": "--no-refine --e2e 5"}
VARIED = ["roll-sweep", "no-road"]  # fixtures that are played with all of them; the others with the defaults
PROGRAMS = {"roadpose-firmware": ["lib/libroadpose.a", "port/camera/libroadpose_camera.a", "port/can/libroadpose_can.a"],
            "roadpose-firmware-small": ["lib/libroadpose_small.a", "port/camera/libroadpose_camera_small.a",
                                        "port/can/libroadpose_can.a"]}
DEFAULT, SMALL = PROGRAMS
OUTPUTS = ["poses", "CAN frames", "fields"]
FIELDS = b"pose "  # how the lines begin that roadpose-replay has not
# What must occur in the poses of all cases, or the comparison proves little: a pose, a refusal, a yaw.
OCCUR = {"a pose": rb"^\d+,ok,", "a refused frame": rb"^\d+,no_road,", "a yaw": rb"^\d+,ok,.*,ok,\d"}


def chosen_frames(fixture, frames):
    """Numbers of some frames: of a drive with motion the first, else from the first to the last."""
    numbers = sorted(int(path.stem) for path in (fixture / "disparity").glob("[0-9]*.pgm"))
    if len(numbers) <= frames or (fixture / "tracks").exists() or (fixture / "left").exists():
        return numbers[:frames]
    return [numbers[index * (len(numbers) - 1) // (frames - 1)] for index in range(frames)]


def excerpt(fixture, frames, folder):
    """A recording of some frames of a fixture, numbered from 0, and how many there are."""
    short = pathlib.Path(folder, fixture.name)
    chosen = chosen_frames(fixture, frames)
    for kind in ["disparity", "tracks", "left"]:
        for place, frame in enumerate(chosen):
            for path in (fixture / kind).glob(f"{frame:06}.*"):
                (short / kind).mkdir(parents=True, exist_ok=True)
                shutil.copy(path, short / kind / f"{place:06}{path.suffix}")
    for path in [fixture / "rig.yml", fixture / "vehicle.csv"]:
        if path.exists():
            shutil.copy(path, short)
    return short, len(chosen)


def excerpts(fixtures, frames, folder):
    return [excerpt(path.parent, frames, folder) for path in sorted(pathlib.Path(fixtures).glob("*/rig.yml"))]


class Player:
    """Plays each case once with each program; a case is a recording and its settings."""

    def __init__(self, arguments, folder):
        self.folder = folder
        self.recordings = excerpts(arguments.fixtures, arguments.frames, folder)
        self.cases = [(recording, frames, words) for recording, frames in self.recordings for words in SETTINGS
                      if not words or recording.name in VARIED]

    def log(self, name):
        handle, path = tempfile.mkstemp(dir=self.folder, prefix=name, suffix=".can")
        os.close(handle)
        return pathlib.Path(path)

    def firmware(self, command_for, name):
        """What the program of command_for(arguments) says: {case: (CSV, CAN log, fields)}."""
        said = {}
        for recording, frames, words in self.cases:
            log = self.log(name)
            lines = targets.run(command_for([recording, frames, log, "fields", *words.split()])).stdout.splitlines(True)
            csv, fields = ([line for line in lines if line.startswith(FIELDS) == is_field] for is_field in (False, True))
            said[recording.name, words] = (b"".join(csv), log.read_bytes(), b"".join(fields))
        return said

    def replay(self, program, expected):
        """The same of roadpose-replay; what cannot be compared is as expected."""
        said = {}
        for recording, frames, words in self.cases:
            log = self.log("replay")
            csv = targets.run([program, "--candump", log, *SETTINGS[words].split(), recording]).stdout
            can, fields = expected[recording.name, words][1:]
            said[recording.name, words] = (csv, can if words else log.read_bytes(), fields)
        return said


def empty(expected):
    """What the expected output lacks to be worth a comparison."""
    poses = b"".join(outputs[0] for outputs in expected.values())
    lacks = [f"no recording gives {what}" for what, pattern in OCCUR.items() if not re.search(pattern, poses, re.MULTILINE)]
    return lacks + [f"{recording} {words}: no {what}" for (recording, words), outputs in expected.items()
                    for what, output in zip(OUTPUTS, outputs) if not output.strip()]


def first_difference(expected, got):
    lines, others = expected.splitlines(), got.splitlines()
    for number, (line, other) in enumerate(zip(lines, others), 1):
        if line != other:
            return f"line {number}: expected {line.decode()!r}\n{'':15}got {other.decode(errors='replace')!r}"
    return f"{len(lines)} lines expected, {len(others)} came"


def compare(expected, got, name):
    complaints = []
    for (recording, words), outputs in expected.items():
        for what, one, other in zip(OUTPUTS, outputs, got[recording, words]):
            if one != other:
                complaints.append(f"{name}, {recording} {words}: {what} differ\n    {first_difference(one, other)}")
    return complaints


def check_symbols(target, where, program):
    libraries = [where / name for name in PROGRAMS[program]]
    return [line for path in libraries
            for line in symbols.check(target.machine.tools, path, [other for other in libraries if other != path])]


def again(arguments, only):
    """The command that runs this test for one target."""
    words = [sys.executable, "-B", sys.argv[0], "--frames", str(arguments.frames), "--only", only]
    for name in ["source", "folder", "fixtures", "replay", "firmware", "small"]:
        words += [f"--{name}", getattr(arguments, name)]
    return shlex.join(words)


def try_target(target, arguments, player, expected):
    """What is wrong with one target, as a list of lines."""
    programs = [DEFAULT, SMALL] if target.level in arguments.small_levels else [DEFAULT]
    complaints = []
    try:
        where = targets.build(target, arguments.source, arguments.folder, programs)
        for program in programs:
            complaints += check_symbols(target, where, program)
            said = player.firmware(lambda words, name=program: targets.command_line(target, where, name, words), program)
            complaints += compare(expected[program], said, f"{target.name} {program}")
    except (targets.Failure, OSError, ValueError, subprocess.SubprocessError) as failure:
        complaints.append(f"{target.name}: {failure}")
    if complaints:
        complaints.append(f"again: {again(arguments, target.name)}")
    print(f"{target.name}: {'FAILED' if complaints else 'same bytes'}", flush=True)
    return complaints


def parse():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--source", required=True, help="the project")
    parser.add_argument("--folder", required=True, help="for the builds; kept")
    parser.add_argument("--fixtures", required=True)
    parser.add_argument("--replay", required=True, help="the host's roadpose-replay")
    parser.add_argument("--firmware", required=True, help="the host's roadpose-firmware")
    parser.add_argument("--small", required=True, help="the host's roadpose-firmware-small")
    parser.add_argument("--frames", type=int, default=3, help="of each fixture, at most")
    parser.add_argument("--small-levels", nargs="*", default=["-Os", "-O2"], help="where the small profile is built as well")
    parser.add_argument("--only", default="", help="targets whose name contains this, such as 'cortex-m4 -Os'")
    return parser.parse_args()


def main():
    arguments = parse()
    chosen = [target for target in targets.all_targets() if arguments.only in target.name]
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        player = Player(arguments, folder)
        expected = {program: player.firmware(lambda words, path=path: [path, *words], program)
                    for program, path in {DEFAULT: arguments.firmware, SMALL: arguments.small}.items()}
        replayed = player.replay(arguments.replay, expected[DEFAULT])
        found = list(pool.map(lambda target: try_target(target, arguments, player, expected), chosen))
    complaints = [line for said in expected.values() for line in empty(said)]
    complaints += compare(expected[DEFAULT], replayed, "roadpose-replay") + [line for lines in found for line in lines]
    print("\n".join(complaints) or f"{len(chosen)} targets give the same bytes over {len(player.cases)} recordings and settings")
    sys.exit(1 if complaints or not player.cases or not chosen else 0)


if __name__ == "__main__":
    main()
