"""The results of experiments with the thesis and the papers: docs/sources.md, docs/experiments.md, docs/algorithms.md
and the pages that go on from them."""
import re
import statistics

import pose_free
from running import FIVE, json_of, number, rows_of


RAYS = (200, 500, 1000, 2000, 5000, 10000, 20000)
# Figures 6.8 to 6.10: additional lines of Reumann-Witkam in percent, by rays.
PUBLISHED_RW = {"edges": (85, 110, 128, 140, 144, 151, 156), "corners": (119, 137, 149, 157, 161, 169, 176), "room": (40, 76, 94, 102, 109, 112, 114)}
EXTRACTORS = ("AFTLS", "AFTLS-NM", "FTLS", "INC", "DP", "RW")


def quality(rows):
    """Figures 6.8 to 6.10: lines, area and time of all extractors."""
    table = [("", "lines over true ones, N >= 1,000", "area at 1,000, cm²", "area at 20,000, cm²", "time at 20,000, us")]
    for algorithm in dict.fromkeys(r["algorithm"] for r in rows):
        at = {int(r["points"]): r for r in rows if r["algorithm"] == algorithm}
        many = [float(r["lines_percent"]) for n, r in at.items() if n >= 1000]
        table.append((algorithm, f"{min(many):+.1f} to {max(many):+.1f} %", *(number(1e4 * float(at[n]["area_m2"]), 3) for n in (1000, 20000)),
                      number(at[20000]["time_us"], 3)))
    return table


def scenes(run):
    """Solitary edges, corners and a room: lines, error area and time, with noise of 1 cm and of 5 mm."""
    tables = {}
    rw = [("additional lines of RW, %", *(f"{n:,}" for n in RAYS))]
    areas = [("", "rays", *EXTRACTORS)]
    for scene in ("edges", "corners", "room"):
        rows, quiet = (rows_of(run.experiment(f"{scene} --runs 50{noise}"), scene + ".csv") for noise in ("", " --noise 0.005"))
        tables[scene] = quality(rows)
        lines = lambda of, algorithm: (f"{float(r['lines_percent']):.0f}" for r in of if r["algorithm"] == algorithm)
        rw += [(scene + ", published", *map(str, PUBLISHED_RW[scene])), (scene + ", noise 5 mm", *lines(quiet, "RW")),
               (scene + ", noise 1 cm", *lines(rows, "RW")), (scene + ", noise 1 cm, adjacent points", *lines(rows, "RW-adjacent"))]
        for n in (200, 2000, 20000):
            cm2 = {r["algorithm"]: [number(1e4 * float(r[key]), 4) for key in ("area_m2", "area_low_m2", "area_high_m2")]
                   for r in rows if int(r["points"]) == n}
            areas.append((scene, f"{n:,}", *(cm2[e][0] if e == "AFTLS-NM" else f"{cm2[e][0]} ({cm2[e][1]} to {cm2[e][2]})" for e in EXTRACTORS)))
    return {**tables, "reumann-witkam": rw, "error-areas": areas}


# The two tables of the thesis that the text has; the first is of figure 6.11 or 6.12. Lines over true ones, time over FTLS.
ROOM = {"FTLS": ("+50 %", "+0 %"), "AFTLS": ("+10 %", "+3 %"), "INC": ("+30 %", "+427 %"), "DP": ("+40 %", "-49 %"), "RW": ("+200 %", "-51 %")}
LABORATORY = {"FTLS": ("+46 %", "+0 %"), "AFTLS": ("+52 %", "+35 %"), "INC": ("+52 %", "+269 %"), "DP": ("+56 %", "+44 %"),
              "RW": ("+126 %", "+35 %")}
LINES_OF = ("FTLS", "AFTLS", "INC", "DP", "RW")


