"""Instructions that our library and the peers execute for a frame, as CSV on standard output.

    count_instructions.py PROGRAM FOLDER RECORDING FRAME... [-- RECORDING FRAME...]

PROGRAM is roadpose-count; FOLDER takes what callgrind writes."""
import csv
import subprocess
import sys
from pathlib import Path


def total_of(path):
    for line in path.read_text().splitlines():
        if line.startswith("summary:"):
            return int(line.split()[1])
    raise RuntimeError(f"{path} has no total")


def counts_of(program, folder, arguments):
    """(recording, frame, candidate, instructions) of one run of the program."""
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("counted.*"):
        old.unlink()
    ran = subprocess.run(["valgrind", "--quiet", "--tool=callgrind", "--instr-atstart=no",
                          f"--callgrind-out-file={folder}/counted", program, *arguments],
                         check=True, stdout=subprocess.PIPE, text=True)
    for number, line in enumerate(csv.reader(ran.stdout.splitlines()), 1):
        yield *line, total_of(folder / f"counted.{number}")


def main():
    program, folder, *rest = sys.argv[1:]
    writer = csv.writer(sys.stdout)
    writer.writerow(["recording", "frame", "candidate", "instructions"])
    while rest:
        end = rest.index("--") if "--" in rest else len(rest)
        writer.writerows(counts_of(program, Path(folder), rest[:end]))
        rest = rest[end + 1:]


if __name__ == "__main__":
    main()
