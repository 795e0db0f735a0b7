#!/usr/bin/env python3
"""Checksums and counters against the PyPI package autosar-e2e, both ways, for random frames in every profile."""
import unittest

import e2e.p01
import e2e.p02
import e2e.p05

import codec
import oracle
from oracle import DATA_ID, LARGEST

FRAMES = 600


class Oracle(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.lists = oracle.lists()

    def check(self, profile, message, frame):
        if profile == 1:
            return e2e.p01.e2e_p01_check(bytearray(frame), DATA_ID + message,
                                         data_id_mode=e2e.p01.E2E_P01_DATAID_BOTH, length=8)
        if profile == 2:
            return e2e.p02.e2e_p02_check(frame, self.lists[message], length=8)
        return e2e.p05.e2e_p05_check(frame, DATA_ID + message, length=8)

    def cases(self, profile):
        random = codec.seeded(f"profile {profile}")
        return [(message, counter % (LARGEST[profile] + 1), random.randbytes(8))
                for counter in range(FRAMES) for message in range(3)]

    def each_profile(self, test):
        for profile in LARGEST:
            with self.subTest(profile=profile):
                test(profile)

    def test_the_same_bytes(self):
        def same(profile):
            cases = self.cases(profile)
            answers = codec.run([f"protect {profile} {message} {counter} {frame.hex()}"
                                 for message, counter, frame in cases])
            for (message, counter, frame), answer in zip(cases, answers):
                self.assertEqual(oracle.protect(profile, message, counter, frame).hex().upper(), answer)
                self.assertTrue(self.check(profile, message, bytes.fromhex(answer)))
        self.each_profile(same)

    def test_the_receiver_accepts_what_the_oracle_protects(self):
        def accepts(profile):
            answers = codec.run([f"check {profile} {message} {oracle.protect(profile, message, counter, frame).hex()}"
                                 for message, counter, frame in self.cases(profile)])
            self.assertEqual(["initial"] * 3 + ["ok"] * (len(answers) - 3), answers)
        self.each_profile(accepts)

    def test_both_refuse_the_same_damage(self):
        def refuses(profile):
            random = codec.seeded(f"damage {profile}")
            frames = []
            for message, counter, frame in self.cases(profile):
                data = bytearray(oracle.protect(profile, message, counter, frame))
                for _ in range(random.randint(1, 4)):
                    data[random.randrange(8)] ^= 1 << random.randrange(8)
                frames.append((message, bytes(data)))
            answers = codec.run([f"check {profile} {message} {frame.hex()}" for message, frame in frames])
            for (message, frame), answer in zip(frames, answers):
                right = self.check(profile, message, frame) and not (profile == 1 and frame[1] & 0x0F == 15)
                self.assertEqual(right, answer != "crc_error", frame.hex())
        self.each_profile(refuses)


if __name__ == "__main__":
    unittest.main()
