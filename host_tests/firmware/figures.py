"""Measures what the library costs on each machine: tables of numbers."""
import dataclasses
import pathlib
import re
import subprocess
import tempfile

import archive
import call_stack
import targets

MACHINES = ["cortex-m3", "cortex-m4", "cortex-m7", "cortex-m33", "riscv32"]
PROFILES = {"default": "", "small": "_small"}
RECORDINGS = ["roll-sweep", "level", "traffic", "no-road"]  # with rows of their own
FRAMES = 10  # of each fixture, at most
PIXELS = 640 * 480
WORST = "the worst of all fixtures"

# Objects whose size is the memory that an integrator gives; "of which" are members of the state.
OBJECTS = {"state": "roadpose_t", "of which u-disparity": "roadpose_u_disparity_t",
           "of which v-disparity": "roadpose_v_disparity_t", "of which free map": "roadpose_free_map_t",
           "of which points": "roadpose_points_t", "camera port": "roadpose_camera_port_t",
           "CAN sender": "roadpose_can_transmit_t", "CAN receiver": "roadpose_can_receive_t",
           "yaw (heading)": "roadpose_heading_t"}

# What a program takes in that calls everything of these headers.
PARTS = {"pose": ["roadpose", "disparity"], "pose and yaw": ["roadpose", "disparity", "heading"]}


@dataclasses.dataclass
class Table:
    title: str
    note: str
    columns: list
    rows: dict  # label -> list of numbers, None where there is none


class Builds:
    """Builds of all machines at -Os and -O2."""

    def __init__(self, source, folder):
        self.source = pathlib.Path(source)
        found = [target for target in targets.all_targets()
                 if target.machine.name in MACHINES and target.level in ("-Os", "-O2")]
        self.targets = {(target.machine.name, target.level): target for target in found}
        programs = ["roadpose-firmware", "roadpose-firmware-small"]
        self.where = {key: targets.build(target, source, folder, programs) for key, target in self.targets.items()}

    def library(self, machine, level, name):
        return archive.Archive(self.where[machine, level] / name, self.targets[machine, level].machine.tools)

    def compiler(self, machine):
        return self.targets[machine, "-Os"].machine.compiler

    def header_names(self, header):
        """Everything that looks like a call in a header."""
        text = (self.source / f"include/roadpose/{header}.h").read_text(encoding="utf-8")
        return set(re.findall(r"\b(roadpose_\w+)\(", text))


def code_sizes(builds):
    rows = {}
    for machine in MACHINES:
        for profile, suffix in PROFILES.items():
            pair = [builds.library(machine, level, f"lib/libroadpose{suffix}.a") for level in ("-Os", "-O2")]
            for part, headers in PARTS.items():
                names = set().union(*map(builds.header_names, headers))
                rows[f"{machine}, {profile}: {part}"] = sizes_of(pair, [library.members(names) for library in pair])
            rows[f"{machine}, {profile}: whole library"] = sizes_of(pair, [None, None])
        rows[f"{machine}, default: pose and yaw, linked"] = linked(builds, machine)
        for label, name in {"camera port": "port/camera/libroadpose_camera.a",
                            "CAN and E2E": "port/can/libroadpose_can.a"}.items():
            pair = [builds.library(machine, level, name) for level in ("-Os", "-O2")]
            rows[f"{machine}: {label}"] = sizes_of(pair, [None, None])
    return Table("Code and constants", "Bytes. A program that calls only some parts takes in only those. \"Linked\": with "
                 "`memcpy`, `memset` and the 64-bit division of the C library and compiler, which most programs have already.",
                 ["`.text` -Os", "`.rodata` -Os", "sum -Os", "sum -O2"], rows)


def linked(builds, machine):
    """Sizes of a linked program that calls everything for pose and yaw: with mem* and the compiler's arithmetic."""
    names = sorted(set().union(*map(builds.header_names, PARTS["pose and yaw"])))
    sizes = []
    for level in ("-Os", "-O2"):
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder, "linked.elf")
            targets.run([builds.compiler(machine), *core_flags(machine), "-nostartfiles",
                         "-Wl,--entry=0,--gc-sections", *[f"-Wl,-u,{name}" for name in names],
                         builds.where[machine, level] / "lib/libroadpose.a", "-o", program])
            listing = archive.output_of(f"{builds.targets[machine, level].machine.tools}size", "-A", program)
        sizes.append([sum(int(size) for size in re.findall(rf"^\.{kind}\S* +(\d+)", listing, re.MULTILINE))
                      for kind in ("text", "s?rodata")])
    return [*sizes[0], sum(sizes[0]), sum(sizes[1])]


def sizes_of(pair, members):
    small, fast = pair
    text, constants = small.bytes_of(archive.CODE, members[0]), small.bytes_of(archive.CONSTANTS, members[0])
    return [text, constants, text + constants,
            fast.bytes_of(archive.CODE, members[1]) + fast.bytes_of(archive.CONSTANTS, members[1])]


