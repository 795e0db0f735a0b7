#!/usr/bin/env python3
"""limit_errors.py INCLUDE COMPILER: every #error of the public headers fires on the limit it names, and only then."""
import pathlib
import re
import subprocess
import sys

# What is defined, and the beginning of the message that must stop the build; None: must compile.
CASES = [
    ({}, None),
    ({"ROADPOSE_SMALL_PROFILE": 1}, None),
    ({"ROADPOSE_MAX_WIDTH": 2048, "ROADPOSE_MAX_HEIGHT": 1536, "ROADPOSE_MAX_DISPARITY": 256}, None),
    ({"ROADPOSE_MAX_WIDTH": 64, "ROADPOSE_MAX_HEIGHT": 64, "ROADPOSE_MAX_DISPARITY": 32}, None),
    ({"ROADPOSE_ROW_STEP": 16, "ROADPOSE_COLUMN_STEP": 16, "ROADPOSE_MAX_POINTS": 512, "ROADPOSE_MAX_PAIRS": 64}, None),
    ({"ROADPOSE_ROW_STEP": 1, "ROADPOSE_COLUMN_STEP": 1, "ROADPOSE_MAX_POINTS": 16384, "ROADPOSE_MAX_PAIRS": 1024}, None),
    ({"ROADPOSE_MAX_WIDTH": 63}, "roadpose: set ROADPOSE_MAX_WIDTH to"),
    ({"ROADPOSE_MAX_WIDTH": 2049}, "roadpose: set ROADPOSE_MAX_WIDTH to"),
    ({"ROADPOSE_MAX_HEIGHT": 63}, "roadpose: set ROADPOSE_MAX_HEIGHT to"),
    ({"ROADPOSE_MAX_HEIGHT": 1537}, "roadpose: set ROADPOSE_MAX_HEIGHT to"),
    ({"ROADPOSE_MAX_DISPARITY": 0}, "roadpose: set ROADPOSE_MAX_DISPARITY to"),
    ({"ROADPOSE_MAX_DISPARITY": 100}, "roadpose: set ROADPOSE_MAX_DISPARITY to"),
    ({"ROADPOSE_MAX_DISPARITY": 288}, "roadpose: set ROADPOSE_MAX_DISPARITY to"),
    ({"ROADPOSE_ROW_STEP": 0}, "roadpose: set ROADPOSE_ROW_STEP to"),
    ({"ROADPOSE_ROW_STEP": 17}, "roadpose: set ROADPOSE_ROW_STEP to"),
    ({"ROADPOSE_COLUMN_STEP": 0}, "roadpose: set ROADPOSE_COLUMN_STEP to"),
    ({"ROADPOSE_COLUMN_STEP": 17}, "roadpose: set ROADPOSE_COLUMN_STEP to"),
    ({"ROADPOSE_MAX_POINTS": 511}, "roadpose: set ROADPOSE_MAX_POINTS to"),
    ({"ROADPOSE_MAX_POINTS": 16385}, "roadpose: set ROADPOSE_MAX_POINTS to"),
    ({"ROADPOSE_MAX_PAIRS": 63}, "roadpose: set ROADPOSE_MAX_PAIRS to"),
    ({"ROADPOSE_MAX_PAIRS": 1025}, "roadpose: set ROADPOSE_MAX_PAIRS to"),
    ({"ROADPOSE_MAX_WIDTH": 2048, "ROADPOSE_COLUMN_STEP": 1}, "roadpose: raise ROADPOSE_COLUMN_STEP or"),
    ({"ROADPOSE_MAX_HEIGHT": 1536, "ROADPOSE_ROW_STEP": 1}, "roadpose: raise ROADPOSE_COLUMN_STEP or"),
    ({"ROADPOSE_MAX_TRACKS": 32, "ROADPOSE_YAW_HISTORY": 8, "ROADPOSE_TRACKER_RANGE": 8}, None),
    ({"ROADPOSE_MAX_TRACKS": 512, "ROADPOSE_YAW_HISTORY": 256, "ROADPOSE_TRACKER_RANGE": 64}, None),
    ({"ROADPOSE_E2E_FIRST_COUNTER": 0}, None),
    ({"ROADPOSE_E2E_FIRST_COUNTER": 14}, None),
    ({"ROADPOSE_MAX_TRACKS": 31}, "roadpose: set ROADPOSE_MAX_TRACKS to"),
    ({"ROADPOSE_MAX_TRACKS": 513}, "roadpose: set ROADPOSE_MAX_TRACKS to"),
    ({"ROADPOSE_YAW_HISTORY": 7}, "roadpose: set ROADPOSE_YAW_HISTORY to"),
    ({"ROADPOSE_YAW_HISTORY": 257}, "roadpose: set ROADPOSE_YAW_HISTORY to"),
    ({"ROADPOSE_TRACKER_RANGE": 4}, "roadpose: set ROADPOSE_TRACKER_RANGE to"),
    ({"ROADPOSE_TRACKER_RANGE": 10}, "roadpose: set ROADPOSE_TRACKER_RANGE to"),
    ({"ROADPOSE_TRACKER_RANGE": 68}, "roadpose: set ROADPOSE_TRACKER_RANGE to"),
    ({"ROADPOSE_E2E_FIRST_COUNTER": -1}, "roadpose: set ROADPOSE_E2E_FIRST_COUNTER to"),
    ({"ROADPOSE_E2E_FIRST_COUNTER": 15}, "roadpose: set ROADPOSE_E2E_FIRST_COUNTER to"),
]


def messages(include, compiler, definitions):
    options = [f"-D{name}={value}" for name, value in definitions.items()]
    headers = "".join(f'#include "roadpose/{path.name}"\n' for path in sorted(pathlib.Path(include, "roadpose").glob("*.h")))
    run = subprocess.run([compiler, "-std=c99", f"-I{include}", *options, "-x", "c", "-fsyntax-only", "-"],
                         input=headers, capture_output=True, text=True, check=False)
    return re.findall(r'error: (?:#error )?"([^"]*)"', run.stderr) if run.returncode else []


def complaint_of(found, wanted):
    if wanted is None:
        return f"must compile, but says {found}" if found else None
    return None if any(message.startswith(wanted) for message in found) else f"must say '{wanted}…', but says {found}"


def check(include, compiler, cases=None):
    complaints = [(definitions, complaint_of(messages(include, compiler, definitions), wanted))
                  for definitions, wanted in (cases or CASES)]
    text = "".join(path.read_text(encoding="utf-8") for path in pathlib.Path(include, "roadpose").glob("*.h"))
    untried = [message for message in re.findall(r'#error "([^"]*)"', text)
               if not any(wanted and message.startswith(wanted) for _, wanted in (cases or CASES))]
    return ([f"{definitions}: {what}" for definitions, what in complaints if what] +
            [f"no case fires '{message}'" for message in untried])


if __name__ == "__main__":
    problems = check(*sys.argv[1:3])
    print("\n".join(problems) or "every #error fires on its limit")
    sys.exit(1 if problems else 0)
