#!/usr/bin/env python3
"""What the C code packs is what cantools reads with the DBC: random values, the ends of the ranges and of the types."""
import math
import unittest
from fractions import Fraction

import codec
from codec import DEGREES, exact

RANDOM_VALUES = 4000
INT32 = (-2**31, 2**31 - 1)

# Field by field in the order of the codec's command: signal, bit of valid, ends of the C type, physical unit of 1.
FIELDS = {
    "pose": [("Pitch", 1, INT32, DEGREES), ("Roll", 2, INT32, DEGREES), ("Height", 4, INT32, Fraction(1, 10**6))],
    "quality": [("Yaw", 1, INT32, DEGREES), ("Support", 2, (0, 2**16 - 1), Fraction(1, 10)),
                ("Residual", 4, (0, 2**16 - 1), Fraction(1, 1000)), ("RangeNear", 8, (0, 2**32 - 1), Fraction(1, 1000)),
                ("RangeFar", 16, (0, 2**32 - 1), Fraction(1, 1000))],
}
COUNTS = ["FrameCount", "RefusedCount", "OverwrittenCount", "DroppedCount"]


class Codec(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.messages = [codec.database().get_message_by_name(name) for name in codec.MESSAGES]

    def interesting(self, random, signal, ends, unit):
        """One value: in the range, at its ends, at the edge between two codes, or anywhere in the type."""
        low, high = (exact(signal.minimum) / unit, exact(signal.maximum) / unit)
        edge = (exact(signal.offset) + (random.randrange(2**signal.length) + Fraction(1, 2)) * exact(signal.scale)) / unit
        step = exact(signal.scale) / unit
        choices = [random.uniform(float(low), float(high)), low - random.random() * step, high + random.random() * step,
                   edge + random.randint(-1, 1), random.randint(*ends), ends[0], ends[1], 0]
        value = math.floor(random.choice(choices) + Fraction(1, 2))
        return min(max(value, ends[0]), ends[1])

    def check_fields(self, kind, message):
        random = codec.seeded(kind)
        cases = []
        for _ in range(RANDOM_VALUES):
            values = [self.interesting(random, message.get_signal_by_name(name), ends, unit)
                      for name, _, ends, unit in FIELDS[kind]]
            cases.append((random.choice([255, 255, random.randrange(256)]), values))
        answers = codec.run([f"{kind} {valid} " + " ".join(map(str, values)) for valid, values in cases])
        for (valid, values), answer in zip(cases, answers):
            found = codec.codes(message, bytes.fromhex(answer))
            for (name, bit, _, unit), value in zip(FIELDS[kind], values):
                signal = message.get_signal_by_name(name)
                code = codec.expected_code(signal, value * unit) if valid & bit else codec.invalid_code(signal)
                self.assertEqual(code, found[name], f"{name} of {value}, valid {valid}: {answer}")
            self.assertEqual("000000", answer[:6], "the header is left to E2E")

    def test_pose(self):
        self.check_fields("pose", self.messages[0])

    def test_quality(self):
        self.check_fields("quality", self.messages[1])

    def test_status(self):
        random = codec.seeded("status")
        cases = []
        for _ in range(RANDOM_VALUES):
            counts = [random.choice([random.randrange(600), random.randrange(2**32), 2**32 - 1]) for _ in COUNTS]
            cases.append([random.randrange(256), random.randrange(20), random.randrange(20), *counts])
        answers = codec.run(["status " + " ".join(map(str, case)) for case in cases])
        for (valid, pose_status, yaw_status, *counts), answer in zip(cases, answers):
            found = codec.codes(self.messages[2], bytes.fromhex(answer))
            self.assertEqual(min(pose_status, 15), found["PoseStatus"])
            self.assertEqual(min(yaw_status, 15), found["YawStatus"])
            for bit, (name, count) in enumerate(zip(COUNTS, counts)):
                self.assertEqual(count % 255 if valid >> bit & 1 else 255, found[name], name)

    def test_invalid_is_named_by_the_dbc(self):
        answers = codec.run(["pose 0 0 0 0", "quality 0 0 0 0 0 0", "status 0 15 15 0 0 0 0"])
        for message, answer in zip(self.messages, answers):
            for name, value in message.decode(bytes.fromhex(answer)).items():
                if not codec.is_header(message.get_signal_by_name(name)):
                    self.assertEqual("invalid", str(value), name)

    def test_decoded_values_have_the_sign_and_size_of_the_input(self):
        pose, quality = codec.run([f"pose 7 {round(math.radians(2.5) * 1e6)} {round(math.radians(-7.125) * 1e6)} 1500000",
                                   f"quality 31 {round(math.radians(-0.46) * 1e6)} 873 210 3500 24600"])
        self.assertEqual({"Pitch": 2.5, "Roll": -7.125, "Height": 1.5}, self.rounded(0, pose))
        self.assertEqual({"Yaw": -0.46, "Support": 87, "Residual": 0.2, "RangeNear": 3.5, "RangeFar": 25},
                         self.rounded(1, quality))

    def rounded(self, index, answer):
        decoded = self.messages[index].decode(bytes.fromhex(answer))
        return {name: round(value, 6) for name, value in decoded.items()
                if not codec.is_header(self.messages[index].get_signal_by_name(name))}

    def test_random_frames_return(self):
        """unpack and pack again: the same codes, and the invalid code for those that no sender sends."""
        random = codec.seeded("again")
        frames = [(message, bytes([0, 0, 0]) + random.randbytes(5)) for _ in range(RANDOM_VALUES) for message in range(3)]
        answers = codec.run([f"again {message} {frame.hex()}" for message, frame in frames])
        for (index, frame), answer in zip(frames, answers):
            message = self.messages[index]
            before, after = codec.codes(message, frame), codec.codes(message, bytes.fromhex(answer))
            for signal in message.signals:
                last = (exact(signal.maximum) - exact(signal.offset)) / exact(signal.scale)
                expected = before[signal.name] if before[signal.name] <= last else codec.invalid_code(signal)
                self.assertEqual(expected, after[signal.name], signal.name)


if __name__ == "__main__":
    unittest.main()
