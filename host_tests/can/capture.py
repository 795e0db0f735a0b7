"""Compares what was captured on a bus with the CSV of the replay that sent it: byte for byte, CRC and counter included.

Each frame of the bus is predicted from the CSV with the DBC and autosar-e2e. What was captured must be the predicted
frames in their order, some of them missing; which ones is the answer."""
import csv
import re
from fractions import Fraction

import codec
import oracle

LINE = re.compile(r"\((\d+\.\d{6})\) \S+ ([0-9A-F]{3}|[0-9A-F]{8})#([0-9A-F]*)(?: [RT])?$")
POSE = {"Pitch": "pitch_deg", "Roll": "roll_deg", "Height": "height_m"}
QUALITY = {"Yaw": "yaw_deg", "Support": "support_permille", "Residual": "residual_px", "RangeNear": "range_near_m",
           "RangeFar": "range_far_m"}
DEGREE_COLUMNS = ("pitch_deg", "roll_deg", "yaw_deg")


def frames_of(text):
    """[(identifier, data)] of a log of can-utils; anything else in it is an error."""
    found = [LINE.match(line) for line in text.splitlines()]
    wrong = [line for line, match in zip(text.splitlines(), found) if match is None]
    if wrong:
        raise ValueError(f"not a log of can-utils: {wrong[0]!r}")
    return [(int(match.group(2), 16), bytes.fromhex(match.group(3))) for match in found]


def physical(row, column):
    """The number that the sender had: the CSV rounds angles to a millionth of a degree, the library knows
    micro-radians."""
    value = Fraction(row[column])
    if column in DEGREE_COLUMNS:
        return round(value / codec.DEGREES) * codec.DEGREES
    return value / 10 if column == "support_permille" else value  # per cent


class Sender:
    """Predicts the frames of a replay, row by row of its CSV."""

    def __init__(self, rows, profile=1):
        self.rows = rows
        self.profile = profile
        self.messages = [codec.database(profile).get_message_by_name(name) for name in codec.MESSAGES]
        self.statuses = self.words_of("PoseStatus")
        self.yaw_statuses = self.words_of("YawStatus")
        self.counter = [0, 0, 0]
        self.last = [None, None, None]
        self.dropped = 0

    def words_of(self, name):
        return {str(word): code for code, word in self.messages[2].get_signal_by_name(name).choices.items()}

    def codes_of(self, index, row, columns):
        message = self.messages[index]
        result = {}
        for name, column in columns.items():
            signal = message.get_signal_by_name(name)
            known = row.get(column, "") != ""
            result[name] = codec.expected_code(signal, physical(row, column)) if known else codec.invalid_code(signal)
        return result

    def status_of(self, number):
        row = self.rows[number]
        refused = sum(row["status"] != "ok" for row in self.rows[:number + 1])
        return {"PoseStatus": self.statuses[row["status"]], "YawStatus": self.yaw_statuses[row["yaw_status"] or "invalid"],
                "FrameCount": (number + 1) % 255, "RefusedCount": refused % 255, "OverwrittenCount": 0}

    def predict(self, index, number, dropped):
        """Signals that the CSV tells; those it does not tell are left out."""
        row = self.rows[number]
        if index == 0:
            return self.codes_of(0, row, POSE)
        if index == 2:
            return self.status_of(number) | {"DroppedCount": dropped % 255}
        return self.codes_of(1, row, QUALITY if row["status"] == "ok" else {"Yaw": "yaw_deg"})

    def matches(self, index, number, dropped, frame):
        identifier, data = frame
        message = self.messages[index]
        if identifier != message.frame_id or len(data) != 8:
            return False
        if data != oracle.protect(self.profile, index, self.counter[index], data):
            return False
        found = codec.codes(message, data)
        predicted = self.predict(index, number, dropped)
        return all(found[name] == code for name, code in predicted.items())

    def advance(self, index, sent):
        """The counter goes on with every cycle, but not to the value that was sent last."""
        if sent:
            self.last[index] = self.counter[index]
        values = oracle.LARGEST[self.profile] + 1
        self.counter[index] = (self.counter[index] + 1) % values
        if self.counter[index] == self.last[index]:
            self.counter[index] = (self.counter[index] + 1) % values


def missing_frames(capture, csv_text, profile=1):
    """[(row, message)] that are not in the capture. Raises AssertionError for a frame that no row explains."""
    rows = list(csv.DictReader(csv_text.splitlines()))
    sender = Sender(rows, profile)
    waiting = list(frames_of(capture))
    missing = []
    for number in range(len(rows)):
        dropped = len(missing)
        for index in range(3):
            sent = bool(waiting) and sender.matches(index, number, dropped, waiting[0])
            if sent:
                waiting.pop(0)
            else:
                missing.append((number, index))
            sender.advance(index, sent)
    if waiting:
        raise AssertionError(f"{len(waiting)} frames that the CSV does not explain, first "
                             f"{waiting[0][0]:03X}#{waiting[0][1].hex().upper()}; missing: {missing}")
    return missing


def missing_rows(missing):
    return sorted({row for row, _ in missing})