def real_scan(rows, published):
    """Figures 6.11 to 6.13, beside the published table."""
    table = [(f"{rows[0]['points']} points", f"lines (of {rows[0]['lines_reference']})", "published", "time, us (of FTLS)", "published")]
    for r in rows:
        lines, time = published.get(r["algorithm"], ("", ""))
        table.append((r["algorithm"], f"{r['lines']} ({float(r['lines_percent']):+.0f} %)", lines,
                      f"{number(r['time_us'], 3)} ({float(r['time_percent']):+.0f} %)", time))
    return table


def real_scans(run):
    """A room, a corridor and a laboratory of logs and of a capture."""
    scan = lambda experiment, log: rows_of(run.experiment(f"{experiment} --log {{{log}}}"), experiment + ".csv")
    lines = [("additional lines, %", "points", "fewest lines", *LINES_OF), ("published, first table", "1,918", "10", "50", "10", "30", "40", "200"),
             ("published, second table", "1,981", "50", "46", "52", "52", "56", "126")]
    for log in ("hdl32e-outdoor.pcap", *FIVE):
        for experiment in ("empty-room", "corridor", "laboratory"):
            rows = {r["algorithm"]: r for r in scan(experiment, log)}
            lines.append((f"{log.removesuffix('.pcap')}: {experiment}", f"{int(rows['FTLS']['points']):,}", rows["FTLS"]["lines_reference"],
                          *(f"{float(rows[a]['lines_percent']):.0f}" for a in LINES_OF)))
    return {"empty-room": real_scan(scan("empty-room", "fhw"), ROOM), "corridor": real_scan(scan("corridor", "freiburg-079"), ROOM),
            "laboratory": real_scan(scan("laboratory", "fhw"), LABORATORY), "real-lines": lines}


def criterion_time(run):
    """Figure 7.9: how many times as fast sums are, by pairs and transformations."""
    rows = rows_of(run.experiment("criterion-time"), "criterion-time.csv")
    counts = list(dict.fromkeys(r["transformations"] for r in rows))
    return {"time-of-criterion": [("pairs \\ transformations", *counts),
                               *((pairs, *(number(r["speed_up"], 2) for r in rows if r["pairs"] == pairs))
                                 for pairs in dict.fromkeys(r["pairs"] for r in rows))]}


def optimum(run):
    """Random closed rooms in which AFTLS comes within 1 % of the least error that so many lines can have."""
    found = re.findall(r"\((\d+) rays\) within 1 % of the optimum: (\d+) of (\d+) rooms .*by Nelder-Mead (\d+)",
                       run.test("vectorlib/TestAftlsOptimum"))
    share = lambda part, rooms: f"{100 * int(part) / int(rooms):.1f} %"
    return {"optimum": [("points of a scan", "descent", "Nelder-Mead"),
                        *((f"{int(rays):,}", share(near, rooms), share(simplex, rooms)) for rays, near, rooms, simplex in found)]}


CRITERIA = {"area": "area (7.9)", "quadrangle": "quadrangle", "hausdorff": "(7.2)", "modified": "(7.3)", "perpendicular": "(7.6)"}


def hausdorff_criteria(run):
    """Thesis 7.1.4: which criterion has which property in all of its trials."""
    told = json_of(run.experiment("hausdorff-criteria"), "out.json")
    return {"hausdorff-criteria": [("property", *CRITERIA.values()),
                                   *((what, *("yes" if told[what][c] == 1 else "no" for c in CRITERIA)) for what in told)]}


WORLDS = ("cutsquare", "oblique", "pillars")
# Tables 1 and 2 of the registration paper, with their column of weighting-tables.csv.
PUBLISHED_WEIGHTING = {"ratio_a_t": ("ambiguity, position", 0.68, 0.46, 0.27), "ratio_a_alpha": ("ambiguity, heading", 0.65, 0.43, 0.25),
                       "ratio_d_t": ("squared error, position", 0.58, 0.25, 0.07), "ratio_d_alpha": ("squared error, heading", 0.66, 0.27, 0.07),
                       "corr_t": ("correlation, position", 0.90, 0.91, 0.77), "corr_alpha": ("correlation, heading", 0.59, 0.82, 0.58),
                       "corr_t_weighted": ("correlation, position, weighted", 0.91, 0.80, 0.74),
                       "corr_alpha_weighted": ("correlation, heading, weighted", 0.53, 0.56, 0.61)}


