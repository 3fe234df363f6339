"""The results of experiments with the pose-free thesis, chapter 6: docs/sources-papers.md."""
import math

from running import FIVE, json_of, number, rows_of

# What the summaries of the pose-free thesis are in words, with the unit, and a factor from that of the file.
WORDS = {"scans": ("scans", 1), "length_m": ("way, m", 1), "matched": ("pairs matched", 1), "lost": ("scans lost", 1),
         "wrong": ("motions wrong by 0.5 m or 10 degrees", 1), "mean_error_m": ("error of a pair, mean, cm", 100),
         "median_error_m": ("error of a pair, median, cm", 100), "largest_error_m": ("error of a pair, largest, cm", 100),
         "mean_error_deg": ("rotational error, mean, degrees", 1), "median_error_deg": ("rotational error, median, degrees", 1),
         "largest_error_deg": ("rotational error, largest, degrees", 1), "mean_error_area_percent": ("error area, mean, %", 1),
         "median_us": ("time of a pair, median, us", 1), "mean_us": ("time of a pair, mean, us", 1), "map_segments": ("segments of the map", 1),
         "last_error_x_m": ("error of the last pose, x, cm", 100), "last_error_y_m": ("error of the last pose, y, cm", 100),
         "last_error_deg": ("error of the last pose, degrees", 1), "pairs": ("pairs", 1), "area_at_10_deg_m2": ("error area at 10 degrees, m²", 1),
         "area_at_50_cm_m2": ("error area at 50 cm, m²", 1), "grows_throughout": ("grows with the error throughout", 1),
         "mean_area_first_m2": ("error area of the first scan with all, mean, m²", 1), "mean_area_all_m2": ("error area of all pairs, mean, m²", 1),
         "slope_first_m2_per_m": ("slope of the first scan's by distance, m² a metre", 1), "slope_all_m2_per_m": ("slope of all pairs", 1)}
# What is printed, beside what the program itself tells.
PRINTED = {"free-home": {"matched": "all"}, "free-leaps": {"matched": "all"}, "free-copy": {"grows_throughout": "yes"},
           "free-approach": {"pairs": "of 1,480 scans", "matched": "all", "mean_area_first_m2": "the smaller one",
                             "mean_area_all_m2": "the larger one", "slope_first_m2_per_m": "none", "slope_all_m2_per_m": "none"},
           "free-log": {"last_error_x_m": "7.84", "last_error_y_m": "-0.66", "last_error_deg": "2.12"}}


def free_table(name, folder, more=()):
    """The pose-free thesis, chapter 6: what one experiment told, beside what is printed."""
    found = json_of(folder, "out.json")
    published = {key: number(float(value) * WORDS[key][1], 4) for key, value in found.pop("published", {}).items()}
    published.update(PRINTED[name])

    def cell(key, value):
        if isinstance(value, bool):
            return "yes" if value else "no"
        return f"{value:,}" if isinstance(value, int) else number(value * WORDS[key][1], 4)

    return [("", "ours", "published"), *((WORDS[key][0], cell(key, value), published.get(key, "")) for key, value in found.items()), *more]


def free(run):
    """Figures 6.2 to 6.11: a home in 3,069 and in 23 scans, a scan and its copy, straight to where walls meet."""
    folders = {name: run.experiment(name) for name in ("free-home", "free-leaps", "free-copy", "free-approach")}
    rows, apart = rows_of(folders["free-approach"], "free-approach.csv"), []
    for kind, what in (("first", "first scan with those"), ("all", "all pairs")):
        for low in (0, 16):
            near = [r for r in rows if r["pairs_of"] == kind and low <= float(r["distance_m"]) < low + 2]
            mean = sum(float(r["error_area_m2"]) * int(r["pairs"]) for r in near) / sum(int(r["pairs"]) for r in near)
            apart.append((f"{what} {low} to {low + 2} m apart, mean, m²", number(mean, 3), "the same" if low else ""))
    return {name: free_table(name, folder, apart if name == "free-approach" else ()) for name, folder in folders.items()}


def free_log(run):
    """Figures 6.12 and 6.13: a real log without any pose; where the way of the others ends."""
    ends = [("log", "scans", "scans placed", "motions wrong", "end of the way off by, m", "degrees")]
    for log in FIVE:
        folder = run.experiment(f"free-log --log {{{log}}}")
        told = json_of(folder, "out.json")
        ends.append((log, f"{told['scans']:,}", f"{told['matched']:,}", str(told["wrong"]),
                     f"{math.hypot(told['last_error_x_m'], told['last_error_y_m']):.0f}", f"{told['last_error_deg']:.0f}"))
        if log == "freiburg-079":
            placed = [r for r in rows_of(folder, "free-log.csv") if r["matched"] == "1"]
            largest = [(what, number(max(float(r[key]) for r in placed), 3), "")
                       for what, key in (("largest error of a pose in the map, m", "global_error_m"),
                                         ("largest error of a pose in the map, degrees", "global_error_deg"))]
            table = free_table("free-log", folder, largest)
    return {"free-log": table, "free-log-ends": ends}
