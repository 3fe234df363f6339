#!/usr/bin/env python3
"""The slope, and what the tables of the benchmark correspondence make of good and of bad figures."""
import os
import re
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "results"))
from results import markdown  # noqa: E402
from correspondence import INDEX, PLACE, pair_table, place_table
from measure import Row
from tables import slope, verdict


def check_slope():
    for power in (0.5, 1, 2):
        assert abs(slope([(x, 3 * x**power) for x in (100, 1000, 10000, 100000)]) - power) < 1e-9, power
    # By least squares: 1 and 2 decades up after 1 and 2 decades, with one value off by a decade.
    assert abs(slope([(1, 1), (10, 100), (100, 100)]) - 1) < 1e-9
    assert (verdict(True), verdict(False)) == ("reached", "missed")


def places(power):
    """Rows of a search and an index whose time grows with this power of the walls."""
    counters = lambda n: {"walls": n, "median_us": n**power, "slowest_us": 2 * n**power, "found": 0.75, "wrong": 0.25}
    return [row for n in (100, 1000) for row in (
        Row(f"{PLACE}/{n}", ("iterations:1",), 24e3 * n**power, counters(n)),
        Row(INDEX, (str(n),), 1e3 * n**power, {"walls": n}))]


def check_places():
    shown = markdown(place_table(places(0.9)))
    assert re.search(r"\| place of a scan +\| +1,000 +\| +501 +\| +1002 +\| +75 % +\| +25 % +\|", shown), shown
    assert re.search(r"\| index of a map +\| +1,000 +\| +501 +\|", shown), shown
    assert shown.count("0.90") == 4 and "under 1 reached" in shown and "under 1.2 reached" in shown, shown
    shown = markdown(place_table(places(1.3)))
    assert shown.count("1.30") == 4 and "under 1 missed" in shown and "under 1.2 missed" in shown, shown


def pairs(ours, rival):
    """Rows of our matcher and a rival that are right in such shares of the pairs."""
    counters = lambda share, us: {"pairs": 10, "within_10cm_2deg": share, "within_5cm_2deg": share, "believed": 1,
                                  "far_wrong_believed": 0, "median_us": us, "p99_us": 4 * us}
    return [Row("GlobalPairMatcher/rooms", ("iterations:1",), 0, counters(ours, 200)),
            Row("MRPT one/rooms", ("iterations:1",), 0, counters(rival, 500)),
            Row("GlobalPairMatcher/without a rival", ("iterations:1",), 0, counters(ours, 100))]


def check_pairs():
    shown = markdown(pair_table(pairs(0.9, 0.8)))
    assert shown.count("reached") == 1 and "missed" not in shown, shown
    assert re.search(r"rooms: MRPT one +\| +10 +\| +80.0 % .*\| +500 +\| +2000 +\| +2.50 +\|", shown), shown
    assert "rivals missed" in markdown(pair_table(pairs(0.8, 0.8)))


if __name__ == "__main__":
    check_slope()
    check_places()
    check_pairs()
