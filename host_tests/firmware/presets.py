#!/usr/bin/env python3
"""presets.py SOURCE SCRATCH: every machine with a toolchain file has a build preset of that name, which configures with that
machine's compiler, has a build preset, and is named in docs/firmware.md."""
import json
import pathlib
import re
import shutil
import sys

import targets


def text_of(folder, pattern):
    return "".join(path.read_text(encoding="utf-8") for path in folder.glob(pattern))


def compiler_of(folder):
    found = re.search(r'set\(CMAKE_C_COMPILER "(.*)"\)', text_of(folder, "CMakeFiles/*/CMakeCCompiler.cmake"))
    return pathlib.Path(found.group(1)).name if found else "none"


def configured(source, scratch, machine):
    """What is wrong with the preset of one machine."""
    where = scratch / machine.name
    shutil.rmtree(where, ignore_errors=True)
    targets.run(["cmake", "--preset", machine.name, "-B", where, "-G", "Ninja"], cwd=source)
    complaints = []
    if machine.compiler != "gcc" and compiler_of(where) != machine.compiler:
        complaints.append(f"{machine.name}: compiled with {compiler_of(where)}")
    if f"cmake/{machine.toolchain}.cmake" not in text_of(where, "CMakeCache.txt"):
        complaints.append(f"{machine.name}: not with cmake/{machine.toolchain}.cmake")
    if not re.search(r"\broadpose-firmware-small\b", text_of(where, "build.ninja")):
        complaints.append(f"{machine.name}: does not build roadpose-firmware-small")
    return complaints


def check(source, scratch):
    presets = json.loads((source / "CMakePresets.json").read_text(encoding="utf-8"))
    text = (source / "docs/firmware.md").read_text(encoding="utf-8")
    # host32-gcc and -clang share a toolchain file, which has the preset's name
    machines = {machine.toolchain: machine for machine in reversed(targets.MACHINES) if machine.toolchain}
    complaints = [f"{name}: no build preset" for name in machines
                  if name not in [preset["name"] for preset in presets["buildPresets"]]]
    complaints += [f"{preset['name']}: not in docs/firmware.md" for preset in presets["configurePresets"]
                   if not preset.get("hidden") and f"`{preset['name']}`" not in text]
    for name, machine in machines.items():
        complaints += configured(source, scratch, targets.dataclasses.replace(machine, name=name))
    return complaints


if __name__ == "__main__":
    try:
        found = check(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
    except targets.Failure as failure:
        found = [str(failure)]
    print("\n".join(found) or "every machine has its presets")
    sys.exit(1 if found else 0)
