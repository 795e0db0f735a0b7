#!/usr/bin/env python3
"""roadpose-replay on a real SocketCAN: drive.sh plays a drive onto vcan0 and takes the interface away meanwhile; what
candump heard is compared with the CSV. In a network namespace where this kernel has virtual CAN, else in a virtual
machine (x86-64 only; exit status 77 elsewhere). Environment: ROADPOSE_REPLAY, ROADPOSE_FIXTURES, ROADPOSE_CAN_CODEC, and
ROADPOSE_VM_PARTS, the folder for what fetch.sh fetches, and ROADPOSE_STUCK_LINE; ROADPOSE_BUS_IN=vm or here decides
otherwise. A queue that is full is played in the virtual machine only."""
import os
import pathlib
import platform
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

import capture  # noqa: E402 (found by the line above)
import codec  # noqa: E402
import drive  # noqa: E402
import machine  # noqa: E402

REPLAY = os.environ["ROADPOSE_REPLAY"]
FRAMES = drive.FRAMES
ON_VCAN = ("steady", "down_and_up", "missing_at_first", "removed_and_back")


def kernel_has_can():
    """Whether a virtual CAN interface can be made in a network namespace of this kernel."""
    if not all(map(shutil.which, ("unshare", "ip", "candump"))):
        return False
    probe = ["unshare", "--net", "ip", "link", "add", "dev", "vcan0", "type", "vcan"]
    return subprocess.run(probe, capture_output=True, check=False).returncode == 0


def play_here(recording, output):
    subprocess.run(["unshare", "--net", "sh", HERE / "drive.sh", REPLAY, shutil.which("candump"), recording, output,
                    *ON_VCAN], check=True, stdout=subprocess.DEVNULL)


WHERE = os.environ.get("ROADPOSE_BUS_IN") or ("here" if kernel_has_can() else "vm")


def play(recording, work, output):
    print(f"on a bus in {'this kernel' if WHERE == 'here' else 'a virtual machine'}", flush=True)
    if WHERE == "here":
        play_here(recording, output)
    else:
        parts = os.environ["ROADPOSE_VM_PARTS"]
        subprocess.run(["sh", HERE / "fetch.sh", parts], check=True)
        machine.drive(parts, REPLAY, os.environ["ROADPOSE_STUCK_LINE"], recording, work, output)


class Bus(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        folder = pathlib.Path(cls.scratch.name)
        cls.output = folder / "output"
        cls.output.mkdir()
        recording = drive.make(os.environ["ROADPOSE_FIXTURES"], folder / "drive")
        play(recording, folder / "machine", cls.output)
        cls.poses = subprocess.run([REPLAY, recording], capture_output=True, text=True, check=True).stdout

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def text(self, scenario, kind):
        return (self.output / f"{scenario}.{kind}").read_text(encoding="ascii")

    def missing(self, scenario, profile=1):
        """Rows whose frames are not in the capture; every other byte on the bus is explained by the CSV."""
        self.assertEqual("0", self.text(scenario, "status").strip(), self.text(scenario, "txt"))
        self.assertEqual(self.poses, self.text(scenario, "csv"), "the bus has no influence on the poses")
        missing = capture.missing_frames(self.text(scenario, "log"), self.text(scenario, "csv"), profile)
        rows = capture.missing_rows(missing)
        print(f"{scenario}: {len(missing)} frames missing, rows {rows}\n{self.text(scenario, 'txt')}", end="", flush=True)
        self.assertIn(f"{3 * FRAMES - len(missing)} CAN frames sent, {len(missing)} dropped", self.text(scenario, "txt"))
        return rows

    def assert_windows(self, rows, *lengths):
        """The rows are as many windows without a hole as there are lengths, none longer than that says; on a machine that
        is busy with other things fewer frames fall into an outage, but one at least."""
        windows = [[rows[0]]] if rows else []
        for before, row in zip(rows, rows[1:]):
            if row == before + 1:
                windows[-1].append(row)
            else:
                windows.append([row])
        self.assertEqual(len(lengths), len(windows), rows)
        for window, length in zip(windows, lengths):
            self.assertLessEqual(len(window), 1.3 * length + 3, rows)

    def test_steady(self):
        self.assertEqual([], self.missing("steady"))

    def test_down_and_up(self):
        rows = self.missing("down_and_up")
        self.assert_windows(rows, 5, 17)
        self.assertNotIn(FRAMES - 1, rows)
        self.assertIn("down 2 times", self.text("down_and_up", "txt"))

    def test_missing_at_first(self):
        rows = self.missing("missing_at_first")
        self.assert_windows(rows, 23)
        self.assertEqual(0, rows[0])
        self.assertIn("no interface of this name", self.text("missing_at_first", "txt"))

    def test_removed_and_back(self):
        rows = self.missing("removed_and_back", profile=5)
        self.assert_windows(rows, 10)
        self.assertNotIn(FRAMES - 1, rows)


    @unittest.skipUnless(WHERE == "vm", "Linux makes the interface of a serial line outside of any network namespace")
    def test_full(self):
        """What the interface took is what went out, in order and without a gap of the counters, once there is room."""
        self.assertEqual("0", self.text("full", "status").strip(), self.text("full", "txt"))
        self.assertEqual(self.poses, self.text("full", "csv"), "the bus has no influence on the poses")
        told = self.text("full", "txt")
        print(f"full:\n{told}", end="")
        taken = capture.frames_of(self.text("full", "log"))
        line = [(int(text[1:4], 16), bytes.fromhex(text[5:])) for text in self.text("full", "line").split()
                if text.startswith("t")]
        self.assertEqual(taken, line)
        self.assertIn("its queue is full; CAN frames are dropped until there is room", told)
        self.assertIn("its queue has room again", told)
        self.assertIn(f"{len(taken)} CAN frames sent, {3 * FRAMES - len(taken)} dropped; down 0 times", told)
        for message in codec.database().messages:
            counters = [data[1] & 0x0F for identifier, data in taken if identifier == message.frame_id]
            self.assertEqual([number % 15 for number in range(len(counters))], counters)
        counts = [codec.codes(codec.database().messages[2], data)["FrameCount"] for identifier, data in taken
                  if identifier == 0x3D2]
        self.assertEqual(sorted(set(counts)), counts, "an old pose after a newer one")
        self.assertEqual(FRAMES, counts[-1])


if __name__ == "__main__":
    if WHERE == "vm" and platform.machine() != "x86_64":
        print("no CAN in this kernel, and the virtual machine is for x86-64")
        sys.exit(77)
    unittest.main()
