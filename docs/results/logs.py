"""The results of the five public logs, and of the drawn buildings beside them: docs/places.md, docs/pairs.md, docs/mapping.md,
docs/maps.md, docs/hermes-vector-map.md."""
import gzip

from running import FIVE, json_of, percent, rows_of

# "orebro" has no odometry; every fifth scan of freiburg-079, as its scans lie close together.
EVERY = {"freiburg-079": 5}
FAR = (("intel", 3), ("intel", 5), ("freiburg-079", 10), ("freiburg-079", 20), ("fhw", 3), ("belgioioso", 3), ("orebro", 2))


def named(log):
    return f"{log}, every {EVERY[log]}th" if log in EVERY else log


def mapped(run, log, options=""):
    """The summary of a map, and the errors of its trajectory at revisits."""
    summary = run.told(f"map {{{log}}} --corrected {options} --out-map @map.csv --out-trajectory @drive.tum --force")
    return summary, run.told(f"evaluate {{{log}}} @drive.tum")["revisits"]


def maps(run):
    """Maps of the logs: errors at revisits, as tracked, with loops closed, and without odometry; walls that are there twice."""
    reviewed = [("log", "scans", "segments", "there twice", "removed or cut, as later scans contradict it", "time of the review, seconds")]
    closed = [("log", "scans", "as tracked, m", "loops closed and refined, m", "degrees", "95th percentile, m", "without odometry, m",
               "closed, of those tried", "map file, of the log", "time of all, seconds")]
    motions = [("log", "as tracked", "loops closed and refined", "without odometry")]
    for log in FIVE:
        tracked, tracked_at = mapped(run, log, "--loops leave")
        ignored, ignored_at = mapped(run, log, "--odometry ignore")
        done, at = mapped(run, log)
        with gzip.open(run.log(log)) as file:
            size = len(file.read())
        reviewed.append((log, f"{done['scans']:,}", f"{done['segments']:,}", percent(done["parallel_twins"]["share"]),
                         f"{done['review']['contradicted_m']:.1f} m", f"{done['review']['seconds']:.2f}"))
        closed.append((log, f"{done['scans']:,}", f"{tracked_at['mean_m']:.3f}", f"{at['mean_m']:.3f}", f"{at['mean_deg']:.2f}",
                       f"{at['percentile_95_m']:.3f}", f"{ignored_at['mean_m']:.3f}", f"{done['closures']} of {done['closures_tried']}",
                       percent(done["map_bytes"] / size), f"{done['seconds']:.2g}"))
        motions.append((log, *(percent(s["reference"]["within_10cm_2deg"]) for s in (tracked, done, ignored))))
    return {"map-review": reviewed, "revisits": closed, "motions": motions}


def localized(run):
    """All scans of each log in a map of every second one."""
    table = [("log", "scans", "with pose", "at revisits, m", "degrees")]
    for log in FIVE:
        run.vector(f"map {{{log}}} --corrected --every 2 --out-map @map.csv --force")
        found = run.told(f"map {{{log}}} --corrected --localize @map.csv --out-trajectory @drive.tum --force")
        at = ("", "")
        if found["with_pose_share"] == 1:  # else a pose belongs to no scan, where stamps are tied
            errors = run.told(f"evaluate {{{log}}} @drive.tum")["revisits"]
            at = (f"{errors['mean_m']:.3f}", f"{errors['mean_deg']:.2f}")
        table.append((log, f"{found['scans']:,}", f"{found['scans'] - found['without_pose']:,}", *at))
    return {"localized": table}


def pairs(run):
    """The motions between scans, expected where the odometry tells."""
    table = [("log", "pairs", "within 10 cm, 2 degrees", "within 5 cm, 2 degrees", "lines alone, 10 cm", "lines do not suffice", "accepted",
              "accepted wrong")]
    sets = [(log, named(log), f"--every {EVERY.get(log, 1)}") for log in FIVE]
    sets.insert(1, ("freiburg-079", "freiburg-079, first 1,000", "--first 1000"))
    for log, name, options in sets:
        p = json_of(run.experiment(f"pairs --log {{{log}}} {options}"), "out.json")
        lines = ("not asked first",) * 2 if log == "orebro" else (percent(p["lines_alone_within_10cm_2deg"]), percent(p["lines_do_not_suffice"]))
        table.append((name, f"{p['pairs']:,}", percent(p["within_10cm_2deg"]), percent(p["within_5cm_2deg"]), *lines, percent(p["accepted"]),
                      f"{p['pairs'] * p['accepted_wrong']:.0f}"))
    return {"pairs": table}


