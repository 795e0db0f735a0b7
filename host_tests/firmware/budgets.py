#!/usr/bin/env python3
"""What the library costs: measures it on every microcontroller, and writes docs/budgets.md (--write) or compares with it.

Comparing fails when a figure grew beyond its tolerance, when a limit is exceeded, when the file lacks a figure, or when
README.md does not show the same summary."""
import argparse
import pathlib
import re
import sys

import archive
import call_stack
import figures
import targets

# Growth that is no fault, in percent. Sizes and counts follow the compiler: a patch version of it, or of the C library's
# memset, may choose other instructions for the same source. State is fixed by the headers and may not grow at all.
TOLERANCE = {"Code and constants": 2.0, "Memory": 0.0, "Worst stack": 5.0, "Executed instructions": 2.0,
             "Executed instructions, yaw": 2.0, "Stack in use": 5.0}
SHRINKAGE = 0.75  # a figure below this part of the old one must be written down, or the measurement is broken
STACK_STEP = 16  # bytes; a register more in one function, on machines that align to 16, is no growth either

KIB = 1024
CODE, MEMORY, STACK, EXECUTED = range(4)  # places of the tables
STACK_BYTES = 1 * KIB  # what the library is promised


def cell(table, row, column):
    return lambda tables: tables[table].rows[row][tables[table].columns.index(column)]


def worst_stack(tables):
    return max(value for values in tables[STACK].rows.values() for value in values if value is not None)


def instructions_a_pixel(tables):
    return round(cell(EXECUTED, f"cortex-m4, default: {figures.WORST}", "worst frame")(tables) / figures.PIXELS, 2)


def ram_in_all(tables):
    """Everything that an instance with camera, CAN in both directions and yaw needs."""
    columns = ["state", "camera port", "CAN sender", "CAN receiver", "yaw (heading)"]
    return STACK_BYTES + sum(cell(MEMORY, "cortex-m4, small", column)(tables) for column in columns)


# Cortex-M4: (what, measured in the tables, limit)
SUMMARY = [
    ("code and constants, pose, -Os", cell(CODE, "cortex-m4, default: pose", "sum -Os"), 24 * KIB),
    ("code and constants, pose and yaw, -Os", cell(CODE, "cortex-m4, default: pose and yaw", "sum -Os"), 24 * KIB),
    ("state, default size", cell(MEMORY, "cortex-m4, default", "state"), 128 * KIB),
    ("state, small profile", cell(MEMORY, "cortex-m4, small", "state"), 40 * KIB),
    ("RAM in all, small profile: state, camera, CAN both ways, yaw, 1 KiB of stack", ram_in_all, 64 * KIB),
    ("executed instructions a pixel, -O2, worst frame of all fixtures", instructions_a_pixel, 25),
    ("stack of any public call, the worst of all cores", worst_stack, STACK_BYTES),
    ("executed instructions, small profile, -O2, worst frame of all fixtures",
     cell(EXECUTED, f"cortex-m4, small: {figures.WORST}", "worst frame"), None),
    ("code and constants with the optional tracker, -Os", cell(CODE, "cortex-m4, default: whole library", "sum -Os"), None),
]
BEGIN, END = "<!-- budgets: begin -->", "<!-- budgets: end -->"
COMMAND = "cmake --build build-host-tests --target budgets"


def shown(value):
    if value is None:
        return ""
    return f"{value:.2f}" if isinstance(value, float) else f"{value:,}".replace(",", " ")


def line(cells):
    return f"| {' | '.join(cells)} |"


def markdown(head, rows):
    return "\n".join([line(head), line(["---"] + ["---:"] * (len(head) - 1)), *map(line, rows)])


def render_table(table):
    rows = [[label, *map(shown, values)] for label, values in table.rows.items()]
    return f"## {table.title}\n\n{table.note}\n\n{markdown(['', *table.columns], rows)}\n"


def render_summary(tables):
    rows = [[what, shown(measured(tables)), "" if limit is None else shown(limit)] for what, measured, limit in SUMMARY]
    return markdown(["Cortex-M4, 640 x 480, bytes", "measured", "limit"], rows)


def render(tables, tools):
    """tools: the sentence that names compilers and emulator."""
    head = ("# Budgets\n\nGenerated: `" + COMMAND + "`. The tests measure again and fail when a figure has grown; "
            "shrinking is no fault, but write it down. Tolerances, because patch versions of the compiler choose other "
            "instructions for the same source: " + ", ".join(f"{name.lower()} {value:g} %" for name, value in TOLERANCE.items()) +
            f" (stack: or {STACK_STEP} bytes). The counts themselves are exact to a tick of the board's timer, 40 or 50 "
            f"instructions, and the same in every run. A figure that falls by more than {100 - SHRINKAGE * 100:g} % fails too, "
            f"until it is written down.\n\n{tools} One instruction a nanosecond.\n\n")
    return head + render_summary(tables) + "\n\n" + "\n".join(map(render_table, tables))


