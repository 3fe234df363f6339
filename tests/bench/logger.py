#!/usr/bin/env python3
"""The Velodyne logger under load, as a report for tests/bench/run: nominal traffic, then bursts, counted end to end.

Usage: logger.py SECONDS BURSTS SECONDS_OF_A_BURST"""
import json
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "system"))
import recording_load  # noqa: E402

if __name__ == "__main__":
    print(json.dumps({"context": {"compiler": "release"}, "figures": recording_load.run(*map(int, sys.argv[1:4]))}))
