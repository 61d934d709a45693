#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""Prints the results of scripts/bench: nanoseconds and ratios to the textbook filter step on fixed-size Eigen matrices.

Usage: bench_table.py FILTER_STEP.json TRACK_FIT.json
Medians of the repetitions; the spread is half the central 68 % of them, relative to the median.
"""

import collections
import json
import statistics
import sys

STEP_FORMS = {
    "textbook_dynamic": "textbook, run-time sizes",
    "textbook_joseph": "textbook, Joseph's form",
    "textbook": "textbook",
    "scifi_joseph": "scifi, joseph (default)",
    "scifi_symmetric": "scifi, symmetric_form",
}
FIT_FORMS = {
    "filter": "filter",
    "filter_rts": "filter, Rauch-Tung-Striebel smoother",
    "filter_mbf": "filter, Bryson-Frazier smoother",
    "filter_lanes": "filter, one track a lane, double",
    "filter_mbf_lanes": "  and Bryson-Frazier smoother",
    "filter_floats": "filter, one track a lane, float",
    "filter_mbf_floats": "  and Bryson-Frazier smoother",
    "stage": "candidates to tracks, with residuals",
    "stage_lanes": "  one track a lane, double",
}


def timings(path):
    """{(form, case): list of ns, one a repetition}."""
    found = collections.defaultdict(list)
    with open(path, encoding="utf-8") as file:
        for run in json.load(file)["benchmarks"]:
            if run["run_type"] == "iteration":
                form, _, case = run["run_name"].partition("/")
                found[form, case.partition("/repeats")[0]].append(run["ns"])
    return found


def spread(values):
    low, high = (statistics.quantiles(values, n=100)[i] for i in (15, 83)) if len(values) > 1 else (values[0], values[0])
    return 0.5 * (high - low) / statistics.median(values)


def table(title, forms, cases, found, unit_of):
    print(f"{title:42s}" + "".join(f"{case:>20s}" for case in cases))
    for form, name in forms.items():
        cells = []
        for case in cases:
            median = statistics.median(found[form, case])
            cells.append(f"{median:10.1f} ({median / unit_of(case):6.2f})")
        print(f"  {name:40s}" + "".join(f"{cell:>20s}" for cell in cells))
    worst = max(spread(values) for values in found.values())
    print(f"  spread of the repetitions: at most {100 * worst:.0f} %\n")


def main():
    step, fit = timings(sys.argv[1]), timings(sys.argv[2])
    sizes = list(dict.fromkeys(case for _, case in step))
    table("filter step, ns (ratio to textbook)", STEP_FORMS, sizes, step, lambda case: statistics.median(step["textbook", case]))
    unit = statistics.median(fit["textbook", ""])
    media = list(dict.fromkeys(case for form, case in fit if form != "textbook"))
    table(f"track, ns (in steps of {unit:.1f} ns)", FIT_FORMS, media, fit, lambda _: unit)


if __name__ == "__main__":
    main()