def blind(run):
    """The same with nothing known but the two scans; the half that nothing was fitted to; pairs farther apart."""
    header = ("log", "pairs", "within 10 cm, 2 degrees", "5 cm, 2 degrees", "far wrong", "accepted", "of the right ones", "far wrong, accepted",
              "searched again")
    tables = {"blind": [header], "blind-second-half": [header]}
    for log in FIVE:
        for name, half in (("blind", ""), ("blind-second-half", "--half 2")):
            p = json_of(run.experiment(f"pairs --no-guess --log {{{log}}} --every {EVERY.get(log, 1)} {half}"), "out.json")
            tables[name].append((named(log), f"{p['pairs']:,}", percent(p["within_10cm_2deg"]), percent(p["within_5cm_2deg"]),
                                 f"{p['pairs'] * p['wrong']:.0f}", percent(p["accepted"]), percent(p["accepted_of_right"]),
                                 f"{p['pairs'] * p['accepted_wrong']:.0f}", percent(p["searched_widely"], 0)))
    far = [("every N-th scan", "pairs", "within 10 cm, 2 degrees", "with odometry, `ScanPairMatcher`", "accepted of the right ones",
            "far wrong, accepted")]
    for log, every in FAR:
        p, expected = (json_of(run.experiment(f"pairs --log {{{log}}} --every {every} {options}"), "out.json") for options in ("--no-guess", ""))
        far.append((f"{log}, {every}", f"{p['pairs']:,}", percent(p["within_10cm_2deg"]), percent(expected["within_10cm_2deg"]),
                    percent(p["accepted_of_right"], 0), f"{p['pairs'] * p['accepted_wrong']:.0f}"))
    return {**tables, "blind-far": far}


def tenth(i):
    return f"{i / 10:g} to {(i + 1) / 10:g}"


def calibration(run):
    """What the probability of a match promises, and what is right."""
    sets = " ".join(f"--log {{{log}}}" for log in ("intel", "freiburg-079", "fhw", "belgioioso", "orebro") * 2)
    sets += "".join(f" --every {n}" for n in (1, 5, 1, 1, 1, 2, 15, 2))
    tables = {}
    for name, half in (("calibration-second-half", " --half 2"), ("calibration", "")):
        told = json_of(run.experiment(f"calibration {sets}{half}"), "out.json")
        tables[name] = [("predicted probability", "best solutions", "mean predicted", "share right", "all solutions", "mean predicted",
                         "share right"),
                        *((tenth(i), *(x for of in ("best", "all") for x in (f"{told[of][i]['solutions']:,}", f"{told[of][i]['told']:.3f}",
                                                                            f"{told[of][i]['right']:.3f}"))) for i in range(10))]
    return tables


def places(run):
    """Scans searched in a map of every other scan."""
    table = [("map", "scans", "true place first", "found", "wrong ones found", "ambiguous", "median, ms", "99 %, ms")]
    for log in FIVE:
        p = json_of(run.experiment(f"places --log {{{log}}}"), "out.json")
        table.append((log, f"{p['scans']:,}", percent(p["first_right"]), percent(p["found_right"]), f"{p['scans'] * p['found_wrong']:.0f}",
                      percent(p["ambiguous"]), f"{p['median_ms']:.1f}", f"{p['p99_ms']:.1f}"))
    return {"places": table}