def core_flags(machine):
    if machine == "riscv32":
        return ["-march=rv32imac", "-mabi=ilp32", "--specs=picolibc.specs"]
    return ["-mthumb", f"-mcpu={machine}"]


def object_sizes(builds, machine, options):
    """Sizes as the machine's compiler has them."""
    headers = "".join(f'#include "roadpose/{name}.h"\n' for name in ["camera_port", "can", "heading"])
    source = headers + "".join(f"char size_of_{kind}[sizeof({kind})];\n" for kind in OBJECTS.values())
    with tempfile.TemporaryDirectory() as folder:
        target = pathlib.Path(folder, "sizes.o")
        command = [builds.compiler(machine), "-std=c99", *core_flags(machine), *options, f"-I{builds.source}/include", "-xc", "-c", "-",
                   "-o", str(target)]
        subprocess.run(command, input=source, text=True, check=True, capture_output=True)
        listing = archive.output_of(f"{builds.targets[machine, '-Os'].machine.tools}nm", "-P", "-t", "d", target)
    return dict((name, int(size)) for name, size in re.findall(r"^size_of_(\w+) \S \d+ (\d+)", listing, re.MULTILINE))


def memory(builds):
    """Bytes of each object, on each machine and in each profile."""
    rows = {}
    for machine in MACHINES:
        for profile, options in {"default": [], "small": ["-DROADPOSE_SMALL_PROFILE=1"]}.items():
            sizes = object_sizes(builds, machine, options)
            rows[f"{machine}, {profile}"] = [sizes[kind] for kind in OBJECTS.values()]
    return Table("Memory", "Bytes, all of it the caller's; the library has no `.data` and no `.bss`.", list(OBJECTS), rows)


def graph_of(builds, machine, level, suffix):
    """The call graph of the core and its ports, with the run-time functions that they are linked with."""
    where, tools = builds.where[machine, level], builds.targets[machine, level].machine.tools
    folders = [f"lib/CMakeFiles/roadpose{suffix}.dir", f"port/camera/CMakeFiles/roadpose_camera{suffix}.dir", "port/can/CMakeFiles"]
    files = [sorted((where / folder).rglob("*.ci")) for folder in folders]
    if pointers := call_stack.read_graph(files[0]).calls_by_pointer():
        raise call_stack.Fault(f"the core calls by pointer, so its stack cannot be followed: {pointers}")
    graph = call_stack.read_graph([path for found in files for path in found])
    functions = list(graph.frame)
    libraries = [where / f"lib/libroadpose{suffix}.a", where / "port/can/libroadpose_can.a"]
    with tempfile.TemporaryDirectory() as folder:
        program = f"{folder}/whole.elf"
        targets.run([builds.compiler(machine), *core_flags(machine), "-nostartfiles",
                     "-Wl,--entry=0,--no-gc-sections,--whole-archive", *libraries, "-Wl,--no-whole-archive", "-o", program])
        call_stack.add_disassembly(graph, f"{tools}objdump", program)
    for name in functions:  # also what no public call reaches: a fault in it is a fault
        graph.worst(name)
    return graph


def public_functions(builds):
    headers = [path.stem for path in sorted((builds.source / "include/roadpose").glob("*.h"))]
    return set().union(*map(builds.header_names, headers))


def stacks(builds):
    """The larger of -Os and -O2 and of both profiles. A library that calls a function which the graph does not know is a
    fault."""
    worst, with_callbacks = {}, set()
    for machine, level in builds.where:
        for suffix in PROFILES.values():
            graph = graph_of(builds, machine, level, suffix)
            missing = builds.library(machine, level, f"lib/libroadpose{suffix}.a").undefined() - set(graph.frame)
            if missing:
                raise targets.Failure(f"{machine} {level}: the stack of {sorted(missing)} is not known")
            for name in public_functions(builds) & set(graph.frame):
                key = (name, machine)
                worst[key] = max(worst.get(key, 0), graph.worst(name))
                if call_stack.INDIRECT in graph.reached(name):
                    with_callbacks.add(name)
    names = sorted({name for name, _ in worst})
    rows = {f"`{name}`" + (" + callback" if name in with_callbacks else ""):
            [worst.get((name, machine)) for machine in MACHINES] for name in names}
    return Table("Worst stack", "Bytes of each public call with all that it calls, the larger of -Os and -O2 and of both "
                 "profiles: the compiler's figure of each function, followed through the call graph. No recursion, no stack "
                 "of unknown size. \"+ callback\": and what the platform's function needs.", MACHINES, rows)


def frame_count(folder):
    return len(list((folder / "disparity").glob("*.pgm")))


def is_full_size(folder):
    with open(folder / "disparity/000000.pgm", "rb") as image:
        return re.match(rb"P5\s+640\s+480\s", image.read(20)) is not None


@dataclasses.dataclass
class Cost:
    """What some frames cost."""
    is_full_size: bool
    pose: tuple  # frames, executed instructions, those of the worst frame and of the worst slice
    yaw: tuple  # the same; no frames without motion
    stack: int  # bytes that were in use of the library's stack

    @property
    def mean(self):
        return self.pose[1] // self.pose[0]


