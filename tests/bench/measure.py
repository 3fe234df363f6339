"""Runs a benchmark in repetitions and tells on stderr how far it is."""
import collections
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.join(HERE, "..", "..")
Row = collections.namedtuple("Row", "name arguments ns counters")


def clock(seconds):
    return f"{seconds:.0f} s" if seconds < 100 else f"{seconds / 60:.0f} min"


def processor():
    """The machine's processor, for whoever reads its times."""
    model = "unknown processor"
    if os.path.exists("/proc/cpuinfo"):
        with open("/proc/cpuinfo", encoding="utf-8") as info:
            model = next((line.split(":")[1].strip() for line in info if line.startswith("model name")), model)
    return f"{model}, one of {os.cpu_count()} virtual cores"


class Progress:
    """What is done, and how long the rest may take: in one line of a terminal, elsewhere in a line every ten seconds. As JSON: an
    object a line, twice a second at most, as the programs do with --json."""
    is_json = False

    def __init__(self, name, total, stream=sys.stderr):
        self.name, self.total, self.stream = name, total, stream
        self.begin, self.shown, self.ended = time.monotonic(), None, False

    def tell(self, done, unit=""):
        now = time.monotonic()
        one_line = self.stream.isatty() and not self.is_json
        pause = 0.5 if self.is_json else 0.2 if one_line else 10
        if self.ended or self.shown is not None and now - self.shown < pause and done < self.total:
            return
        self.shown, self.ended, passed = now, done >= self.total, now - self.begin
        left_s = passed * (self.total - done) / done if done else None
        if self.is_json:
            progress = {"what": self.name, "done": round(done, 1), "total": self.total, "elapsed_s": round(passed, 1),
                        "left_s": None if left_s is None else round(left_s, 1)}
            self.stream.write(json.dumps({"progress": progress}) + "\n")
            self.stream.flush()
            return
        left = f", about {clock(left_s)} left" if done else ""
        text = f"{self.name}: {done:.0f} of {self.total:.0f}{unit}, {clock(passed)}{left}"
        self.stream.write(f"\r{text}\033[K" + ("\n" if self.ended else "") if one_line else text + "\n")
        self.stream.flush()


def program_of(build, *path):
    program = os.path.join(build, "tests", *path)
    if not os.path.exists(program):
        sys.exit(f"{program}: not there, build the target {path[-1]} first")
    return program


def google(name, program, repetitions, options):
    """All repetitions of all benchmarks of the program, each repetition in an order of its own."""
    listed = subprocess.run([program, "--benchmark_list_tests=true", *options], stdout=subprocess.PIPE, text=True, check=False)
    if listed.returncode != 0:  # 77: skipped, and has said why
        sys.exit(listed.returncode)
    count = len(listed.stdout.split("\n")) - 1
    progress, report, done = Progress(name, repetitions * count), {"benchmarks": []}, 0
    with tempfile.NamedTemporaryFile(suffix=".json") as out, tempfile.TemporaryFile("w+") as said:
        for repetition in range(repetitions):
            with subprocess.Popen([program, "--benchmark_enable_random_interleaving=true", "--benchmark_out_format=json",
                                   f"--benchmark_out={out.name}", "--benchmark_color=false", *options],
                                  stdout=subprocess.PIPE, stderr=said, text=True) as run:
                progress.tell(done)
                for line in run.stdout:
                    done += " ns " in line
                    progress.tell(min(done, (repetition + 1) * count))
            if run.returncode != 0:
                said.seek(0)
                sys.exit(said.read() or f"{program} ended with {run.returncode}")
            done = (repetition + 1) * count
            with open(out.name, encoding="utf-8") as file:
                one = json.load(file)
            report["context"] = one["context"]
            report["benchmarks"] += one["benchmarks"]
    return report


def medians(report):
    """A Row for every benchmark, in the order of registration: the medians of its repetitions."""
    runs = collections.defaultdict(list)
    for b in report["benchmarks"]:
        runs[b["family_index"], b["per_family_instance_index"], b["run_name"]].append(b)
    rows = []
    for key in sorted(runs):
        own = runs[key]
        name, *arguments = key[2].split("/")
        if not all(a.isdigit() for a in arguments):  # a captured name holds a slash too
            name, arguments = "/".join([name, arguments[0]]), arguments[1:]
        factor = {"ns": 1, "us": 1e3, "ms": 1e6, "s": 1e9}[own[0]["time_unit"]]
        middle = {k: statistics.median(b[k] for b in own) for k, v in own[0].items() if isinstance(v, (int, float))}
        rows.append(Row(name, tuple(arguments), middle["cpu_time"] * factor, middle))
    return rows


def logger(quick):
    """The Velodyne logger against the clock: nominal traffic, then bursts."""
    seconds, bursts, burst_s = (10, 2, 3) if quick else (600, 6, 10)
    progress = Progress("logger", seconds + bursts * burst_s)
    with subprocess.Popen([os.path.join(HERE, "logger.py"), *map(str, (seconds, bursts, burst_s))], stdout=subprocess.PIPE) as run:
        while run.poll() is None:
            progress.tell(min(time.monotonic() - progress.begin, progress.total - 1), " s")
            time.sleep(0.2)
        if run.returncode != 0:
            sys.exit(run.returncode)
        progress.tell(progress.total, " s")
        return json.loads(run.stdout.read())


def desktop(build, quick):
    """[name, value, unit] of each line "figure NAME: VALUE UNIT" of the tests that measure the window."""
    environment = {**os.environ, "HERMES_BIN": os.path.join(build, "bin"), "HERMES_SOURCE": ROOT, "QT_QPA_PLATFORM": "offscreen",
                   **({} if quick else {"HERMES_HOUR": "1", "HERMES_TRIALS": "20"}), "QTEST_FUNCTION_TIMEOUT": "600000"}
    programs = [program_of(build, "gui", "desktop", test) for test in ("TestSpeed", "TestCloud", "TestCloudDrawing", "TestBadLink")]
    functions = [subprocess.run([p, "-functions"], env=environment, stdout=subprocess.PIPE, text=True, check=True).stdout.count("()")
                 for p in programs]
    figures, done, progress = [], 0, Progress("desktop", sum(functions))
    for program in programs:
        shown = ""
        with subprocess.Popen([program], env=environment, stdout=subprocess.PIPE, text=True) as run:
            progress.tell(done)
            for line in run.stdout:
                shown += line
                done += bool(re.match(r"(PASS|FAIL!|SKIP) .*::(?!initTestCase|cleanupTestCase)", line))
                progress.tell(min(done, progress.total))
        figures += re.findall(r"figure (.*): (\S+) (.*)", shown)
        if run.returncode != 0:
            sys.exit(shown)
    return {"context": {}, "figures": figures}


def measure(name, repetitions, quick, options):
    """The report of a benchmark. Quick: within a minute, for a look."""
    build = os.environ.get("HERMES_BUILD") or os.path.join(ROOT, "build", "release")
    if name == "logger":  # a whole program against the clock, not a function
        return logger(quick)
    if name == "desktop":
        return desktop(build, quick)
    if not any(o.startswith("--benchmark_min_time") for o in options):
        if name == "motor":  # each cycle takes its 20 ms
            options = [*options, f"--benchmark_min_time={1 if quick else 5}"]
        elif quick:
            options = [*options, "--benchmark_min_time=0.02"]
    return google(name, program_of(build, "bench", "bench_" + name), repetitions, options)
