#!/usr/bin/env python3
"""The component gives the same poses, statuses and CAN frames, byte for byte, on every machine.

Builds roadpose-firmware for every target of targets.py, plays frames of the fixtures there, and compares the CSV and the
CAN log with those of roadpose-replay (default size) and of the host's roadpose-firmware-small (small profile). Checks the
symbols of each library as well."""
import argparse
import concurrent.futures
import os
import pathlib
import shlex
import shutil
import sys
import tempfile

import symbols
import targets

# What roadpose-firmware is told, and what makes roadpose-replay do the same.
SETTINGS = {"": "", "method-1": "--method 1", "method-1 no-refine e2e-2": "--method 1 --no-refine --e2e 2",
            "no-refine e2e-5": "--no-refine --e2e 5"}
VARIED = ["roll-sweep", "no-road"]  # fixtures that are played with all of them; the others with the defaults
LIBRARIES = ["lib/libroadpose.a", "lib/libroadpose_small.a", "port/camera/libroadpose_camera.a",
             "port/can/libroadpose_can.a"]
PROGRAMS = ["roadpose-firmware", "roadpose-firmware-small"]


def excerpt(fixture, frames, folder):
    """A recording of the first frames of a fixture, and how many there are."""
    short = pathlib.Path(folder, fixture.name)
    for kind in ["disparity", "tracks", "left"]:
        files = sorted((fixture / kind).glob("[0-9]*.*"))
        for path in [path for path in files if int(path.stem) < frames]:
            (short / kind).mkdir(parents=True, exist_ok=True)
            shutil.copy(path, short / kind)
    for path in [fixture / "rig.yml", fixture / "vehicle.csv"]:
        if path.exists():
            shutil.copy(path, short)
    return short, len(list((short / "disparity").iterdir()))


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
        """What the program of command_for(arguments) says: {case: (CSV, CAN log)}."""
        said = {}
        for recording, frames, words in self.cases:
            log = self.log(name)
            csv = targets.run(command_for([recording, frames, log, *words.split()])).stdout
            said[recording.name, words] = (csv, log.read_bytes())
        return said

    def replay(self, program):
        said = {}
        for recording, frames, words in self.cases:
            log = self.log("replay")
            csv = targets.run([program, "--candump", log, *SETTINGS[words].split(), recording]).stdout
            said[recording.name, words] = (csv, log.read_bytes())
        return said


def first_difference(expected, got):
    lines, others = expected.splitlines(), got.splitlines()
    for number, (line, other) in enumerate(zip(lines, others), 1):
        if line != other:
            return f"line {number}: expected {line.decode()!r}\n{'':15}got {other.decode(errors='replace')!r}"
    return f"{len(lines)} lines expected, {len(others)} came"


def compare(expected, got, name):
    complaints = []
    for (recording, words), outputs in expected.items():
        for what, one, other in zip(["poses", "CAN frames"], outputs, got[recording, words]):
            if one != other:
                complaints.append(f"{name}, {recording} {words}: {what} differ\n    {first_difference(one, other)}")
    return complaints


def check_symbols(target, where):
    libraries = [where / name for name in LIBRARIES if (where / name).exists()]
    complaints = [line for path in libraries
                  for line in symbols.check(target.machine.tools, path, [other for other in libraries if other != path])]
    return complaints if libraries else [f"{where} has no library"]


def again(arguments, only):
    """The command that runs this test for one target."""
    words = [sys.executable, "-B", sys.argv[0], "--frames", str(arguments.frames), "--only", only]
    for name in ["source", "folder", "fixtures", "replay", "small"]:
        words += [f"--{name}", getattr(arguments, name)]
    return shlex.join(words)


def try_target(target, arguments, player, expected):
    """What is wrong with one target, as a list of lines."""
    programs = PROGRAMS if target.level in arguments.small_levels else PROGRAMS[:1]
    complaints = []
    try:
        where = targets.build(target, arguments.source, arguments.folder, programs)
        complaints += check_symbols(target, where)
        for program in programs:
            said = player.firmware(lambda words, name=program: targets.command_line(target, where, name, words), program)
            complaints += compare(expected[program], said, f"{target.name} {program}")
    except (targets.Failure, OSError) as failure:
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
    parser.add_argument("--small", required=True, help="the host's roadpose-firmware-small")
    parser.add_argument("--frames", type=int, default=3, help="of each fixture, at most")
    parser.add_argument("--small-levels", nargs="*", default=["-O2"], help="where the small profile is built as well")
    parser.add_argument("--only", default="", help="targets whose name contains this, such as 'cortex-m4 -Os'")
    return parser.parse_args()


def main():
    arguments = parse()
    chosen = [target for target in targets.all_targets() if arguments.only in target.name]
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        player = Player(arguments, folder)
        expected = {PROGRAMS[0]: player.replay(arguments.replay),
                    PROGRAMS[1]: player.firmware(lambda words: [arguments.small, *words], "small")}
        found = list(pool.map(lambda target: try_target(target, arguments, player, expected), chosen))
    complaints = [line for lines in found for line in lines]
    print("\n".join(complaints) or f"{len(chosen)} targets give the same bytes over {len(player.cases)} recordings and settings")
    sys.exit(1 if complaints or not player.cases or not chosen else 0)


if __name__ == "__main__":
    main()