def number(cell_text):
    digits = cell_text.replace(" ", "")
    return None if not digits else float(digits) if "." in digits else int(digits)


def read_tables(text):
    """The tables that render() wrote, in order."""
    found = []
    for part in re.split(r"^## ", text, flags=re.MULTILINE)[1:]:
        rows = [[cell.strip() for cell in row.strip("|").split("|")] for row in part.splitlines() if row.startswith("|")]
        found.append(figures.Table(part.splitlines()[0], "", rows[0][1:],
                                   {row[0]: [number(cell) for cell in row[1:]] for row in rows[2:]}))
    return found


def read(text):
    """{(title, label, column): number} of every table under a title."""
    return figures_of(read_tables(text))


def figures_of(tables):
    return {(table.title, label, column): value for table in tables for label, values in table.rows.items()
            for column, value in zip(table.columns, values)}


def growth(committed, now):
    """What grew, vanished, appeared, or fell so far that it cannot be true."""
    complaints = []
    for (title, label, column), value in now.items():
        key = f"{title}, {label}, {column}"
        old = committed.get((title, label, column), "absent")
        if old == "absent":
            complaints.append(f"{key}: not in docs/budgets.md")
        elif (old is None) != (value is None):
            complaints.append(f"{key}: {value}, was {old}")
        elif value is not None and value > allowed(title, old):
            complaints.append(f"{key}: {value:g}, was {old:g}")
        elif value is not None and value < old * SHRINKAGE - STACK_STEP:
            complaints.append(f"{key}: {value:g}, was {old:g}: write it down, or find out why it is not counted any more")
    complaints += [f"{' '.join(key)}: in docs/budgets.md, but no longer measured" for key in committed if key not in now]
    return complaints


def allowed(title, old):
    limit = old * (1 + TOLERANCE[title] / 100)
    return max(limit, old + STACK_STEP) if "tack" in title else limit


def over_limits(tables):
    return [f"{what}: {measured(tables)} exceeds {limit}" for what, measured, limit in SUMMARY
            if limit is not None and measured(tables) > limit]


def summary_of(text):
    """The table between the marks of README.md."""
    between = re.search(f"{BEGIN}\n(.*?)\n{END}", text, re.DOTALL)
    return between.group(1).strip() if between else None


def untrue_summaries(committed, readme):
    """docs/budgets.md and README.md must show what the tables of docs/budgets.md say, no better."""
    try:
        summary = render_summary(read_tables(committed))
    except (IndexError, KeyError, ValueError):
        return ["docs/budgets.md lacks figures of its summary"]
    complaints = [] if f"\n\n{summary}\n\n" in committed else ["the summary of docs/budgets.md is not that of its tables"]
    return complaints if summary_of(readme) == summary else [*complaints, "README.md does not show the summary of docs/budgets.md"]


def text_of(path):
    return path.read_text(encoding="utf-8") if path.exists() else ""


def check(source, tables):
    committed = text_of(source / "docs/budgets.md")
    return (over_limits(tables) + growth(read(committed), figures_of(tables)) +
            untrue_summaries(committed, text_of(source / "README.md")))


def tools_of(machines):
    """The compilers and the emulator that measured."""
    chosen = [machine for machine in targets.MACHINES if machine.name in machines]
    compilers = {machine.compiler: archive.output_of(machine.compiler, "-dumpfullversion").strip() for machine in chosen}
    emulators = {machine.emulator[0]: re.search(r"version ([\d.]+)", archive.output_of(machine.emulator[0], "--version")).group(1)
                 for machine in chosen}
    return f"Measured with {', '.join(f'{name} {version}' for name, version in {**compilers, **emulators}.items())}."


def write(source, tables):
    (source / "docs").mkdir(exist_ok=True)
    (source / "docs/budgets.md").write_text(render(tables, tools_of(figures.MACHINES)), encoding="utf-8")
    readme = source / "README.md"
    text = text_of(readme)
    if summary_of(text) is not None:
        block = f"{BEGIN}\n{render_summary(tables)}\n{END}"
        readme.write_text(re.sub(f"{BEGIN}.*?{END}", lambda _: block, text, flags=re.DOTALL), encoding="utf-8")


def parse():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--source", required=True, help="the project")
    parser.add_argument("--folder", required=True, help="for the builds; kept")
    parser.add_argument("--fixtures", required=True)
    parser.add_argument("--write", action="store_true", help="write docs/budgets.md instead of comparing")
    return parser.parse_args()


def main():
    arguments = parse()
    source = pathlib.Path(arguments.source)
    try:
        tables = figures.measure(source, arguments.folder, arguments.fixtures)
    except (targets.Failure, call_stack.Fault) as fault:
        sys.exit(str(fault))
    print(render_summary(tables))
    if arguments.write:
        write(source, tables)
    complaints = over_limits(tables) if arguments.write else check(source, tables)
    if complaints:
        print("\n".join(complaints))
        sys.exit(f"again: sh host_tests/run.sh -R '^budgets$'; if it is meant to cost more: {COMMAND}")


if __name__ == "__main__":
    main()
