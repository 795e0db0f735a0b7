#!/usr/bin/env python3
"""roadpose-replay --candump over a drive of all fixtures: every frame of the log is the one that the CSV predicts."""
import os
import pathlib
import subprocess
import tempfile
import time
import unittest

import capture
import drive

REPLAY = os.environ["ROADPOSE_REPLAY"]
LISTEN = os.environ["ROADPOSE_LISTEN"]
FIXTURES = os.environ["ROADPOSE_FIXTURES"]


def run(*arguments, expect=0, **more):
    result = subprocess.run(arguments, capture_output=True, text=True, check=False, **more)
    if result.returncode != expect:
        raise AssertionError(f"{' '.join(map(str, arguments))}: exit status {result.returncode}\n{result.stderr}")
    return result


class ReplayLog(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name)
        cls.recording = drive.make(FIXTURES, cls.folder / "drive")
        cls.poses = run(REPLAY, cls.recording).stdout

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def test_every_frame_in_every_profile(self):
        for profile in (1, 2, 5):
            log = self.folder / f"profile{profile}.log"
            result = run(REPLAY, "--candump", log, "--e2e", str(profile), self.recording)
            self.assertEqual(self.poses, result.stdout, "the log does not change what is printed")
            self.assertEqual("", result.stderr)
            text = log.read_text(encoding="ascii")
            self.assertEqual(3 * drive.FRAMES, len(text.splitlines()))
            self.assertEqual([], capture.missing_frames(text, self.poses, profile))

    def test_yaw_and_its_status(self):
        seen = set()
        for name in ("yaw-left", "yaw-right", "yaw-winding"):
            recording = pathlib.Path(FIXTURES) / name
            poses = run(REPLAY, recording).stdout
            log = run(REPLAY, "--candump", "-", recording).stdout
            self.assertEqual([], capture.missing_frames(log, poses), name)
            seen |= {row["yaw_status"] for row in capture.csv.DictReader(poses.splitlines()) if row["yaw_status"]}
        self.assertIn("ok", seen)
        self.assertGreater(len(seen), 1, "no yaw was ever refused")

    def test_a_log_on_standard_output_is_all_there_is(self):
        log = run(REPLAY, "--candump", "-", self.recording).stdout
        self.assertEqual([], capture.missing_frames(log, self.poses))

    def test_times_are_those_of_the_recording(self):
        log = run(REPLAY, "--candump", "-", self.recording).stdout.splitlines()
        self.assertTrue(log[0].startswith("(0000000000.000000) can0 3D0#"))
        self.assertTrue(log[-1].startswith("(0000000005.900000) can0 3D2#"))

    def test_a_listener_sees_the_poses(self):
        log = run(REPLAY, "--candump", "-", self.recording).stdout
        heard = list(capture.csv.DictReader(run(LISTEN, input=log).stdout.splitlines()))
        rows = list(capture.csv.DictReader(self.poses.splitlines()))
        self.assertEqual([row["status"] for row in rows], [row["status"] for row in heard])
        for sent, got in zip(rows, heard):
            for column, most in (("pitch_deg", 0.0031), ("roll_deg", 0.0031), ("height_m", 0.00063)):
                self.assertEqual(sent[column] == "", got[column] == "")
                if sent[column]:
                    self.assertLessEqual(abs(float(sent[column]) - float(got[column])), most)
        self.assertEqual({"initial/initial/initial", "ok/ok/ok"}, {row["e2e"] for row in heard})

    def heard_without(self, *lost):
        """What a listener makes of the log when these lines, counted from 0, are lost: [(pitch, e2e)]."""
        log = run(REPLAY, "--candump", "-", self.recording).stdout.splitlines(keepends=True)[:15]
        left = "".join(line for number, line in enumerate(log) if number not in lost)
        rows = capture.csv.DictReader(run(LISTEN, input=left).stdout.splitlines())
        return [(row["pitch_deg"], row["e2e"]) for row in rows]

    def test_a_listener_has_a_line_for_every_cycle(self):
        whole = self.heard_without()
        fine = ["initial/initial/initial"] + ["ok/ok/ok"] * 4
        self.assertEqual(fine, [e2e for _, e2e in whole])
        losses = {6: ["no_new_data/ok/ok", "some_lost/ok/ok"], 7: ["ok/no_new_data/ok", "ok/some_lost/ok"],
                  8: ["ok/ok/no_new_data", "ok/ok/some_lost"]}
        for lost, words in losses.items():
            heard = self.heard_without(lost)
            self.assertEqual(fine[:2] + words + fine[4:], [e2e for _, e2e in heard])
            pitch = [pitch for pitch, _ in whole]
            pitch[2] = pitch[1] if lost == 6 else pitch[2]  # held
            self.assertEqual(pitch, [pitch for pitch, _ in heard])
        self.assertEqual(fine[:4] + ["ok/ok/no_new_data"], [e2e for _, e2e in self.heard_without(14)])

    def test_a_listener_forgets_in_a_long_silence(self):
        log = run(REPLAY, "--candump", "-", self.recording).stdout.splitlines(keepends=True)
        heard = list(capture.csv.DictReader(run(LISTEN, input="".join(log[:6] + log[16:18])).stdout.splitlines()))
        self.assertEqual(("ok", "", ""), tuple(heard[2][name] for name in ("status", "pitch_deg", "height_m")))
        self.assertEqual("no_new_data/some_lost/some_lost", heard[2]["e2e"])

    def test_a_listener_that_cannot_read_or_write_says_so(self):
        self.assertIn(str(self.folder), run(LISTEN, self.folder, expect=3).stderr)
        if os.path.exists("/dev/full"):
            with open("/dev/full", "w", encoding="ascii") as full:
                result = subprocess.run([LISTEN], input="", stdout=full, stderr=subprocess.PIPE, text=True, check=False)
            self.assertEqual(1, result.returncode)
            self.assertIn("cannot be written", result.stderr)

    def test_the_comparison_finds_what_is_wrong(self):
        lines = run(REPLAY, "--candump", "-", self.recording).stdout.splitlines(keepends=True)
        flipped = lines[40].rstrip("\n")
        flipped = flipped[:-1] + ("0" if flipped[-1] != "0" else "1") + "\n"
        for damage in (lines[:40] + [flipped] + lines[41:], lines[:40] + lines[41:], lines[:41] + lines[40:],
                       lines[:40] + [lines[41], lines[40]] + lines[42:]):
            self.assertRaises(AssertionError, capture.missing_frames, "".join(damage), self.poses)
        self.assertEqual([(59, 0), (59, 1), (59, 2)], capture.missing_frames("".join(lines[:-3]), self.poses))

    def test_speed(self):
        quick = drive.make(FIXTURES, self.folder / "quick", count=6)
        begin = time.monotonic()
        run(REPLAY, "--speed", "1", "--candump", self.folder / "quick.log", quick)
        self.assertGreaterEqual(time.monotonic() - begin, 0.5)  # six frames at 10 Hz: five waits

    def test_what_cannot_be_written_is_a_fault(self):
        result = run(REPLAY, "--candump", self.folder / "no" / "such.log", self.recording, expect=1)
        self.assertIn("cannot be written", result.stderr)
        if os.path.exists("/dev/full"):
            result = run(REPLAY, "--candump", "/dev/full", self.recording, expect=1)
            self.assertIn("/dev/full: cannot be written", result.stderr)

    def test_bad_arguments(self):
        for arguments in (["--e2e", "3"], ["--e2e", "6"], ["--can"], ["--can", ""], ["--can", "x" * 16], ["--candump"],
                          ["--speed", "-1"], ["--speed", "fast"], ["--speed", "1001"]):
            result = run(REPLAY, *arguments, expect=2)
            self.assertIn("--help", result.stderr)
        for profile in ("3", "257", "1x", "", "01"):
            self.assertIn("usage", run(LISTEN, "--profile", profile, expect=2).stderr)
        self.assertIn("usage", run(LISTEN, "--help").stdout)
        self.assertIn("no-such", run(LISTEN, "no-such.log", expect=3).stderr)


if __name__ == "__main__":
    unittest.main()
