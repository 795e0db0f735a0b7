#!/usr/bin/env python3
"""room_arrows.py PROJECT: every #include of lib/ and include/ points along the arrows of the rooms."""
import pathlib
import sys

import c_source

# room: the rooms that it may see besides itself and the public headers. "" is lib/ itself, which sees all.
ARROWS = {
    "fixed_point": set(),
    "disparity": {"fixed_point"},
    "road": {"fixed_point", "disparity"},
    "heading": {"fixed_point"},
    "tracker": {"fixed_point"},
    "": {"fixed_point", "disparity", "road", "heading", "tracker"},
}


def complaint_of_core(room, header, lib, include):
    if header.startswith("<"):
        return None
    name = header.strip('"')
    if ".." in name:
        return f"{header} leaves its room by .. (includes are written from lib/ or include/)"
    if (include / name).is_file():
        return None
    target = name.rsplit("/", 1)[0] if "/" in name else ""
    if not (lib / name).is_file():
        return f"{header} is neither in lib/ nor in include/ (includes are written from there)"
    if room not in ARROWS:
        return f"room {room} has no entry in room_arrows.py"
    if target != room and target not in ARROWS[room]:
        return f"{room or 'lib'} must not see {target or 'lib'} ({header})"
    return None


def complaint_of_public(header, include):
    if header.startswith("<") or (".." not in header and (include / header.strip('"')).is_file()):
        return None
    return f"a public header includes {header}"


def check(project):
    lib, include = pathlib.Path(project, "lib"), pathlib.Path(project, "include")
    complaints = []
    for path in c_source.sources(lib):
        room = path.relative_to(lib).parent.as_posix().strip(".")
        for line, header in c_source.includes(path.read_text(encoding="utf-8")):
            complaints.append((path, line, complaint_of_core(room, header, lib, include)))
    for path in c_source.sources(include):
        for line, header in c_source.includes(path.read_text(encoding="utf-8")):
            complaints.append((path, line, complaint_of_public(header, include)))
    return [f"{path}:{line}: {what}" for path, line, what in complaints if what]


if __name__ == "__main__":
    found = check(sys.argv[1])
    print("\n".join(found) or "every include follows the arrows")
    sys.exit(1 if found else 0)
