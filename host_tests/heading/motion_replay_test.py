#!/usr/bin/env python3
"""motion_replay_test.py PROGRAM FIXTURES: roadpose-replay on recordings with motion, whole and damaged."""
import csv
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM = FIXTURES = None


def run(folder):
    return subprocess.run([PROGRAM, str(folder)], capture_output=True, text=True, errors="replace", check=False)


def rows_of(path):
    with open(path, newline="", encoding="ascii") as file:
        return list(csv.DictReader(file))


def play(folder):
    result = run(folder)
    if result.returncode or result.stderr:
        raise AssertionError(f"exit status {result.returncode}: {PROGRAM} {folder}\n{result.stderr}")
    return list(csv.DictReader(result.stdout.splitlines()))


def numbers(rows, column):
    return [float(row[column]) for row in rows if row[column]]


def reference_focus(tracks, still, focus):
    """Least squares on the true matches, each weighed as 1 / (r / L)^2."""
    for _ in range(5):
        a = b = c = p = q = 0.0
        for t, s in zip(tracks, still):
            if s["still"] != "1":
                continue
            u0, v0, u1, v1 = (float(t[name]) for name in ("u0", "v0", "u1", "v1"))
            dx, dy, mx, my = u1 - u0, v1 - v0, (u0 + u1) / 2, (v0 + v1) / 2
            w = 1 / ((mx - focus[0]) ** 2 + (my - focus[1]) ** 2 + 1e-12)
            along = -dy * mx + dx * my
            a += w * dy * dy
            b -= w * dx * dy
            c += w * dx * dx
            p -= w * dy * along
            q += w * dx * along
        focus = ((c * p - b * q) / (a * c - b * b), (a * q - b * p) / (a * c - b * b))
    return focus


def yaw_of_focus(focus, truth):
    pitch, roll = (math.radians(float(truth[name])) for name in ("pitch_deg", "roll_deg"))
    n = (math.cos(pitch) * math.sin(roll), math.cos(pitch) * math.cos(roll), math.sin(pitch))
    t = ((focus[0] - 319.5) / 500, (focus[1] - 239.5) / 500, 1.0)
    along = sum(x * y for x, y in zip(t, n))
    return math.degrees(math.atan2(n[1] * t[0] - n[0] * t[1], t[2] - along * n[2]))


class Fixtures(unittest.TestCase):
    def check_straight(self, name):
        folder = FIXTURES / name
        truth, rows = rows_of(folder / "truth.csv"), play(folder)
        self.assertEqual("few_tracks", rows[0]["yaw_status"])
        self.assertEqual("", rows[0]["yaw_deg"])
        errors, references = [], []
        for row, true in list(zip(rows, truth))[1:]:
            if row["yaw_status"] != "ok":
                self.assertEqual("", row["yaw_deg"])
                continue
            frame = f"{int(row['frame']):06}.csv"
            focus = reference_focus(rows_of(folder / "tracks" / frame), rows_of(folder / "still" / frame), (319.5, 239.5))
            references.append(abs(yaw_of_focus(focus, true) - float(true["yaw_deg"])))
            errors.append(abs(float(row["yaw_deg"]) - float(true["yaw_deg"])))
        error, reference = sum(errors) / len(errors), sum(references) / len(references)
        print(f"\n{name}: {len(errors)} of {len(rows) - 1} accepted, mean error {error:.3f} deg, reference {reference:.3f}")
        self.assertGreaterEqual(len(errors), 30)
        self.assertLessEqual(error, 1.5 * reference)
        self.assertLessEqual(error, 0.2)
        self.assertLessEqual(sum(e > 0.8 for e in errors), 0.02 * len(errors))
        for row in rows:
            if row["running_frames"] and int(row["running_frames"]) >= 30:
                self.assertLessEqual(abs(float(row["running_yaw_deg"]) - float(truth[0]["yaw_deg"])), 0.05)

    def test_straight_with_vehicle(self):
        self.check_straight("yaw-left")

    def test_straight_from_tracks_alone(self):
        self.check_straight("yaw-right")

    def test_winding(self):
        folder = FIXTURES / "yaw-winding"
        straight = accepted = 0
        for row, true in list(zip(play(folder), rows_of(folder / "truth.csv")))[1:]:
            if abs(float(true["yaw_rate_deg_s"])) > 5:
                self.assertEqual("turning", row["yaw_status"], row)
                continue
            straight += 1
            accepted += row["yaw_status"] == "ok"
        print(f"\nyaw-winding: {accepted} of {straight} straight frames accepted, none in the bends")
        self.assertGreaterEqual(accepted, 0.8 * straight)

    def test_images(self):
        folder = FIXTURES / "yaw-images"
        rows, truth = play(folder), rows_of(folder / "truth.csv")
        yaws = numbers(rows, "yaw_deg")
        error = sum(abs(y - float(truth[0]["yaw_deg"])) for y in yaws) / len(yaws)
        print(f"\nyaw-images: {len(yaws)} of {len(rows) - 1} accepted, mean error {error:.3f} deg")
        self.assertGreaterEqual(len(yaws), 0.8 * (len(rows) - 1))
        self.assertLessEqual(error, 0.2)

    def test_pitch_of_motion(self):
        for row in play(FIXTURES / "yaw-winding"):
            if row["yaw_status"] == "ok":
                self.assertAlmostEqual(float(row["pitch_deg"]),
                                       float(row["pitch_motion_deg"]) + float(row["pitch_difference_deg"]), delta=1e-4)

    def test_no_motion_no_yaw(self):
        for row in play(FIXTURES / "level"):
            self.assertEqual(("", "", ""), (row["yaw_deg"], row["yaw_status"], row["running_yaw_deg"]))


