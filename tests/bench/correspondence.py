"""The tables of the benchmark correspondence."""
from measure import medians
from tables import slope, verdict

# Microseconds, at most.
VIEW_GOALS = {("expected view, short edges", "1000"): 300, ("expected view, long edges", "1000"): 300,
              ("expected view, all edges seen", "1000"): 300}
PILLARS = "search between two scans of pillars"
PILLARS_GOAL = 1000
MAP_GOAL = 2  # times as long in 100,000 segments as in 100
OURS, RIVALS = "GlobalPairMatcher", ("MRPT", "PCL")
PLACE, INDEX = "place of a scan", "index of a map"
SLOPE_GOALS = {PLACE: 1, INDEX: 1.2}  # below


def view_table(rows):
    """Expected views, and the search from an expected motion."""
    body = []
    for name, arguments, ns, _ in (r for r in rows if r.name != PILLARS):
        goal = VIEW_GOALS.get((name, *arguments))
        body.append((name, f"{int(arguments[0]):,} edges", f"{ns / 1e3:.1f}",
                     "" if goal is None else f"under {goal} {verdict(ns / 1e3 < goal)}"))
    maps = [r.ns for r in rows if r.name == "search in a map"]
    body.append(("the same, ratio", "", f"{maps[-1] / maps[0]:.2f} x", f"under {MAP_GOAL} x {verdict(maps[-1] < MAP_GOAL * maps[0])}"))
    cases = sorted(r.ns / 1e3 for r in rows if r.name == PILLARS)
    median = cases[len(cases) // 2]
    body.append((PILLARS, f"median of {len(cases)}", f"{median:.1f}", f"under {PILLARS_GOAL} {verdict(median < PILLARS_GOAL)}"))
    body.append(("", "slowest", f"{cases[-1]:.1f}", ""))
    return [("what", "size", "us", "goal"), *body]


def pair_table(rows):
    """Two scans of which nothing else is known: how often right, and how long."""
    by_name = {tuple(r.name.split("/", 1)): r.counters for r in rows}
    body = []
    for (method, what), c in by_name.items():
        ours = by_name[OURS, what]
        rivals = [other["within_10cm_2deg"] for (m, w), other in by_name.items() if w == what and m.startswith(RIVALS)]
        goal = ""
        if method == OURS and rivals:
            goal = f"right more often than the rivals {verdict(c['within_10cm_2deg'] > max(rivals))}"
        body.append((f"{what}: {method}", f"{c['pairs']:.0f}",
                     *(f"{100 * c[key]:.1f} %" for key in ("within_10cm_2deg", "within_5cm_2deg", "believed", "far_wrong_believed")),
                     f"{c['median_us']:.0f}", f"{c['p99_us']:.0f}", f"{c['median_us'] / ours['median_us']:.2f}", goal))
    return [("pairs: method", "pairs", "10 cm, 2 deg", "5 cm, 2 deg", "believed", "far wrong", "us a pair", "99 %", f"to {OURS}", "goal"), *body]


def place_table(rows):
    """The search of a whole map and the making of its index, by the number of walls."""
    body = []
    for kind, goal in SLOPE_GOALS.items():
        own = [r for r in rows if r.name.split("/")[0] == kind]
        times = [r.counters.get("median_us", r.ns / 1e3) for r in own]
        for r, us in zip(own, times):
            c = r.counters
            searched = (f"{c['slowest_us']:.0f}", f"{100 * c['found']:.0f} %", f"{100 * c['wrong']:.0f} %") if kind == PLACE else ("",) * 3
            body.append((kind, f"{c['walls']:,.0f}", f"{us:.0f}", *searched, ""))
        points = [(r.counters["walls"], us) for r, us in zip(own, times)]
        body.append(("slope", "", f"{slope(points):.2f}", "", "", "", f"under {goal} {verdict(slope(points) < goal)}"))
        body.append(("slope of the last two", "", f"{slope(points[-2:]):.2f}", "", "", "", ""))
    return [("what", "walls", "us", "slowest", "found", "found wrongly", "goal"), *body]


def correspondence_tables(report):
    pairs, places, views = [], [], []
    for row in medians(report):
        (pairs if "pairs" in row.counters else places if "walls" in row.counters else views).append(row)
    return {"views": view_table(views), "blind-pairs": pair_table(pairs), "place-search": place_table(places)}
