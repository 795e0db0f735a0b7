"""E2E protection as the PyPI package autosar-e2e does it, with the identifiers of the default settings."""
import functools

import e2e.p01
import e2e.p02
import e2e.p05

import codec

LARGEST = {1: 14, 2: 15, 5: 255}  # counter
DATA_ID = 0x5250


@functools.cache
def lists():
    """The lists of data identifiers of profile 2."""
    return [bytes(map(int, line.split())) for line in codec.run([f"list {message}" for message in range(3)])]


def protect(profile, message, counter, frame):
    """The frame protected. The counter is put where the profile has it."""
    data = bytearray(frame)
    if profile == 5:
        data[2] = counter
        e2e.p05.e2e_p05_protect(data, DATA_ID + message, length=8, increment_counter=False)
    else:
        data[1] = data[1] & 0xF0 | counter
        if profile == 1:
            e2e.p01.e2e_p01_protect(data, DATA_ID + message, data_id_mode=e2e.p01.E2E_P01_DATAID_BOTH, length=8,
                                    increment_counter=False)
        else:
            e2e.p02.e2e_p02_protect(data, lists()[message], length=8, increment_counter=False)
    return bytes(data)