def place_trust(run):
    """The weights of PlaceTrust in use and fitted anew, on the half that took no part."""
    folder = run.experiment("place-trust --log {intel} --log {fhw} --log {belgioioso} --log {orebro} --other {freiburg-079}")
    told = json_of(folder, "out.json")
    sets = {"wrong: logs": "logs", "drift": "logs, map with drift", "other logs": "logs, other building", "other plans": "plans, other building",
            "other worlds": "worlds, other world"}
    weights = [("weights", "constant", "score", "ahead", "rival", "loss", "found: logs", "refurnished by 60 %", *sets)]
    for name, key in (("in use", "present"), ("fitted anew", "fitted")):
        w, of = told[key]["weights"], told[key]["sets"]
        weights.append((name, *(f"{w[x]:.1f}" for x in ("constant", "score", "ahead", "rival")), f"{told[key]['second_half']['loss']:.3f}",
                        percent(of["logs"]["found"]), percent(of["plans, 60 % refurnished"]["found"]),
                        *(f"{of[s]['wrong']} of {of[s]['trials']:,}" for s in sets.values())))
    tenths = told["present"]["second_half"]["tenths"]
    both = [("both halves, scans of", "scans", "found", "found wrong", "ambiguous")]
    scans = rows_of(folder, "place-trust.csv")
    for name in dict.fromkeys(r["set"] for r in scans):
        own = [r for r in scans if r["set"] == name]
        found = [r for r in own if r["outcome"] == "found"]
        right = sum(r["right"] == "1" for r in found)
        both.append((name, f"{len(own):,}", percent(right / len(own)), percent((len(found) - right) / len(own), 2),
                     percent(sum(r["outcome"] == "ambiguous" for r in own) / len(own))))
    return {"place-trust-sets": both, "place-trust-weights": weights,
            "place-trust": [("predicted", "first places", "predicted, mean", "right"),
                            *((tenth(i), f"{t['places']:,}", f"{t['told']:.3f}", f"{t['right']:.3f}") for i, t in enumerate(tenths))]}


def pose_trust(run):
    """What the trust of a pose promises, on the half and the logs that nothing was fitted to."""
    told = json_of(run.experiment("pose-trust --log {intel} --log {fhw} --log {freiburg-079} --other {belgioioso} --other {orebro} --runs 160"),
                   "out.json")["present"]
    halves = ("first half", "second half", "never fitted")
    of_poses = [("poses", "number", "mean trust", "right", "loss", "above 0.9", "of these wrong")]
    for half in halves:
        for log in ("", *FIVE):
            own = [s for name, s in told[half]["sets"].items() if name.startswith(log)]
            if own:
                mean = lambda key: sum(s["poses"] * s[key] for s in own) / sum(s["poses"] for s in own)
                of_poses.append((half + (log and ", " + log), f"{sum(s['poses'] for s in own):,}",
                                 *(f"{mean(key):.3f}" for key in ("told", "right", "loss")),
                                 *(f"{sum(s[key] for s in own):,}" for key in ("above_0.9", "above_0.9_wrong"))))
    table = [("predicted", "other half: poses", "mean", "right", "never fitted: poses", "mean", "right"),
             *((tenth(i), *(x for half in halves[1:] for x in (f"{told[half]['tenths'][i]['poses']:,}", f"{told[half]['tenths'][i]['told']:.3f}",
                                                              f"{told[half]['tenths'][i]['right']:.3f}"))) for i in range(10))]
    return {"pose-trust": table, "pose-trust-sets": of_poses}


def drawn_places(run):
    """Scans of drawn worlds, floor plans and towns, searched in their maps."""
    told = json_of(run.experiment("drawn-places --seed 2"), "out.json")
    table = [("map and scan, %", "true place first", "found", "wrong ones found", "ambiguous")]
    for name, s in told["sets"].items():
        table.append((name, *("" if key not in s else f"{100 * s[key]:.1f}" for key in ("first_right", "found_right", "found_wrong", "ambiguous"))))
    times = [("walls", "median time, ms"), *((f"{int(walls):,}", f"{s['median_ms']:.2g}") for walls, s in told["walls_of_towns"].items()),
             ("slope of log time over log walls", f"{told['slope_of_time']:.2f}")]
    return {"drawn-places": table, "time-of-towns": times}


# Seconds on a machine that does nothing else, for the time that is left.
RESULTS = {"maps": (maps, 40), "localized": (localized, 15), "pairs": (pairs, 5), "blind": (blind, 20), "calibration": (calibration, 10),
           "places": (places, 40), "place-trust": (place_trust, 90), "pose-trust": (pose_trust, 40), "drawn-places": (drawn_places, 100)}
