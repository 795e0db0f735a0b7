#!/usr/bin/env python3
"""Prints the tables of docs/can.md from port/can/roadpose.dbc."""
import codec


def number(value):
    return f"{value:g}"


def meaning(signal):
    text = signal.comment.replace("|", "/")
    return text.split(" Unit ")[0] if " Unit " in text else text.split(f" {codec.invalid_code(signal)}:")[0]


def row(signal):
    step = "" if codec.is_header(signal) else f"{number(signal.scale)} {signal.unit or ''}".strip()
    zero = "" if codec.is_header(signal) else number(signal.offset)
    if signal.choices and len(signal.choices) > 1:
        values = ", ".join(f"{code} {word}" for code, word in sorted(signal.choices.items()))
        return f"| {signal.name} | {signal.start} | {signal.length} | | | {values} | {meaning(signal)} |"
    span = f"{number(signal.minimum)} … {number(signal.maximum)}"
    if not codec.is_header(signal):
        span += f"; code {codec.invalid_code(signal)} invalid"
    return f"| {signal.name} | {signal.start} | {signal.length} | {zero} | {step} | {span} | {meaning(signal)} |"


def table(message):
    lines = [f"**{message.name}**, identifier 0x{message.frame_id:X}, every {message.cycle_time} ms", "",
             "| signal | first bit | bits | value of code 0 | step | range | meaning |", "|---|---|---|---|---|---|---|"]
    return "\n".join(lines + [row(signal) for signal in message.signals]) + "\n"


def tables(database):
    return "\n".join(table(message) for message in database.messages)


if __name__ == "__main__":
    print(tables(codec.database()), end="")
