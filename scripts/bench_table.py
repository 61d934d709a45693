#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""The results of scripts/bench as one table in Markdown: times in units of the textbook's filter step, or as they are where that says more.

Usage: bench_table.py FOLDER [--write DOCUMENT]
FOLDER holds NAME.ROUND.json of each benchmark and compile_cost.json. A ratio is taken within a round, where both were timed; given is the median
over the rounds. The noise is half the central 68 % of the ratios. --write replaces what is between the markers in the document.
"""

import collections
import json
import math
import pathlib
import platform
import re
import statistics
import sys

BEGIN, END = "<!-- scripts/bench writes from here -->", "<!-- to here -->"

STEP_FORMS = {
    "textbook": "textbook, sizes fixed",
    "textbook_joseph": "textbook, Joseph's form",
    "textbook_dynamic": "textbook, sizes at run time",
    "scifi_joseph": "scifi, `joseph`",
    "scifi_symmetric": "scifi, `symmetric_form`",
    "scifi_lanes": "scifi, one track a lane, double",
    "scifi_floats": "scifi, one track a lane, float",
    "opencv": "OpenCV",
    "dlib": "dlib",
    "bfl": "BFL",
}
FIT_FORMS = {
    "filter": "filter",
    "filter_rts": "filter, Rauch-Tung-Striebel smoother",
    "filter_mbf": "filter, Bryson-Frazier smoother",
    "filter_lanes": "filter, one track a lane, double",
    "filter_mbf_lanes": "filter, smoother, one track a lane, double",
    "filter_floats": "filter, one track a lane, float",
    "filter_mbf_floats": "filter, smoother, one track a lane, float",
    "stage": "candidates to tracks with residuals, one by one",
    "stage_lanes": "candidates to tracks with residuals, `fit_batch`",
}
MODELS = {
    "helix_plain": "helix, plainly on matrices sized at run time",
    "helix": "helix",
    "stepped": "Runge-Kutta-Nystrom steps",
    "line": "straight line",
}
STAGES = {
    "clusters": "clusters",
    "space_points": "space points",
    "patterns": "pattern recognition",
    "patterns_of_true_points": "pattern recognition, points of the true tracks alone",
    "fit": "fit",
    "chain": "whole chain",
}


class results:
    """values[program][name][counter]: a list, one entry a round."""

    def __init__(self, folder):
        self.values = collections.defaultdict(lambda: collections.defaultdict(lambda: collections.defaultdict(list)))
        self.rounds = 0
        for path in sorted(folder.glob("*.*.json"), key=lambda p: (p.name.split(".")[0], int(p.name.split(".")[1]))):
            program = path.name.split(".")[0]
            for run in json.loads(path.read_text(encoding="utf-8"))["benchmarks"]:
                if run.get("run_type") != "iteration":
                    continue
                if run.get("error_occurred"):
                    sys.exit(f"{path.name}: {run['name']}: {run['error_message']}")
                for key, value in run.items():
                    if isinstance(value, (int, float)):
                        self.values[program][run["run_name"]][key].append(value)
            self.rounds = max(self.rounds, int(path.name.split(".")[1]))
        self.noise = 0.0

    def has(self, program, name):
        return name in self.values[program]

    def median(self, program, name, counter="ns"):
        return statistics.median(self.values[program][name][counter])

    def ratio(self, program, name, unit="textbook"):
        """In units of a benchmark of the same round."""
        ratios = [a / b for a, b in zip(self.values[program][name]["ns"], self.values[program][unit]["ns"])]
        median = statistics.median(ratios)
        if len(ratios) > 3:
            low, *_, high = [statistics.quantiles(ratios, n=100)[i] for i in (15, 83)]
            self.noise = max(self.noise, 0.5 * (high - low) / median)
        return median


def figure(value):
    if value >= 1000.0:
        return f"{value:,.0f}"
    return f"{value:.0f}" if value >= 100.0 else f"{value:.1f}" if value >= 10.0 else f"{value:.2f}"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "| --- |" + " ---: |" * (len(head) - 1)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def exponent(r, stage, counts):
    """Of the growth with the number of tracks: straight line through the logarithms."""
    x = [math.log(n) for n in counts]
    y = [math.log(r.median("chain", f"{stage}/{n}")) for n in counts]
    return statistics.linear_regression(x, y).slope


def step_table(r):
    sizes = ["5x1", "5x2", "6x3", "9x3"]
    peers = [p for p in ("opencv", "dlib", "bfl") if p in r.values]
    rows = []
    for form, name in STEP_FORMS.items():
        program = form if form in peers else "filter_step"
        if r.has(program, f"{form}/{sizes[0]}"):
            rows.append([name] + [figure(r.ratio(program, f"{form}/{s}", f"textbook/{s}")) if r.has(program, f"{form}/{s}") else "" for s in sizes])
    rows.append(["*textbook, ns*"] + [figure(r.median("filter_step", f"textbook/{s}")) for s in sizes])
    return "Filter step, dense constant matrices, (components, measured): in units of the textbook's step of the same size.\n\n" + table(["", *sizes], rows)


def fit_table(r):
    media = {"vacuum": "no material", "material": "all material"}
    rows = [[name] + [figure(r.ratio("track_fit", f"{form}/{m}")) for m in media] for form, name in FIT_FORMS.items()]
    out = "A track through fifteen planes: in units of the textbook's step (5x1).\n\n" + table(["", *media.values()], rows)
    rows = [[name] + [figure(r.ratio("track_models", f"{form}/{what}")) for what in ("filter", "filter_smoother")] for form, name in MODELS.items()]
    return out + "\nOther models of a track, all material: in the same unit.\n\n" + table(["", "filter", "filter and smoother"], rows)


def chain_table(r):
    counts = sorted({int(name.split("/")[1]) for name in r.values["chain"] if name.startswith("chain/")})
    grown = [n for n in counts if n >= 2]
    rows = []
    for stage, name in STAGES.items():
        rows.append([name] + [figure(r.ratio("chain", f"{stage}/{n}")) for n in counts] + [f"{exponent(r, stage, grown):.2f}"])
    out = "The chain in one tracker, per event, by tracks an event: in the same unit; exponent of the growth from 2 to 20 tracks.\n\n"
    out += table(["", *map(str, counts), "exponent"], rows)
    rows = []
    for n in (1, 4):
        run = {int(re.search(r"threads:(\d+)", name).group(1)): name for name in r.values["chain"] if name.startswith(f"throughput/{n}/")}
        one, all_cores = min(run), max(run)
        by_threads = [r.median("chain", run[t], "items_per_second") for t in (one, all_cores)]
        latency = [r.median("chain", f"latency/{n}", c) for c in ("median_us", "p99_us", "max_us")]
        rows.append([f"{n}"] + [figure(v) for v in by_threads] + [figure(by_threads[1] / by_threads[0])] + [figure(v) for v in latency])
    head = ["tracks an event", "events/s, one core", f"events/s, {all_cores} cores", "ratio", "one event: median, us", "99 %, us", "maximum, us"]
    return out + "\n" + table(head, rows)


def field_table(r):
    rows = [[re.sub(r"/um/(\d+)$", r", steps to \1 um", name)] + [figure(r.median("field", name, "cpu_time"))] for name in sorted(r.values["field"], reverse=True)]
    return "Fields, and flights over the length of a tracker in them, ns.\n\n" + table(["", "ns"], rows)


def compile_table(folder):
    found = json.loads((folder / "compile_cost.json").read_text(encoding="utf-8"))
    names = {"eigen": "`#include <Eigen/Dense>` alone", "one_filter": "one filter step (5x1)", "one_track": "fit of one helix", "everything": "`#include <scifi/scifi.hpp>`"}
    rows = [[name, figure(found[key]["seconds"]), figure(found[key]["seconds"] / found["eigen"]["seconds"]), figure(found[key]["megabytes"])] for key, name in names.items()]
    return "What a translation unit costs to compile.\n\n" + table(["", "processor time, s", "in units of Eigen", "peak memory, MB"], rows)


def main():
    folder = pathlib.Path(sys.argv[1])
    r = results(folder)
    parts = [step_table(r), fit_table(r), chain_table(r), field_table(r), compile_table(folder)]
    cpu = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8")) if pathlib.Path("/proc/cpuinfo").exists() else None
    unit = r.median("filter_step", "textbook/5x1")
    machine = f"{cpu.group(1).strip() if cpu else platform.processor()}: the textbook's step (5x1) takes {unit:.0f} ns. Medians of {r.rounds} rounds; noise of a ratio: at most {100 * r.noise:.0f} %."
    text = machine + "\n\n" + "\n".join(parts)
    print(text)
    medians = {program: {name: {c: statistics.median(v) for c, v in counters.items()} for name, counters in names.items()} for program, names in r.values.items()}
    (folder / "medians.json").write_text(json.dumps(medians, indent=1) + "\n", encoding="utf-8")
    if "--write" in sys.argv:
        document = pathlib.Path(sys.argv[sys.argv.index("--write") + 1])
        before, _, rest = document.read_text(encoding="utf-8").partition(BEGIN)
        _, end, after = rest.partition(END)
        if not end:
            sys.exit(f"{document}: the markers {BEGIN} and {END} are not there")
        document.write_text(f"{before}{BEGIN}\n{text}\n{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    main()
