#!/usr/bin/env python3
"""Reads what hermes-seriallogger has recorded of a port, in plain Python 3.

    for stamp, mono, data in chunks("recordings/run1/seriallogger-gps"):
        print(stamp, data)

The files are NAME.raw, the bytes, and NAME.index, the time of each chunk of them. As a program it prints them:
seriallog.py recordings/run1/seriallogger-gps
"""
import struct
import sys


def chunks(base):
    """Yields (stamp, mono, bytes) of all bytes that came in together: seconds since the epoch, and of a clock that never
    jumps. base: the path without .raw and .index. ValueError where the index is none."""
    with open(base + ".raw", "rb") as raw:
        data = raw.read()
    with open(base + ".index", "rb") as file:
        header, index = file.read(16), file.read()
    if header != b"HERMESIX" + struct.pack("<II", 1, 24):
        raise ValueError(f"{base}.index: no index of version 1")
    records = list(struct.iter_unpack("<Qqq", index[:len(index) // 24 * 24]))
    ends = [offset for offset, _, _ in records[1:]] + [len(data)]
    for (offset, stamp_ns, mono_ns), end in zip(records, ends):
        if offset < len(data):  # a record is written before its bytes
            yield stamp_ns * 1e-9, mono_ns * 1e-9, data[offset:end]


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: seriallog.py recordings/NAME/seriallogger-PORT")
    try:
        for wall, _, received in chunks(sys.argv[1]):
            print(f"{wall:.6f} {received}")
    except KeyboardInterrupt:
        sys.exit(130)
    except (OSError, ValueError) as failure:
        sys.exit(f"seriallog.py: {failure}")