def mean_over_poses(rows, key, **wanted):
    return statistics.fmean(float(r[key]) for r in rows if all(r[k] == v for k, v in wanted.items()))


def weighting_by(rows, world, **wanted):
    """Squared position error with weights over that without: geometric mean over the numbers of points and noises that are left."""
    settings = {(r["points"], r["sigma"]) for r in rows if all(r[k] == v for k, v in wanted.items())}
    return statistics.geometric_mean(mean_over_poses(rows, "d_t", world=world, points=n, sigma=s, weighted="1") /
                                     mean_over_poses(rows, "d_t", world=world, points=n, sigma=s, weighted="0") for n, s in settings)


def correlation(rows, ambiguity, error):
    a, d = ([float(r[key]) for r in rows] for key in (ambiguity, error))
    return statistics.correlation(a, d)


def weighting(run):
    """Tables 1 and 2 of the registration paper; what the gain and the correlation depend on."""
    folders = [run.experiment("weighting" + known) for known in ("", " --known-edges")]
    ours, known = ({r["world"]: r for r in rows_of(folder, "weighting-tables.csv")} for folder in folders)
    table = [("", *(x for world in WORLDS for x in (world, "known edges", "published")))]
    for key, (what, *published) in PUBLISHED_WEIGHTING.items():
        table.append((what, *(f"{float(x):.2f}" for world, p in zip(WORLDS, published) for x in (ours[world][key], known[world][key], p))))
    rows = rows_of(folders[0], "weighting.csv")
    gain = [("squared position error, weighted over unweighted", "noise 1 cm", "3 cm", "10 cm", "100 points", "3,000 points"),
            *((world, *(f"{weighting_by(rows, world, **setting):.2f}" for setting in
                        ({"sigma": "0.01"}, {"sigma": "0.03"}, {"sigma": "0.1"}, {"points": "100"}, {"points": "3000"}))) for world in WORLDS)]
    depends = [("correlation of the heading, by number of points", "noise 1 cm", "3 cm", "10 cm")]
    for world in WORLDS:
        cells = []
        for sigma in ("0.01", "0.03", "0.1"):
            own = [r for r in rows if r["world"] == world and r["sigma"] == sigma and r["weighted"] == "0"]
            found = [correlation([r for r in own if r["points"] == n], "a_alpha", "d_alpha") for n in {r["points"] for r in own}]
            cells.append(f"{min(found):.2f} to {max(found):.2f}")
        depends.append((world, *cells))
    return {"weighting": table, "weighting-gain": gain, "weighting-correlation": depends}


def accuracy(run):
    """Figure 6 of the registration paper: the squared error of the position by number of points and noise, mean of the poses."""
    rows = rows_of(run.experiment("accuracy"), "accuracy.csv")
    sigmas = ("0.01", "0.03", "0.1")
    return {"accuracy": [("squared error of the position, mm²", *(f"noise {100 * float(s):g} cm" for s in sigmas)),
                         *((f"{int(n):,} points", *(number(1e6 * mean_over_poses(rows, "d_t", points=n, sigma=s, weighted="0"), 2) for s in sigmas))
                           for n in dict.fromkeys(r["points"] for r in rows))]}


SEGMENTS = {"extracted": "extracted", "extracted-clean": "extracted, each line fitted anew without points of other edges",
            "extracted-tight": "extracted, sigma 1.2 instead of 2 times the noise", "extracted-ftls": "extracted by FTLS",
            "known-edges": "rays that know their edge", "across-edges": "the same, only the noise across the edge",
            "fitted-ranges": "the same, lines fitted to ranges"}