def executed(builds, fixtures, machine, profile, recording):
    folder = pathlib.Path(fixtures, recording)
    target = builds.targets[machine, "-O2"]
    program = "roadpose-firmware" + PROFILES[profile].replace("_", "-")
    with tempfile.TemporaryDirectory() as scratch:
        command = targets.command_line(target, builds.where[machine, "-O2"], program,
                                       [folder, min(frame_count(folder), FRAMES), f"{scratch}/can.log", "cost"], counting=True)
        done = targets.run(command)
    return read_cost((done.stdout + done.stderr).decode(), is_full_size(folder), f"{machine}, {profile}: {recording}")


def read_cost(said, full_size, name):
    counts = {kind: tuple(map(int, numbers)) for kind, *numbers in
              re.findall(r"(pose|yaw): frames (\d+) instructions (\d+) worst_frame (\d+) worst_slice (\d+)", said)}
    stack = re.search(r"stack (\d+)", said)
    if set(counts) != {"pose", "yaw"} or not stack or not all(counts["pose"]) or not int(stack.group(1)):
        raise targets.Failure(f"{name}: the board does not count: {said[-300:]}")
    return Cost(full_size, counts["pose"], counts["yaw"], int(stack.group(1)))


def costs(builds, fixtures):
    """{(machine, profile): {fixture: Cost}}"""
    names = [path.parent.name for path in sorted(pathlib.Path(fixtures).glob("*/rig.yml"))]
    return {(machine, profile): {name: executed(builds, fixtures, machine, profile, name) for name in names}
            for machine in MACHINES for profile in PROFILES}


def row_of(mean, worst_frame, worst_slice):
    return [mean, round(mean / PIXELS, 2), worst_frame, worst_slice]


def instructions(measured):
    rows = {}
    for (machine, profile), played in measured.items():
        rows.update({f"{machine}, {profile}: {name}": row_of(played[name].mean, *played[name].pose[2:]) for name in RECORDINGS})
        full = [cost for cost in played.values() if cost.is_full_size]
        rows[f"{machine}, {profile}: {WORST}"] = row_of(
            max(cost.mean for cost in full), max(cost.pose[2] for cost in full), max(cost.pose[3] for cost in played.values()))
    return Table("Executed instructions", "At -O2, counted by the emulator; 640 x 480, the camera port and the whole "
                 "pipeline for the pose. A slice is one call of `roadpose_camera_task(port, 1)`; its worst is that of the "
                 "320 x 240 fixture as well.", ["mean a frame", "a pixel", "worst frame", "worst slice"], rows)


def yaw_instructions(measured):
    rows = {f"{machine}: {name}": [cost.yaw[1] // cost.yaw[0], cost.yaw[2]]
            for (machine, profile), played in measured.items() if profile == "default"
            for name, cost in played.items() if cost.yaw[0]}
    return Table("Executed instructions, yaw", "At -O2: one call of `roadpose_heading_process()` a frame, which is not cut "
                 "into slices. Without the tracker.", ["mean a frame", "worst frame"], rows)


def seen_stack(measured):
    """What the emulator saw, beside the analysis."""
    def most(machine, with_yaw):
        return max(cost.stack for (name, _), played in measured.items() if name == machine
                   for cost in played.values() if bool(cost.yaw[0]) == with_yaw)

    return Table("Stack in use", "Bytes that a run of all fixtures at -O2 left marks on, of a stack of 1 KiB that only the "
                 "library uses: with the callbacks and the call itself of `roadpose-firmware`. It must not exceed the worst "
                 "stack above by more than those.", MACHINES,
                 {"pose and CAN": [most(machine, False) for machine in MACHINES],
                  "pose, CAN and yaw": [most(machine, True) for machine in MACHINES]})


# What roadpose-firmware calls on the library's stack, and what its own functions there take at most.
CALLED = {"pose and CAN": ["roadpose_camera_task", "roadpose_init", "roadpose_can_transmit_cycle",
                           "roadpose_can_transmit_init"],
          "pose, CAN and yaw": ["roadpose_heading_process"]}
WRAPPERS = 96


def unexplained_stack(analysed, seen):
    """Complaints where more stack is in use than the analysis knows."""
    worst = {label.split("`")[1]: values for label, values in analysed.rows.items()}
    complaints = []
    for row, names in CALLED.items():
        for column, machine in enumerate(MACHINES):
            known = max(worst[name][column] for name in names)
            if seen.rows[row][column] > known + WRAPPERS:
                complaints.append(f"{machine}, {row}: {seen.rows[row][column]} bytes of stack in use, of which the call "
                                  f"graph explains {known} + {WRAPPERS}")
    return complaints


def measure(source, folder, fixtures):
    builds = Builds(source, folder)
    measured = costs(builds, fixtures)
    tables = [code_sizes(builds), memory(builds), stacks(builds), instructions(measured), yaw_instructions(measured),
              seen_stack(measured)]
    if complaints := unexplained_stack(tables[2], tables[5]):
        raise targets.Failure("\n".join(complaints))
    return tables
