#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""Compares reconstructed tracks with the truth of a simulation: prints a table, draws pictures.

A track is expected of a true particle that crosses all planes of four stations, the first among them, within 150 mm of the
axis and with pt/pz < 0.5. Of the tracks in the same event and tracker that start within 10 mm of it, the nearest is its track.
Residual = reconstructed - true at the reference surface (z = 0 of the tracker frame); spread = half the width of the
central 68.27 %, which a few outliers do not change.
"""

import argparse
import collections
import csv
import gzip
import math
import pathlib
import re
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend is chosen first)
import numpy as np  # noqa: E402
from matplotlib.ticker import LogLocator, NullFormatter, ScalarFormatter  # noqa: E402

plt.rcParams.update({"xtick.direction": "in", "ytick.direction": "in", "xtick.top": True, "ytick.right": True,
                     "xtick.minor.visible": True, "ytick.minor.visible": True, "legend.frameon": False})

TESLA = 0.299792458  # (MeV/c)/(e mm)
FIDUCIAL_RADIUS = 150.0  # mm
MATCH_RADIUS = 10.0  # mm
PT_EDGES = np.array([0.0, 5.0, 10.0, 20.0, 30.0, 40.0, 50.0, 70.0, 90.0])  # MeV/c
TRACKERS = {0: ("tracker 0 (upstream)", "#0072B2", "o"), 1: ("tracker 1 (downstream)", "#D55E00", "s")}  # Okabe and Ito 2008
REFERENCE_COLOUR = "#555555"
PULLS = ["x", "y", "px", "py", "pz"]
QUANTITY = {"x": ("$x$", "mm"), "y": ("$y$", "mm"), "px": ("$p_x$", "MeV/$c$"), "py": ("$p_y$", "MeV/$c$"),
            "pt": ("$p_T$", "MeV/$c$"), "pz": ("$p_z$", "MeV/$c$")}


def rows(path):
    opener = gzip.open if str(path).endswith(".gz") else open
    with opener(path, "rt", newline="", encoding="utf-8") as stream:
        yield from csv.DictReader(stream)


def state(row):
    return {"x": float(row["x_mm"]), "y": float(row["y_mm"]),
            "px": float(row["px_MeV"]), "py": float(row["py_MeV"]), "pz": float(row["pz_MeV"])}


def expected_particles(path):
    """(event, tracker) -> true states at the reference surface of the particles a track is expected of."""
    planes, start = collections.defaultdict(set), {}
    for row in rows(path):
        key = int(row["event"]), int(row["tracker"]), int(row["track"])
        where = int(row["station"]), int(row["plane"])
        now = state(row)
        if math.hypot(now["x"], now["y"]) < FIDUCIAL_RADIUS:
            planes[key].add(where)
        if where == (1, 0):
            start[key] = now
    expected = collections.defaultdict(list)
    for key, truth in start.items():
        stations = {s for s in range(1, 6) if all((s, p) in planes[key] for p in range(3))}
        truth["pt"] = math.hypot(truth["px"], truth["py"])
        if 1 in stations and len(stations) >= 4 and truth["pt"] < 0.5 * abs(truth["pz"]):
            expected[key[:2]].append(truth)
    return expected


def found_tracks(path):
    """(event, tracker) -> reconstructed states with their errors."""
    found = collections.defaultdict(list)
    for row in rows(path):
        track = state(row)
        track["sigma"] = {name: float(row[f"sigma_{name}_{'MeV' if name[0] == 'p' else 'mm'}"]) for name in PULLS}
        track.update(chi2=float(row["chi2"]), ndf=float(row["ndf"]), p_value=float(row["p_value"]))
        found[int(row["event"]), int(row["tracker"])].append(track)
    return found


def match(truths, tracks):
    """Pairs (true state, track or None), each track used once, nearest first."""
    near = sorted((math.hypot(track["x"] - truth["x"], track["y"] - truth["y"]), i, j)
                  for i, truth in enumerate(truths) for j, track in enumerate(tracks))
    partner, used = {}, set()
    for distance, i, j in near:
        if distance < MATCH_RADIUS and i not in partner and j not in used:
            partner[i] = tracks[j]
            used.add(j)
    return [(truth, partner.get(i)) for i, truth in enumerate(truths)]


def count_ghosts(truth_path, found):
    """Tracks with no true particle within the matching radius at the reference surface, expected or not; and the number of events."""
    at_reference, events, ghosts = collections.defaultdict(list), set(), collections.Counter()
    for row in rows(truth_path):
        events.add(row["event"])
        if (row["station"], row["plane"]) == ("1", "0"):
            at_reference[int(row["event"]), int(row["tracker"])].append(state(row))
    for key, tracks in found.items():
        pairs = match(at_reference[key], tracks)
        ghosts[key[1]] += len(tracks) - sum(track is not None for _, track in pairs)
    return ghosts, max(1, len(events))


def residual(pair, name):
    truth, track = pair
    if name == "pt":
        return math.hypot(track["px"], track["py"]) - truth["pt"]
    if name == "pz":
        return abs(track["pz"]) - abs(truth["pz"])
    return track[name] - truth[name]


def pull(pair, name):
    truth, track = pair
    return (track[name] - truth[name]) / track["sigma"][name]


def spread(values):
    return 0.5 * float(np.subtract(*np.nanpercentile(values, [84.135, 15.865]))) if len(values) > 1 else math.nan


def efficiency(pairs):
    """Found share and its binomial error (Wilson's, one standard deviation: sensible at 0 and 1)."""
    n, k = len(pairs), sum(track is not None for _, track in pairs)
    if n == 0:
        return math.nan, 0.0, 0.0
    centre, half = (k + 0.5) / (n + 1), math.sqrt(k * (n - k) / n + 0.25) / (n + 1)
    return k / n, max(0.0, k / n - (centre - half)), max(0.0, centre + half - k / n)


def in_pt_bins(pairs):
    return [[p for p in pairs if low <= p[0]["pt"] < high] for low, high in zip(PT_EDGES, PT_EDGES[1:])]


def print_table(by_tracker):
    for tracker, pairs in by_tracker.items():
        good = [p for p in pairs if p[1] is not None]
        share = efficiency(pairs)
        print(f"\n{TRACKERS[tracker][0]}: {len(pairs)} expected, {len(good)} found, efficiency {share[0]:.4f}")
        print("  pt MeV/c     expected  efficiency  spread of pt  spread of pz (MeV/c)")
        for low, high, pairs_in_bin in zip(PT_EDGES, PT_EDGES[1:], in_pt_bins(pairs)):
            if pairs_in_bin:
                hits = [p for p in pairs_in_bin if p[1] is not None]
                print(f"  {low:3.0f} to {high:3.0f} {len(pairs_in_bin):11d} {efficiency(pairs_in_bin)[0]:11.4f}"
                      f" {spread([residual(p, 'pt') for p in hits]):13.3f} {spread([residual(p, 'pz') for p in hits]):13.2f}")
        if not good:
            continue
        print("  residual     median    spread")
        for name, unit in (("x", "mm"), ("y", "mm"), ("pt", "MeV/c"), ("pz", "MeV/c")):
            values = [residual(p, name) for p in good]
            print(f"  {name:4s} {np.median(values):+14.4f} {spread(values):9.4f} {unit}")
        print("  pull         median    spread   (ideal: 0 and 1)")
        for name in PULLS:
            values = [pull(p, name) for p in good]
            print(f"  {name:4s} {np.nanmedian(values):+14.3f} {spread(values):9.3f}")
        reduced = [p[1]["chi2"] / p[1]["ndf"] for p in good if p[1]["ndf"] > 0]
        print(f"  chi2/ndf mean {np.mean(reduced):.3f}, median {np.median(reduced):.3f}")


def print_summary(by_tracker, ghosts, events, logs):
    """One row a figure, one column a tracker; times are those the programs report, for both trackers of an event together."""
    def row(name, value_of, form):
        print(f"  {name:44s}" + "".join(f"{value_of(tracker, pairs):>14{form}}" for tracker, pairs in by_tracker.items()))

    good = {tracker: [p for p in pairs if p[1] is not None] for tracker, pairs in by_tracker.items()}
    print("\nSummary" + " " * 39 + "".join(f"{TRACKERS[tracker][0].split('(')[1].rstrip(')'):>14s}" for tracker in by_tracker))
    row("tracks expected", lambda t, pairs: len(pairs), "d")
    row("efficiency", lambda t, pairs: efficiency(pairs)[0], ".4f")
    row("ghosts per event", lambda t, pairs: ghosts[t] / events, ".4f")
    for name, unit in (("x", "mm"), ("pt", "MeV/c"), ("pz", "MeV/c")):
        row(f"spread of {name} [{unit}]", lambda t, pairs, name=name: spread([residual(p, name) for p in good[t]]), ".3f")
    for name in PULLS:
        row(f"spread of the pull of {name}", lambda t, pairs, name=name: spread([pull(p, name) for p in good[t]]), ".3f")
    row("chi2 per degree of freedom", lambda t, pairs: np.mean([p[1]["chi2"] / p[1]["ndf"] for p in good[t] if p[1]["ndf"] > 0]), ".3f")
    for log in logs:
        for name, value in re.findall(r"(flight|digitisation|reconstruction) ([0-9.]+) us", pathlib.Path(log).read_text(encoding="utf-8")):
            print(f"  time per event and thread: {name + ' [us]':17s}{float(value):14.1f}   both trackers")


def panels(title, columns):
    figure, axes = plt.subplots(1, columns, figsize=(3.6 * columns, 3.4), layout="constrained", squeeze=False)
    figure.suptitle(title)
    return figure, axes[0]


def save(figure, folder, name):
    path = folder / f"{name}.png"
    figure.savefig(path, dpi=160)
    plt.close(figure)
    print(f"drew {path}")


def against_pt(axis, pairs_of, value_of, label):
    """One point a bin of pt and tracker; the trackers are drawn a little apart."""
    middle, half = 0.5 * (PT_EDGES[1:] + PT_EDGES[:-1]), 0.5 * np.diff(PT_EDGES)
    for tracker, pairs in pairs_of.items():
        name, colour, marker = TRACKERS[tracker]
        points = [value_of(b) for b in in_pt_bins(pairs)]
        axis.errorbar(middle + (tracker - 0.5), [p[0] for p in points], xerr=half,
                      yerr=np.array([p[1:] for p in points]).T, fmt=marker, color=colour, label=name, markersize=5, linewidth=1)
    axis.set_xlabel("true $p_T$ at the reference surface [MeV/$c$]")
    axis.set_ylabel(label)
    low, high = axis.get_ylim()
    axis.set_ylim(low - 0.2 * (high - low), high)  # room for the legend
    axis.legend(fontsize="small", loc="lower left")


def spread_with_error(pairs, name):
    values = [residual(p, name) for p in pairs if p[1] is not None]
    width = spread(values) if len(values) > 20 else math.nan
    error = 1.15 * width / math.sqrt(max(1, len(values)))  # of half a central 68 % interval of a Gaussian sample
    return width, error, error


def draw(by_tracker, folder):
    good = {tracker: [p for p in pairs if p[1] is not None] for tracker, pairs in by_tracker.items()}

    figure, axes = plt.subplots(figsize=(5.2, 3.8), layout="constrained")
    against_pt(axes, by_tracker, efficiency, "share of expected tracks found")
    axes.set_title("Efficiency")
    save(figure, folder, "efficiency")

    figure, axes = panels("Residuals at the reference surface (reconstructed - true)", 4)
    for axis, name in zip(axes, ("x", "y", "pt", "pz")):
        symbol, unit = QUANTITY[name]
        values = {t: np.array([residual(p, name) for p in pairs]) for t, pairs in good.items()}
        reach = 5 * max(spread(v) for v in values.values())
        for tracker, v in values.items():
            axis.hist(v, bins=60, range=(-reach, reach), histtype="step", color=TRACKERS[tracker][1], linewidth=1.4,
                      linestyle="-" if tracker else "--", label=f"{TRACKERS[tracker][0]}\nspread {spread(v):.3g}")
        axis.set_xlabel(f"residual of {symbol} [{unit}]")
        axis.legend(fontsize="x-small", loc="upper left")
        axis.set_ylim(top=1.4 * axis.get_ylim()[1])
    axes[0].set_ylabel("tracks")
    save(figure, folder, "residuals")

    figure, axes = panels("Momentum resolution", 2)
    for axis, name in zip(axes, ("pt", "pz")):
        against_pt(axis, by_tracker, lambda pairs, name=name: spread_with_error(pairs, name),
                   f"spread of {QUANTITY[name][0]} [MeV/$c$]")
    axes[1].set_yscale("log")
    axes[1].set_ylim(bottom=1.0)
    axes[1].legend(fontsize="small", loc="upper right")
    axes[1].yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes[1].yaxis.set_major_formatter(ScalarFormatter())
    axes[1].yaxis.set_minor_formatter(NullFormatter())
    save(figure, folder, "momentum_resolution")

    figure, axes = panels("Pulls at the reference surface, and the normal distribution they should follow", 5)
    t = np.linspace(-5, 5, 201)
    for axis, name in zip(axes, PULLS):
        for tracker, pairs in good.items():
            v = np.array([pull(p, name) for p in pairs])
            axis.hist(v, bins=50, range=(-5, 5), density=True, histtype="step", color=TRACKERS[tracker][1], linewidth=1.4,
                      linestyle="-" if tracker else "--", label=f"tracker {tracker}: {spread(v):.2f}")
        axis.plot(t, np.exp(-0.5 * t * t) / math.sqrt(2 * math.pi), color=REFERENCE_COLOUR, linewidth=1, linestyle=":")
        axis.set_xlabel(f"pull of {QUANTITY[name][0]}")
        axis.legend(fontsize="x-small", title="spread", title_fontsize="x-small", loc="upper left")
        axis.set_ylim(top=1.3 * axis.get_ylim()[1])
    axes[0].set_ylabel("density")
    save(figure, folder, "pulls")

    figure, axes = panels("Goodness of fit", 2)
    for tracker, pairs in good.items():
        name, colour, _ = TRACKERS[tracker]
        style = {"histtype": "step", "color": colour, "label": name, "linewidth": 1.4, "linestyle": "-" if tracker else "--"}
        axes[0].hist([p[1]["chi2"] / p[1]["ndf"] for p in pairs if p[1]["ndf"] > 0], bins=60, range=(0, 4), **style)
        axes[1].hist([p[1]["p_value"] for p in pairs], bins=25, range=(0, 1), **style)
        axes[1].axhline(len(pairs) / 25, color=colour, linewidth=1, linestyle=":")
    axes[0].set_xlabel(r"$\chi^2$ / degrees of freedom")
    axes[1].set_xlabel("p-value (dotted: flat)")
    axes[1].set_ylim(bottom=0)
    axes[0].set_ylabel("tracks")
    axes[0].legend(fontsize="small")
    save(figure, folder, "goodness_of_fit")


def helix(point, z, field):
    """x and y at z of the helix through a fitted point; field in (MeV/c)/(e mm)."""
    length, k = z - point["z"], field * point["q_over_pz"]
    sine, cosine = (np.sin(k * length) / k, (1 - np.cos(k * length)) / k) if abs(k) > 1e-9 else (length, 0.5 * k * length**2)
    return (point["x"] + point["tx"] * sine + point["ty"] * cosine, point["y"] + point["ty"] * sine - point["tx"] * cosine)


def draw_event(truth_path, points_path, field, folder):
    """The event with a track in each tracker that shows their bending best: true crossings, and the fit as a helix from plane to plane."""
    tracks = collections.defaultdict(lambda: collections.defaultdict(list))
    for row in rows(points_path):
        point = {"z": float(row["z_mm"]), "x": float(row["x_mm"]), "y": float(row["y_mm"]),
                 "tx": float(row["tx"]), "ty": float(row["ty"]), "q_over_pz": float(row["q_over_pz"])}
        tracks[int(row["event"])][int(row["tracker"]), int(row["track"])].append(point)
    complete = [event for event, found in tracks.items() if {tracker for tracker, _ in found} == set(TRACKERS)]
    if not complete:
        return
    event = max(complete, key=lambda e: min(math.hypot(points[0]["tx"], points[0]["ty"]) for points in tracks[e].values()))
    true = collections.defaultdict(list)
    for row in rows(truth_path):
        if int(row["event"]) == event:
            true[int(row["tracker"])].append((float(row["z_mm"]), float(row["x_mm"]), float(row["y_mm"])))

    figure, axes = plt.subplots(2, 3, figsize=(11, 6), layout="constrained", width_ratios=[2, 2, 1.2])
    figure.suptitle(f"Event {event}: true crossings (circles) and fitted tracks (lines)")
    for line, (tracker, (name, colour, _)) in zip(axes, TRACKERS.items()):
        crossings = np.array(true[tracker])
        views = [(0, 1, "z", "x"), (0, 2, "z", "y"), (1, 2, "x", "y")]
        for axis, (across, up, label_across, label_up) in zip(line, views):
            axis.plot(crossings[:, across], crossings[:, up], "o", markerfacecolor="none", color=REFERENCE_COLOUR, markersize=6)
            for key, points in tracks[event].items():
                if key[0] != tracker:
                    continue
                points = sorted(points, key=lambda p: p["z"])
                for start, end in zip(points, points[1:]):
                    z = np.linspace(start["z"], end["z"], 25)
                    drawn = (z, *helix(start, z, field))
                    axis.plot(drawn[across], drawn[up], "-", color=colour, linewidth=1.2)
            axis.set_xlabel(f"${label_across}$ [mm]")
            axis.set_ylabel(f"${label_up}$ [mm]")
        line[0].set_title(name)
        line[2].set_aspect("equal", adjustable="datalim")
    save(figure, folder, "event")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("truth", help="CSV of plane crossings written by scifi-simulate")
    parser.add_argument("tracks", help="CSV of tracks written by scifi-reconstruct")
    parser.add_argument("folder", type=pathlib.Path, help="where the pictures go")
    parser.add_argument("--points", help="CSV of fitted track points, for the picture of an event")
    parser.add_argument("--field", type=float, default=3.0, help="tesla, for the picture of an event")
    parser.add_argument("--logs", nargs="*", default=[], help="what the programs printed, for the times in the summary")
    parser.add_argument("--least-efficiency", type=float, default=0.0, help="fail below this share of found tracks")
    options = parser.parse_args()

    expected, found = expected_particles(options.truth), found_tracks(options.tracks)
    by_tracker = collections.defaultdict(list)
    for key, truths in sorted(expected.items()):
        by_tracker[key[1]] += match(truths, found.get(key, []))
    ghosts, events = count_ghosts(options.truth, found)
    if not by_tracker:
        print(f"{options.truth}: no particle crosses four stations", file=sys.stderr)
        return 1
    by_tracker = dict(sorted(by_tracker.items()))
    print_table(by_tracker)
    worst = min(efficiency(pairs)[0] for pairs in by_tracker.values())
    if worst <= options.least_efficiency:
        print(f"efficiency {worst:.4f} is not above {options.least_efficiency}", file=sys.stderr)
        return 1
    print()
    options.folder.mkdir(parents=True, exist_ok=True)
    draw(by_tracker, options.folder)
    if options.points:
        draw_event(options.truth, options.points, options.field * TESLA, options.folder)
    print_summary(by_tracker, ghosts, events, options.logs)
    return 0


if __name__ == "__main__":
    sys.exit(main())