def registration_bias(run):
    """What of the error many points and many scans do not take away: noise of 10 cm, position, mean of the poses."""
    at = {(r["segments"], r["points"]): r for r in rows_of(run.experiment("registration-bias"), "registration-bias.csv")
          if r["sigma"] == "0.1" and r["weighted"] == "0"}
    mm2 = lambda segments, points, key: number(1e6 * float(at[segments, points][key]), 3)
    return {"registration-bias": [("squared error, mm²", "100 points", "1,000 points", "3,000 points", "of it bias, 3,000 points"),
                                  *((what, *(mm2(s, n, "d_t") for n in ("100", "1000", "3000")), mm2(s, "3000", "bias_t"))
                                    for s, what in SEGMENTS.items())]}


def span(values):
    return f"{min(values)} to {max(values)}" if min(values) != max(values) else f"{values[0]}"


def report(run):
    """Appendices A to D of the thesis: by our finder with seed 1, and by the published rules and our finder with seeds 1 to 8."""
    seeds = range(1, 9)
    tables = {}
    rules = [("seeds 1 to 8", "published", "published rules", "our finder")]
    counted = ("solutions of case 0", "true solution accepted", "wrong ones accepted", "wrong pairs of the first solutions")
    printed = {"pillars": ("15", "32 of 38", "7", ""), "quadratic": ("6", "24 of 24", "0", "80")}
    for world in ("pillars", "quadratic"):
        ours = [run.told(f"report {world} --overall --seed {seed} --format json") for seed in seeds]
        theirs = [run.told(f"report {world} --overall --all-combinations --seed {seed} --format json")["summary"] for seed in seeds]
        counts = [[len(run.told(f"report {world} --case 0 {every}--seed {seed} --format json")["solutions"]) for seed in seeds]
                  for every in ("--all-combinations ", "")]
        summaries = [o["summary"] for o in ours]
        of = f" of {summaries[0]['cases']}"
        cells = [(span(counts[0]), span(counts[1]))]
        cells += [(span([s[key] for s in theirs]) + end, span([s[key] for s in summaries]) + end)
                  for key, end in (("true_accepted", of), ("wrong_accepted", ""), ("false_positives_of_first", ""))]
        rules += [(f"{world}, {what}", p, *both) for what, p, both in zip(counted, printed[world], cells)]
        accepted = [c["accepted"][0] for c in ours[0]["cases"] if c["accepted"]]
        least_to_most = lambda values: " to ".join(number(f(values), 3) for f in (min, statistics.median, max))
        summary = [str(summaries[0][key]) for key in ("cases", "true_first", "true_accepted", "wrong_accepted", "false_positives_of_first")]
        tables["report-" + world] = [("pairs of scans", "true first", "true accepted", "wrong accepted", "false pairs of the first", "reliability",
                                      "discrepancy, cm²"),
                                     (*summary, least_to_most([c["reliability"] for c in accepted]),
                                      least_to_most([1e4 * c["discrepancy"] for c in accepted]))]
    run.commands[:] = dict.fromkeys(re.sub(r"--seed \d+", "--seed 1 to 8", command) for command in run.commands)
    return {**tables, "report-rules": rules}


def overview(run):
    """Figures 2 and 4 of the overview paper: the error at the end of 20 drives."""
    table = [("error at the end, 20 drives", "published", "by odometry, m", "ours, median, mm", "least", "largest", "largest on the way",
              "the paper's matcher, median, mm", "least", "largest")]
    for experiment, what, printed in (("overview-steps", "ten scans 60 cm apart", "pictures only"),
                                      ("overview-loop", "46.71 m in 33 scans", "6 mm, one drive")):
        told = json_of(run.experiment(experiment), "out.json")
        mm = lambda of, *keys: (f"{1000 * told[of][key]:.1f}" for key in keys)
        table.append((what, printed, f"{told['odometry_closing_error_m']:.2f}",
                      *mm("closing_error_m", "median", "least", "largest", "largest_on_the_way"),
                      *mm("closing_error_m_of_the_older_matcher", "median", "least", "largest")))
    return {"overview": table}