class Damaged(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="roadpose-motion-")) / "drive"
        self.addCleanup(shutil.rmtree, self.folder.parent)

    def copy(self, name):
        shutil.copytree(FIXTURES / name, self.folder, symlinks=True)

    def refuse(self, file, *words):
        result = run(self.folder)
        self.assertEqual(3, result.returncode, result.stderr)
        self.assertEqual(1, result.stderr.count("\n"), result.stderr)
        for word in (file, *words):
            self.assertIn(word, result.stderr)

    def check_tracks(self, text, *words):
        self.folder = self.folder.parent / f"drive{len(list(self.folder.parent.iterdir()))}"
        self.copy("yaw-left")
        (self.folder / "tracks" / "000002.csv").write_bytes(text)
        self.refuse("tracks/000002.csv", *words)

    def test_tracks(self):
        self.check_tracks(b"", "is empty")
        self.check_tracks(b"1,2,3,4\n", "line 1", "not u0")
        self.check_tracks(b"u0,v0,u1\n", "line 1", "not v1")
        self.check_tracks(b"u0,v0,u1,v1\n1,2,3\n", "line 2", "has no v1")
        for number in (b"nan", b"inf", b"-", b"1.2.3", b"0x10", b"", b"1e", b"\xff"):
            self.check_tracks(b"u0,v0,u1,v1\n1,2,3,4\n1,2," + number + b",4\n", "line 3", "u1", "is not a number")
        self.check_tracks(b"u0,v0,u1,v1\n" + b"1" * 5000 + b"\n", "line 2")
        self.check_tracks(b"u0,v0,u1,v1\n1,2,3,4\0\n", "line 2")

    def test_tracks_that_are_a_folder(self):
        self.copy("yaw-left")
        (self.folder / "tracks" / "000002.csv").unlink()
        (self.folder / "tracks" / "000002.csv").mkdir()
        self.refuse("tracks/000002.csv", "cannot be read")

    def test_numbers_beyond_all_limits_are_no_fault(self):
        self.copy("yaw-left")
        wild = "u0,v0,u1,v1\n" + "1e300,-1e300,99999999999999999999,0\n" * 50 + "-0,1e-300,+5.5,.5\n"
        for path in (self.folder / "tracks").iterdir():
            path.write_text(wild, encoding="ascii")
        self.assertTrue(all(row["yaw_status"] == "few_tracks" for row in play(self.folder)))

    def test_missing_tracks_of_a_frame(self):
        self.copy("yaw-left")
        (self.folder / "tracks" / "000004.csv").unlink()
        self.assertEqual("few_tracks", play(self.folder)[4]["yaw_status"])

    def test_vehicle(self):
        self.copy("yaw-left")
        path, header = self.folder / "vehicle.csv", "frame,time_s,speed_m_s,yaw_rate_deg_s\n"
        for text, word in (("", "is empty"), ("frame,time_s\n", "not speed_m_s"), (header + "0,0,x,0\n", "speed_m_s"),
                           (header + "1,0,9,0\n0,1,9,0\n", "does not rise"), (header + "-1,0,9,0\n", "frame"),
                           (header + "0,0,9,0\n1,0,9,0\n", "time_s"), (header + "0,5,9,0\n1,4,9,0\n", "time_s"),
                           (header + "0,0,9,0\n1,60,9,0\n", "time_s")):
            path.write_text(text, encoding="ascii")
            self.refuse("vehicle.csv", word)
        path.write_text(header + "0,,,\n1,,,\n2,0.2,12,0\n3,0.3,,0\n", encoding="ascii")
        self.assertEqual(41, len(play(self.folder)))

    def test_vehicle_gates(self):
        self.copy("yaw-left")
        lines = ["frame,time_s,speed_m_s,yaw_rate_deg_s"]
        lines += [f"{i},{i / 10},{2 if i < 10 else 12},{6 if 20 <= i < 30 else 0}" for i in range(41)]
        (self.folder / "vehicle.csv").write_text("\n".join(lines) + "\n", encoding="ascii")
        rows = play(self.folder)
        self.assertEqual({"slow"}, {row["yaw_status"] for row in rows[1:10]})
        self.assertEqual({"turning"}, {row["yaw_status"] for row in rows[21:30]})
        self.assertIn("ok", {row["yaw_status"] for row in rows[31:]})

    def test_images(self):
        self.copy("yaw-images")
        image = self.folder / "left" / "000003.pgm"
        whole = image.read_bytes()
        for damaged, word in ((whole[:-1], "truncated"), (whole + b"x", "longer"), (b"P5\n320 239\n255\n", "320 x 239"),
                              (b"P5\n320 240\n65535\n", "maxval"), (b"", "empty")):
            image.write_bytes(damaged)
            self.refuse("left/000003.pgm", word)

    def test_without_an_image_for_every_frame_there_is_no_yaw(self):
        self.copy("yaw-images")
        (self.folder / "left" / "000003.pgm").unlink()
        self.assertEqual({""}, {row["yaw_status"] for row in play(self.folder)})


