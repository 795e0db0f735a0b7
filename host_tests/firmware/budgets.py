#!/usr/bin/env python3
"""What the library costs: measures it on every microcontroller, and writes docs/budgets.md (--write) or compares with it.

Comparing fails when a figure grew beyond its tolerance, when a limit is exceeded, when the file lacks a figure, or when
README.md does not show the same summary."""
import argparse
import pathlib
import re
import sys

import call_stack
import figures
import targets

# Growth that is no fault, in percent. Sizes and counts follow the compiler: a patch version of it, or of the C library's
# memset, may choose other instructions for the same source. State is fixed by the headers and may not grow at all.
TOLERANCE = {"Code and constants": 2.0, "Memory": 0.0, "Worst stack": 5.0, "Executed instructions": 2.0}
STACK_STEP = 16  # bytes; a register more in one function, on machines that align to 16, is no growth either

# Cortex-M4: (what, table, row, column, limit)
KIB = 1024
LIMITS = [
    ("code and constants, pose, -Os", 0, "cortex-m4, default: pose", 2, 24 * KIB),
    ("code and constants, pose and yaw, -Os", 0, "cortex-m4, default: pose and yaw", 2, 24 * KIB),
    ("state, default size", 1, "cortex-m4, default", 0, 128 * KIB),
    ("state, small profile", 1, "cortex-m4, small", 0, 40 * KIB),
    ("executed instructions a pixel, -O2, worst frame", 3, None, None, 25),
    ("stack of any public call, the worst of all cores", 2, None, None, 1 * KIB),
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


def measured(tables, limit):
    what, table, row, column, _ = limit
    if row:
        return tables[table].rows[row][column]
    if what.startswith("stack"):
        return max(value for values in tables[table].rows.values() for value in values if value is not None)
    worst = max(values[2] for label, values in tables[table].rows.items() if label.startswith("cortex-m4, default"))
    return round(worst / figures.PIXELS, 2)


def render_summary(tables):
    rows = [[limit[0], shown(measured(tables, limit)), shown(limit[4])] for limit in LIMITS]
    small = max(values[0] for label, values in tables[3].rows.items() if label.startswith("cortex-m4, small"))
    rows.append(["executed instructions a frame, small profile, -O2", shown(small), ""])
    whole = tables[0].rows["cortex-m4, default: whole library"][2]
    rows.append(["code and constants with the optional tracker, -Os", shown(whole), ""])
    return markdown(["Cortex-M4, 640 x 480, bytes", "measured", "limit"], rows)


def render(tables):
    head = ("# Budgets\n\nGenerated: `" + COMMAND + "`. The tests measure again and fail when a figure has grown; "
            "shrinking is no fault, but write it down. Tolerances, because patch versions of the compiler choose other "
            "instructions for the same source: " + ", ".join(f"{name.lower()} {value:g} %" for name, value in TOLERANCE.items()) +
            f" (stack: or {STACK_STEP} bytes). The counts themselves are exact to a tick of the board's timer, 40 or 50 "
            "instructions, and the same in every run.\n\nCompilers: Debian 12, gcc 12.2. Emulator: QEMU 7.2, one instruction a "
            "nanosecond.\n\n")
    return head + render_summary(tables) + "\n\n" + "\n".join(map(render_table, tables))


def read(text):
    """{(title, label, column): number} of every table under a title."""
    found = {}
    for part in re.split(r"^## ", text, flags=re.MULTILINE)[1:]:
        title = part.splitlines()[0]
        rows = [[cell.strip() for cell in row.strip("|").split("|")] for row in part.splitlines() if row.startswith("|")]
        for row in rows[2:]:
            for column, cell in zip(rows[0][1:], row[1:]):
                found[title, row[0], column] = float(cell.replace(" ", "")) if cell else None
    return found


def growth(committed, now):
    complaints = []
    for (title, label, column), value in now.items():
        old = committed.get((title, label, column), "absent")
        if old == "absent":
            complaints.append(f"{title}, {label}, {column}: not in docs/budgets.md")
        elif value is not None and value > allowed(title, old or 0):
            complaints.append(f"{title}, {label}, {column}: {value:g}, was {old or 0:g}")
    complaints += [f"{' '.join(key)}: in docs/budgets.md, but no longer measured" for key in committed if key not in now]
    return complaints


def allowed(title, old):
    limit = old * (1 + TOLERANCE[title] / 100)
    return max(limit, old + STACK_STEP) if title == "Worst stack" else limit


def over_limits(tables):
    return [f"{limit[0]}: {measured(tables, limit)} exceeds {limit[4]}" for limit in LIMITS if measured(tables, limit) > limit[4]]


def summary_of(text):
    """The table between the marks, or before the first title."""
    between = re.search(f"{BEGIN}\n(.*?)\n{END}", text, re.DOTALL)
    return between.group(1).strip() if between else None


def check(source, tables):
    path = source / "docs/budgets.md"
    committed = path.read_text(encoding="utf-8") if path.exists() else ""
    complaints = over_limits(tables) + growth(read(committed), read(render(tables)))
    readme = summary_of((source / "README.md").read_text(encoding="utf-8")) if (source / "README.md").exists() else None
    if readme is not None and readme not in committed:
        complaints.append("README.md does not show the summary of docs/budgets.md")
    return complaints


def write(source, tables):
    (source / "docs").mkdir(exist_ok=True)
    (source / "docs/budgets.md").write_text(render(tables), encoding="utf-8")
    readme = source / "README.md"
    text = readme.read_text(encoding="utf-8") if readme.exists() else ""
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
