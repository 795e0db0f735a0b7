#!/usr/bin/env python3
"""The DBC itself: complete, consistent with the C headers, and the same in both files but for the E2E header."""
import pathlib
import re
import unittest

import codec
import message_tables

UNITS = {"Pitch": "deg", "Roll": "deg", "Yaw": "deg", "Height": "m", "Support": "%", "Residual": "px", "RangeNear": "m",
         "RangeFar": "m"}
SIGNED = ("Pitch", "Roll", "Yaw")


def header(name):
    return (codec.PROJECT / "include" / "roadpose" / name).read_text(encoding="utf-8")


def statuses_of_the_headers():
    """{code: word} of the pose status on the bus, read from pose.h and can.h."""
    core = re.findall(r"ROADPOSE_STATUS_([A-Z_]+) = (\d+)", header("pose.h"))
    bus = re.findall(r"#define ROADPOSE_CAN_STATUS_([A-Z_]+) (\d+)u", header("can.h"))
    return {int(code): word.lower() for word, code in core + bus}


class Dbc(unittest.TestCase):
    def setUp(self):
        self.databases = {profile: codec.database(profile) for profile in (1, 5)}
        self.database = self.databases[1]

    def payload(self):
        return [(message, signal) for message in self.database.messages for signal in message.signals
                if not codec.is_header(signal)]

    def test_messages(self):
        for index, message in enumerate(self.database.messages):
            self.assertEqual((codec.MESSAGES[index], 0x3D0 + index, 8), (message.name, message.frame_id, message.length))
            self.assertEqual(100, message.cycle_time)
            self.assertIn("100 ms", message.comment)
            self.assertEqual(["Roadpose"], message.senders)
            self.assertEqual(0x5250 + index, message.dbc.attributes["E2EDataId"].value)

    def test_identifiers_are_those_of_the_code(self):
        text = header("can.h")
        self.assertIn("Default 0x3D0, 0x3D1, 0x3D2", text)
        self.assertIn("data_id 0x5250, 0x5251, 0x5252", text)

    def test_every_signal_has_an_invalid_code_of_all_ones(self):
        for _, signal in self.payload():
            self.assertEqual("invalid", str(signal.choices[codec.invalid_code(signal)]), signal.name)
            last = round((signal.maximum - signal.offset) / signal.scale)
            if set(signal.choices) == {codec.invalid_code(signal)}:
                self.assertLess(last, codec.invalid_code(signal), signal.name)

    def test_every_signal_starts_invalid_and_has_comment_and_unit(self):
        for _, signal in self.payload():
            self.assertEqual(codec.invalid_code(signal), signal.dbc.attributes["GenSigStartValue"].value, signal.name)
            self.assertEqual(UNITS.get(signal.name), signal.unit or None)
            self.assertIn(f"{codec.invalid_code(signal)}: invalid", signal.comment)
            if signal.name in UNITS:
                self.assertIn(f"Unit {UNITS[signal.name]}.", signal.comment)
            if signal.name in SIGNED:
                self.assertIn("+ = ", signal.comment)

    def test_value_tables_are_the_enums(self):
        status = self.database.get_message_by_name("RoadposeStatus").get_signal_by_name("PoseStatus")
        self.assertEqual(statuses_of_the_headers(), {code: str(word) for code, word in status.choices.items()})
        status = self.database.get_message_by_name("RoadposeStatus").get_signal_by_name("YawStatus")
        enum = re.search(r"typedef enum \{([^}]*)\} roadpose_yaw_status_t;", header("heading.h")).group(1)
        words = {int(code): word.lower() for word, code in re.findall(r"ROADPOSE_YAW_([A-Z_]+) = (\d+)", enum)}
        self.assertEqual(words | {15: "invalid"}, {code: str(word) for code, word in status.choices.items()})

    def test_payload_does_not_depend_on_the_profile(self):
        def lines(profile):
            text = (codec.PROJECT / "port" / "can" / codec.DBC[profile]).read_text(encoding="ascii")
            return [line for line in text.splitlines() if not re.search(r"Crc|Counter|E2EProfile\" BO_|^CM_ \"", line)]
        self.assertEqual(lines(1), lines(5))

    def test_headers_of_the_profiles(self):
        for profile, places in {1: [(0, 8), (8, 4)], 5: [(0, 16), (16, 8)]}.items():
            for message in self.databases[profile].messages:
                found = [(signal.start, signal.length) for signal in message.signals if codec.is_header(signal)]
                self.assertEqual(places, found)
                self.assertEqual(profile, message.dbc.attributes["E2EProfile"].value)

    def test_documentation_has_the_tables_of_the_dbc(self):
        text = pathlib.Path(codec.PROJECT / "docs" / "can.md").read_text(encoding="utf-8")
        self.assertIn(message_tables.tables(self.database), text,
                      "write them again with host_tests/can/message_tables.py")


if __name__ == "__main__":
    unittest.main()
