#!/usr/bin/env python3
"""roadpose-replay --can on a fake kernel whose calls fail: what is missing on the bus, what the user is told, and that the
poses are the same. With --candump as well, whose log has what the interface took."""
import errno
import os
import pathlib
import subprocess
import tempfile
import time
import unittest

import capture
import codec
import drive

REPLAY = os.environ["ROADPOSE_REPLAY_FAULTS"]
FRAMES = drive.FRAMES
FIRST = 31  # call of send or recv: the pose of row 10


class ReplayFaults(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name)
        cls.recording = drive.make(os.environ["ROADPOSE_FIXTURES"], cls.folder / "drive")
        cls.poses = cls.run_replay(cls.recording).stdout

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    @staticmethod
    def run_replay(*arguments, **environment):
        return subprocess.run([REPLAY, *arguments], capture_output=True, text=True, check=False,
                              env=os.environ | environment)

    def play(self, **environment):
        """What the user is told, line by line without the name of the program, and the log."""
        log = self.folder / "bus.log"
        result = self.run_replay("--can", "vcan0", "--speed", "0", "--candump", log, self.recording, **environment)
        self.assertEqual(0, result.returncode, result.stderr)
        self.assertEqual(self.poses, result.stdout, "the bus has no influence on the poses")
        told = [line.removeprefix("roadpose-replay: vcan0: ") for line in result.stderr.splitlines()]
        return told, log.read_text(encoding="ascii")

    def refuse(self, calls, reason):
        return self.play(ROADPOSE_REFUSED=f"{FIRST} {FIRST + calls - 1} {reason}")

    def expect_outage(self, played, rows, reason, counts, *meanwhile):
        """All of these rows, and nothing else, are missing; the counters tell receivers how many."""
        told, log = played
        missing = capture.missing_frames(log, self.poses)
        self.assertEqual([(row, index) for row in rows for index in range(3)], missing)
        lost = len(missing)
        self.assertEqual([f"down ({reason}); CAN frames are dropped until it is back", *meanwhile,
                          f"back; {lost} CAN frames dropped so far",
                          f"{3 * FRAMES - lost} CAN frames sent, {lost} dropped; {counts}"], told)

    def expect_no_gap(self, log):
        """A frame that found no room was never sent: the counters go on with the frames."""
        for message in codec.database().messages:
            counters = [data[1] & 0x0F for identifier, data in capture.frames_of(log) if identifier == message.frame_id]
            self.assertEqual([number % 15 for number in range(len(counters))], counters)

    def test_without_a_fault(self):
        told, log = self.play()
        self.assertEqual([], capture.missing_frames(log, self.poses))
        self.assertEqual([f"{3 * FRAMES} CAN frames sent, 0 dropped; down 0 times (bus-off 0), queue full 0 times"], told)

    def test_interface_down(self):
        """Two calls a cycle: the first may have told of an outage that is over."""
        self.expect_outage(self.refuse(30, errno.ENETDOWN), range(10, 25), os.strerror(errno.ENETDOWN),
                           "down 1 times (bus-off 0), queue full 0 times")

    def test_interface_gone(self):
        self.expect_outage(self.refuse(20, errno.ENXIO), range(10, 30), os.strerror(errno.ENXIO),
                           "down 1 times (bus-off 0), queue full 0 times")

    def test_bus_off_until_the_restart_is_told(self):
        """One call of recv reads of it, one more finds nothing else; then there is one a cycle."""
        self.expect_outage(self.play(ROADPOSE_BUS_OFF=f"{FIRST} {FIRST + 1 + 20}"), range(10, 30), "bus-off",
                           "down 1 times (bus-off 1), queue full 0 times")

    def test_bus_off_whose_end_is_never_told(self):
        """Two seconds after it was heard of, at the first recovery in row 11, the carrier decides."""
        self.expect_outage(self.play(ROADPOSE_BUS_OFF=f"{FIRST} {10 ** 6}"), range(10, 31), "bus-off",
                           "down 1 times (bus-off 1), queue full 0 times")

    def test_bus_off_while_down(self):
        """Down in rows 10 and 11, bus-off from row 12 (the 33rd call of recv) until row 23 (the 45th)."""
        played = self.play(ROADPOSE_REFUSED=f"{FIRST} {FIRST + 3} {errno.ENETDOWN}", ROADPOSE_BUS_OFF="33 45")
        self.expect_outage(played, range(10, 23), os.strerror(errno.ENETDOWN),
                           "down 1 times (bus-off 1), queue full 0 times", "bus-off")

    def test_queue_full_for_a_moment(self):
        told, log = self.refuse(5, errno.ENOBUFS)
        self.assertEqual(3 * FRAMES, len(capture.frames_of(log)))
        self.expect_no_gap(log)
        self.assertEqual([f"{3 * FRAMES} CAN frames sent, 0 dropped; down 0 times (bus-off 0), queue full 5 times"], told)

    def test_queue_full_for_cycles(self):
        """A cycle of 100 ms has room for 100 polls at most, so these calls fill two cycles at least."""
        told, log = self.refuse(300, errno.ENOBUFS)
        lost = 3 * FRAMES - len(capture.frames_of(log))
        self.assertGreaterEqual(lost, 6)
        self.expect_no_gap(log)
        self.assertEqual(["its queue is full; CAN frames are dropped until there is room",
                          f"its queue has room again; {lost} CAN frames dropped so far",
                          f"{3 * FRAMES - lost} CAN frames sent, {lost} dropped; down 0 times (bus-off 0), queue full "
                          "300 times"], told)

    def test_a_slow_recording_has_slow_cycles(self):
        """At 1 Hz there is a second to find room: more than these calls take."""
        slow = drive.make(os.environ["ROADPOSE_FIXTURES"], self.folder / "slow", count=12, rate_hz="1.0")
        result = self.run_replay("--can", "vcan0", "--speed", "0", slow,
                                 ROADPOSE_REFUSED=f"{FIRST} {FIRST + 149} {errno.ENOBUFS}")
        self.assertEqual("roadpose-replay: vcan0: 36 CAN frames sent, 0 dropped; down 0 times (bus-off 0), queue full 150 "
                         "times\n", result.stderr)

    def test_the_pace_of_the_recording(self):
        """Six frames at 10 Hz are five waits, unless --speed says otherwise."""
        quick = drive.make(os.environ["ROADPOSE_FIXTURES"], self.folder / "quick", count=6)
        for options, least in (([], 0.5), (["--speed", "2"], 0.25)):
            begin = time.monotonic()
            self.assertEqual(0, self.run_replay("--can", "vcan0", *options, quick).returncode)
            self.assertGreaterEqual(time.monotonic() - begin, least)

    def test_a_log_that_fails_does_not_stop_the_bus(self):
        if not os.path.exists("/dev/full"):
            self.skipTest("no /dev/full here")
        result = self.run_replay("--can", "vcan0", "--speed", "0", "--candump", "/dev/full", self.recording)
        self.assertEqual(1, result.returncode)
        self.assertEqual(self.poses, result.stdout)
        self.assertEqual([f"roadpose-replay: /dev/full: cannot be written: {os.strerror(errno.ENOSPC)}",
                          f"roadpose-replay: vcan0: {3 * FRAMES} CAN frames sent, 0 dropped; down 0 times (bus-off 0), "
                          "queue full 0 times"], result.stderr.splitlines())

    def test_a_kernel_without_can_is_a_fault(self):
        result = self.run_replay("--can", "vcan0", self.recording, ROADPOSE_NO_CAN="1")
        self.assertEqual((1, "", "roadpose-replay: vcan0: this system has no CAN sockets\n"),
                         (result.returncode, result.stdout, result.stderr))


if __name__ == "__main__":
    unittest.main()