def baseline(run):
    """The matcher of the overview paper and ours, by the error of the expected motion."""
    table = []
    for command, sets in (("baseline", {"corridor": "corridor (32)", "pillars": "pillars (38)"}),
                          ("baseline --log {freiburg-079} --every 3 --first 150", {None: "freiburg-079, every third scan (150)"})):
        told = json_of(run.experiment(command), "out.json")
        for name, what in sets.items():
            for matcher, m in told[name or next(iter(told))].items():
                table = table or [("pairs of: matcher", *m["right_share"], "median error of the first, mm", "degrees", "time, of the tracker's")]
                table.append((f"{what}: {matcher}", *(f"{share:.2f}" for share in m["right_share"].values()), f"{1000 * m['median_error_m']:.1f}",
                              f"{m['median_error_deg']:.2f}", f"{m['time_over_tracker']:.1f}"))
    return {"baseline": table}


POLYLINES = ("AFTLS", "FTLS", "INC", "DP", "RW", "SAM", "SAM+")
BUDGETS = (10, 20, 30, 40, 50, 100, 180)


def by_budget(rows, vertices="0"):
    return {(r["algorithm"], int(r["budget"])): r for r in rows if r["vertices_true"] == vertices}


def polygons(run):
    """Polylines of closed polygons and of the logs at equal numbers of vertices J."""
    rows = rows_of(run.experiment("polygons --runs 40"), "polygons.csv")
    of = by_budget(rows)
    everything = [("J", *POLYLINES), *((str(j), *(f"{100 * float(of[p, j]['rmse']):.1f}, {100 * float(of[p, j]['hit_share']):.1f}, "
                                                f"{100 * float(of[p, j]['area_error']):.2f}" for p in POLYLINES)) for j in BUDGETS)]
    ratios = [("true vertices", *(f"J = {j}" for j in BUDGETS[:5]))]
    for vertices in ("6", "12", "36", "90", "180"):
        own = by_budget(rows, vertices)
        ratio = lambda other, j: ", ".join(f"{float(own['AFTLS', j][key]) / float(own[other, j][key]):.2f}" for key in ("rmse", "area_error"))
        ratios.append((vertices, *(" / ".join(ratio(other, j) for other in ("DP", "SAM", "SAM+")) for j in BUDGETS[:5])))
    real, shown = [("log", *(f"J = {j}" for j in BUDGETS), "f, J = 50")], ("AFTLS", "DP", "SAM", "SAM+")
    for log in FIVE:
        own = by_budget(rows_of(run.experiment(f"log --log {{{log}}}"), "log.csv"))
        most = max(int(r["scans"]) for r in own.values())
        few = lambda j: f" ({own['AFTLS', j]['scans']} scans)" if int(own["AFTLS", j]["scans"]) < most / 2 else ""
        real.append((log, *(" / ".join(f"{100 * float(own[p, j]['rmse']):.1f}" for p in shown) + few(j) for j in BUDGETS),
                     " / ".join(f"{100 * float(own[p, 50]['hit_share']):.0f}" for p in shown)))
    return {"polygons": everything, "polygon-ratios": ratios, "log-polylines": real}


# Seconds on a machine that does nothing else, for the time that is left.
RESULTS = {"scenes": (scenes, 200), "real-scans": (real_scans, 10), "criterion-time": (criterion_time, 30), "optimum": (optimum, 150),
           "hausdorff-criteria": (hausdorff_criteria, 8), "weighting": (weighting, 20), "accuracy": (accuracy, 5),
           "registration-bias": (registration_bias, 10), "report": (report, 15), "overview": (overview, 5), "baseline": (baseline, 40),
           "free": (pose_free.free, 15), "free-log": (pose_free.free_log, 10), "polygons": (polygons, 20)}