class RealDrives(unittest.TestCase):
    """What visual odometry says of straight-motion, camera 0.47 deg to the right, is 0.2 deg more than the directions of
    flow say: docs/heading.md explains. The test holds what is asked for and what is known."""

    def play(self, name):
        folder = os.environ.get("ROADPOSE_RECORDINGS")
        if not folder:
            self.skipTest("ROADPOSE_RECORDINGS is not set: no real drive was played")
        return play(pathlib.Path(folder) / name)

    def test_straight_motion(self):
        rows = self.play("straight-motion")
        last = numbers(rows[-20:], "running_yaw_deg")
        print(f"\nstraight-motion: {len(numbers(rows, 'yaw_deg'))} accepted, running yaw {last[-1]:.3f} deg, "
              f"spread over the last 20 frames {max(last) - min(last):.3f}, pitch of motion "
              f"{sum(numbers(rows, 'pitch_motion_deg')) / len(numbers(rows, 'pitch_motion_deg')):.3f}")
        self.assertEqual(20, len(last))
        self.assertLessEqual(max(last) - min(last), 0.1)
        self.assertTrue(-0.54 <= last[-1] <= -0.15, last[-1])

    def test_street_lidar(self):
        rows = self.play("street-lidar")
        posed = [row for row in rows[1:35] if row["status"] == "ok"]
        accepted = numbers(posed, "yaw_deg")
        print(f"\nstreet-lidar, straight part: yaw in {len(accepted)} of {len(posed)} frames with a pose, running "
              f"{rows[-1]['running_yaw_deg']} deg")
        self.assertGreaterEqual(len(accepted), 0.8 * len(posed))


if __name__ == "__main__":
    PROGRAM, FIXTURES = sys.argv[1], pathlib.Path(sys.argv[2])
    result = unittest.main(argv=[sys.argv[0], "-v"], exit=False).result
    sys.exit(0 if result.wasSuccessful() else 1)
