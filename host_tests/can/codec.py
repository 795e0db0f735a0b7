"""The C code of port/can as a Python object, and seeded random numbers for the tests."""
import math
import os
import pathlib
import random
import subprocess
from fractions import Fraction

import cantools

PROJECT = pathlib.Path(__file__).resolve().parents[2]
MESSAGES = ("RoadposePose", "RoadposeQuality", "RoadposeStatus")
PI = Fraction(314159265358979323846264338327950288419, 10**38)
DEGREES = Fraction(180, 10**6) / PI  # of one micro-radian
DBC = {1: "roadpose.dbc", 2: "roadpose.dbc", 5: "roadpose_p05.dbc"}


def database(profile=1):
    return cantools.database.load_file(PROJECT / "port" / "can" / DBC[profile], strict=True)


def seeded(name):
    """Random numbers that can be had again: the command is printed."""
    seed = int(os.environ.get("ROADPOSE_TEST_SEED", "20160914"))
    print(f"again with ROADPOSE_TEST_SEED={seed} ({name})")
    return random.Random(f"{seed} {name}")


def run(lines):
    """Answers of roadpose-can-codec (environment variable ROADPOSE_CAN_CODEC), one a line."""
    answer = subprocess.run([os.environ["ROADPOSE_CAN_CODEC"]], input="".join(line + "\n" for line in lines),
                            capture_output=True, text=True, check=False)
    if answer.returncode != 0:
        raise RuntimeError(answer.stderr)
    answers = answer.stdout.splitlines()
    if len(answers) != len(lines):
        raise RuntimeError(f"{len(lines)} lines in, {len(answers)} lines out")
    return answers


def invalid_code(signal):
    return (1 << signal.length) - 1


def is_header(signal):
    return signal.name.startswith(("Crc", "Counter"))


def codes(message, data):
    """Raw codes of a frame by cantools: {signal: integer}."""
    return message.decode(data, decode_choices=False, scaling=False)


def exact(number):
    return Fraction(str(number))


def expected_code(signal, value):
    """Nearest code of a physical value by exact fractions; the invalid code beyond the DBC's range."""
    code = math.floor((value - exact(signal.offset)) / exact(signal.scale) + Fraction(1, 2))
    last = (exact(signal.maximum) - exact(signal.offset)) / exact(signal.scale)
    return code if 0 <= code <= last else invalid_code(signal)
