#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""Draws what scifi-study found: DIR/*.png, DIR/*.svg and DIR/study.html, one page with everything in it.

Usage: draw_study.py DIR/study.json DIR
Computes nothing: every number is in the JSON. Needs matplotlib 3.6; exit status 69 without it.
"""

import base64
import html
import json
import math
import pathlib
import sys

try:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    import numpy as np
    from matplotlib.patches import Circle, Rectangle
    from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter
except ImportError:
    sys.exit(69)

# Okabe and Ito 2008: told apart by all kinds of colour vision.
BLACK, ORANGE, SKY, GREEN, BLUE, VERMILLION, PURPLE = "#000000", "#E69F00", "#56B4E9", "#009E73", "#0072B2", "#D55E00", "#CC79A7"
GREY = "#767676"
TRACKER_STYLES = [(BLUE, "o", "-"), (VERMILLION, "s", "--"), (GREEN, "^", "-."), (PURPLE, "D", ":")]
SYMBOL = {"x": "$x$", "y": "$y$", "tx": "$dx/dz$", "ty": "$dy/dz$", "px": "$p_x$", "py": "$p_y$", "pt": "$p_T$", "pz": "$p_z$", "q_over_pz": "$q/p_z$"}
MOMENTUM = {"pt": "true $p_T$ [MeV/$c$]", "pz": "true $|p_z|$ [MeV/$c$]"}
PAGE_WIDTH = 9.0  # inches, of a figure over the whole page

plt.rcParams.update({
    "font.size": 9, "axes.titlesize": 9, "axes.labelsize": 9, "xtick.labelsize": 8, "ytick.labelsize": 8, "legend.fontsize": 8,
    "legend.frameon": False, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.color": "#DDDDDD", "grid.linewidth": 0.6,
    "axes.axisbelow": True, "figure.dpi": 100, "savefig.dpi": 150, "svg.hashsalt": "scifi", "lines.linewidth": 1.3, "figure.constrained_layout.use": True})


def number(value):
    """A number of the JSON; null is NaN."""
    return math.nan if value is None else float(value)


def numbers(values):
    return np.array([number(v) for v in values])


def unit_text(unit):
    return {"1": "", "": "", "MeV/c": " [MeV/$c$]"}.get(unit, f" [{unit}]")


def edges_of(histogram):
    return np.linspace(histogram["low"], histogram["high"], len(histogram["counts"]) + 1)


def steps(axis, histogram, weight=1.0, **style):
    """A histogram as a line; nothing below its lowest edge."""
    axis.stairs(numbers(histogram["counts"]) * weight, edges_of(histogram), linewidth=1.3, **style)


def legend_below(figure, handles, labels):
    """One legend for all panels, under them."""
    height = 0.28 / figure.get_figheight()
    figure.get_layout_engine().set(rect=(0, height, 1, 1 - height))
    figure.legend(handles, labels, loc="lower center", ncols=len(handles))


class Page:
    """The figures in the order they were drawn, and how they are kept."""

    def __init__(self, folder):
        self.folder, self.figures = folder, []

    def keep(self, figure, name, title, caption):
        figure.savefig(self.folder / f"{name}.png", metadata={"Software": None})
        figure.set_layout_engine("none")  # everything has its place by now
        figure.savefig(self.folder / f"{name}.svg", metadata={"Date": None})
        plt.close(figure)
        self.figures.append((name, title, caption))


class Study:
    def __init__(self, document):
        self.document = document
        self.trackers = document["trackers"]
        self.before = document.get("before", {}).get("all")
        self.planes_before = {t["tracker"]: t["planes"] for t in document.get("before", {}).get("trackers", [])}

    def styled(self):
        """(tracker, colour, marker, line style, name)"""
        return [(t, *TRACKER_STYLES[i % len(TRACKER_STYLES)], f"tracker {t['tracker']}" + (f" ({t['name']})" if t["name"] else "")) for i, t in enumerate(self.trackers)]


def bins_of(rows, name):
    low, high = numbers(r[name][0] for r in rows), numbers(r[name][1] for r in rows)
    return 0.5 * (low + high), 0.5 * (high - low)


def aside(i, count, half):
    """Points of several trackers in one bin stand a little apart."""
    return (i - 0.5 * (count - 1)) * 0.25 * half


def draw_efficiency(study, page):
    figure, axes = plt.subplots(1, 2, figsize=(PAGE_WIDTH, 3.2), sharey=True)
    lowest = 1.0
    for axis, name in zip(axes, ("pt", "pz")):
        for i, (tracker, colour, marker, _, label) in enumerate(study.styled()):
            rows = [r for r in tracker["efficiency_in_bins"]["by_" + name] if r["expected"] > 0]
            if not rows:
                continue
            middle, half = bins_of(rows, name)
            value, low, high = (numbers(r[k] for r in rows) for k in ("value", "low", "high"))
            axis.errorbar(middle + aside(i, len(study.trackers), half), value, xerr=half, yerr=[np.maximum(value - low, 0.0), np.maximum(high - value, 0.0)],
                          fmt=marker, color=colour, markersize=4.5, linewidth=1.1, label=label)
            lowest = min(lowest, low.min())
        axis.set_xlabel(MOMENTUM[name])
    axes[0].set_ylabel("efficiency")
    axes[0].set_ylim(max(0.0, lowest - 0.15 * (1.002 - lowest)), 1.0 + 0.05 * (1.002 - lowest))
    axes[1].legend(loc="lower right")
    page.keep(figure, "efficiency", "Efficiency",
              "Share of the expected particles that have a track, against their true momentum at the reference surface. Bars: Wilson intervals, 68.27 %; across: bins.")

    figure, axes = plt.subplots(1, len(study.trackers), figsize=(min(PAGE_WIDTH, 1.2 + 4.2 * len(study.trackers)), 4.0), squeeze=False)
    values = [c["value"] for t in study.trackers for c in t["efficiency_in_bins"]["by_pt_and_pz"] if c["expected"] > 0]
    lowest = min([0.98] + values)
    for axis, (tracker, *_, label) in zip(axes[0], study.styled()):
        grid, cells = grid_of(study), tracker["efficiency_in_bins"]["by_pt_and_pz"]
        drawn = map_of(axis, grid, cells, "value", lambda c: c["expected"] > 0, vmin=lowest, vmax=1.0, cmap="cividis")
        for c in cells:
            if c["expected"] > 0:
                text_in_cell(axis, grid, c, f"{c['found']}/{c['expected']}", "black" if c["value"] > 0.5 * (1.0 + lowest) else "white")
        axis.set_title(label)
        axis.set_xlabel(MOMENTUM["pz"])
    axes[0][0].set_ylabel(MOMENTUM["pt"])
    figure.colorbar(drawn, ax=axes[0], label="efficiency")
    page.keep(figure, "efficiency_map", "Efficiency in two dimensions", "Found and expected particles in bins of true pz and pt. The bins of pt are drawn equally high.")


def grid_of(study, wide=""):
    """Edges of the cells in pt and pz."""
    return study.document["definitions"][wide + "pt_edges"], study.document["definitions"][wide + "pz_edges"]


def place(grid, cell):
    return grid[0].index(cell["pt"][0]), grid[1].index(cell["pz"][0])


def map_of(axis, grid, cells, key, known, **style):
    values = np.full((len(grid[0]) - 1, len(grid[1]) - 1), np.nan)
    for c in cells:
        if known(c):
            values[place(grid, c)] = number(c[key])
    drawn = axis.pcolormesh(grid[1], np.arange(len(grid[0])), np.ma.masked_invalid(values), edgecolors="white", linewidth=0.8, **style)
    axis.set_yticks(np.arange(len(grid[0])), [f"{e:g}" for e in grid[0]])
    axis.set_xticks(grid[1])
    axis.grid(False)
    return drawn


def text_in_cell(axis, grid, cell, text, colour):
    axis.text(0.5 * sum(cell["pz"]), place(grid, cell)[0] + 0.5, text, ha="center", va="center", fontsize=6.5, color=colour)


def draw_residuals(study, page):
    names = [n for n in ("x", "y", "pt", "pz", "tx", "ty") if n in study.document["all"]["residuals"]]
    names = names[:4] if "pt" in names else names
    figure, axes = plt.subplots(2, 2, figsize=(PAGE_WIDTH, 6.0))
    for axis, name in zip(axes.flat, names):
        highest, lowest = 0.0, 1.0
        for tracker, colour, _, style, label in study.styled():
            r = tracker["residuals"].get(name)
            if r is None or not r["n"]:
                continue
            counts, edges = numbers(r["histogram"]["counts"]) / r["n"], edges_of(r["histogram"])
            highest, lowest = max(highest, counts.max()), min(lowest, 0.5 / r["n"])
            steps(axis, r["histogram"], 1.0 / r["n"], color=colour, linestyle=style, label=f"{label}: spread {r['spread']:.3g}, {100 * r['beyond_5_spreads']:.2g} % beyond 5")
            # A normal distribution as wide as the core.
            at = np.linspace(edges[0], edges[-1], 400)
            core = (edges[1] - edges[0]) / (r["spread"] * math.sqrt(2 * math.pi)) * np.exp(-0.5 * ((at - r["median"]) / r["spread"]) ** 2)
            axis.plot(at, np.where(core > 0.5 / r["n"], core, np.nan), color=colour, linewidth=0.8, linestyle=":")
            for side in (-5, 5):
                if abs(side * r["spread"]) < edges[-1]:
                    axis.axvline(side * r["spread"], ymax=0.7, color=colour, linewidth=0.7, linestyle=(0, (1, 3)))
        if study.before and name in study.before["residuals"]:
            r = study.before["residuals"][name]
            steps(axis, r["histogram"], 1.0 / max(1, r["n"]), color=GREY, label=f"before: spread {r['spread']:.3g}, {100 * r['beyond_5_spreads']:.2g} % beyond 5")
        unit = study.document["all"]["residuals"][name]["unit"]
        axis.set_yscale("log")
        axis.set_ylim(lowest, highest * 20)
        axis.set_xlabel(f"{SYMBOL[name]} reconstructed $-$ true{unit_text(unit)}")
        axis.set_ylabel("share of the tracks per bin")
        axis.legend(loc="upper center", handlelength=1.8)
    page.keep(figure, "residuals", "Residuals at the reference surface",
              "Reconstructed minus true; pt along its true direction. Spread: half the width of the central 68.27 %. Dotted: a normal distribution of that width; vertical "
              "dotted lines: five spreads. Tracks outside the drawn range count in the numbers all the same.")


def draw_pulls(study, page):
    names = list(study.document["all"]["pulls"])
    figure, axes = plt.subplots(1, len(names), figsize=(PAGE_WIDTH, 2.6), sharey=True, squeeze=False)
    t = np.linspace(-5, 5, 201)
    highest = 0.4
    for axis, name in zip(axes[0], names):
        shown = [(tracker, colour, style, "") for tracker, colour, _, style, _ in study.styled()] + ([(study.before, GREY, "-", "before: ")] if study.before else [])
        for block, colour, style, whose in shown:
            r = block["pulls"].get(name)
            if r is None:
                continue
            width = (r["histogram"]["high"] - r["histogram"]["low"]) / len(r["histogram"]["counts"])
            counts = numbers(r["histogram"]["counts"]).reshape(-1, 2).sum(axis=1)  # drawn in bins twice as wide
            density = counts / max(1, r["n"]) / (2 * width)
            highest = max(highest, density.max())
            axis.stairs(density, np.linspace(r["histogram"]["low"], r["histogram"]["high"], len(density) + 1), color=colour, linestyle=style, linewidth=1.2,
                        label=f"{whose}{r['median']:+.2f}, {r['spread']:.3f}")
        axis.plot(t, np.exp(-0.5 * t * t) / math.sqrt(2 * math.pi), color=BLACK, linewidth=0.9, linestyle=":")
        axis.set_xlabel(f"pull of {SYMBOL[name]}")
        axis.set_xticks([-4, -2, 0, 2, 4])
        axis.legend(loc="upper center", title="median, spread", title_fontsize=8, handlelength=1.4)
    axes[0][0].set_ylim(0, (1.7 if study.before else 1.55) * highest)
    axes[0][0].set_ylabel("tracks per unit")
    page.keep(figure, "pulls", "Pulls at the reference surface",
              "Residual over the standard deviation that the fit states. Dotted: the normal distribution. " + tracker_key(study))


def tracker_key(study):
    look = {"-": "full", "--": "broken", "-.": "dash-dotted", ":": "dotted"}
    return "; ".join(f"{label}: {look[style]} line" for _, _, _, style, label in study.styled()).capitalize() + "."


def draw_goodness(study, page):
    figure, axes = plt.subplots(1, 2, figsize=(PAGE_WIDTH, 3.2))
    shown = [(tracker, colour, style, label) for tracker, colour, _, style, label in study.styled()] + ([(study.before, GREY, "-", "before")] if study.before else [])
    for block, colour, style, label in shown:
        c, p = block["chi2_per_ndf"], block["p_value"]
        if not c["n"]:
            continue
        steps(axes[0], c["histogram"], 1.0 / c["n"], color=colour, linestyle=style, label=f"{label}: mean {c['mean']:.3f}, median {c['median']:.3f}")
        steps(axes[1], p["histogram"], 1.0 / p["n"], color=colour, linestyle=style, label=f"{label}: distance from flat {p['kolmogorov_smirnov_distance']:.3f}")
        axes[1].axhline(1.0 / len(p["histogram"]["counts"]), color=BLACK, linewidth=0.9, linestyle=":")
    axes[0].set_xlabel(r"$\chi^2$ / degrees of freedom")
    axes[0].set_ylabel("share of the tracks per bin")
    axes[1].set_xlabel("p-value")
    for axis in axes:
        axis.set_ylim(0, 1.25 * axis.get_ylim()[1])
        axis.legend(loc="upper right")
    page.keep(figure, "goodness_of_fit", "Goodness of fit",
              "Left: chi2 per degree of freedom. Right: p-value, which is flat (dotted) where the fit knows its errors; the distance is that of Kolmogorov and Smirnov.")


def log_axis(axis):
    axis.set_yscale("log")
    axis.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.yaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{v:g}"))
    axis.yaxis.set_minor_formatter(NullFormatter())


def clip_to(axis, low, high):
    """Limits the axis to what matters, and says at its edge what lies outside."""
    said = 0
    for container in axis.containers:
        line = container.lines[0]
        for x, y in zip(*line.get_data()):
            if math.isfinite(y) and not low <= y <= high:
                edge, arrow = (low, "↓") if y < low else (high, "↑")
                axis.annotate(f"{arrow}{y:.2f}", (x, edge), xytext=(3, 4 + 9 * said if y < low else -10 - 9 * said), textcoords="offset points", ha="left", color=line.get_color(), fontsize=7)
                said += 1
    bottom, top = axis.get_ylim()
    axis.set_ylim(max(bottom, low), min(top, high))


def momentum_rows(block, bins, quantity):
    """Cells with enough tracks for a width: (row of the bins, what is known of the quantity there)"""
    rows = [(r, r["residual_" + quantity]) for r in block["momentum_in_bins"]["by_" + bins] if r["residual_" + quantity]["n"] > 20]
    return [r for r, _ in rows], [q for _, q in rows]


def draw_resolution(study, page):
    figure, axes = plt.subplots(2, 2, figsize=(PAGE_WIDTH, 6.0))
    ratio, ratio_axes = plt.subplots(2, 2, figsize=(PAGE_WIDTH, 5.0))
    count = len(study.trackers)
    for j, quantity in enumerate(("pt", "pz")):
        for k, bins in enumerate(("pt", "pz")):
            axis, below = axes[j][k], ratio_axes[j][k]
            shown = [(t, c, m, l, i) for i, (t, c, m, _, l) in enumerate(study.styled())]
            if study.before and "momentum_in_bins" in study.before:
                shown.insert(0, (study.before, GREY, "x", "before", (count - 1) / 2))
            for block, colour, marker, label, i in shown:
                rows, cells = momentum_rows(block, bins, quantity)
                if not rows:
                    continue
                middle, half = bins_of(rows, bins)
                at = middle + aside(i, count, half)
                spread, error, bound, stated = (numbers(c[key] for c in cells) for key in ("spread", "spread_error", "bound", "stated"))
                axis.errorbar(at, spread, yerr=error, fmt=marker, color=colour, markersize=4.5, linewidth=1.0, label=label)
                below.errorbar(at, spread / bound, xerr=half, yerr=error / bound, fmt=marker, color=colour, markersize=4.5, linewidth=1.0, label=label)
                if block is not study.before and all(a[bins][1] == b[bins][0] for a, b in zip(rows, rows[1:])):
                    edges = [r[bins][0] for r in rows] + [rows[-1][bins][1]]
                    axis.stairs(bound, edges, baseline=None, color=colour, linewidth=1.1, linestyle=["-", "--", "-.", ":"][i % 4],
                                label=f"Cramér-Rao bound{', ' + label if count > 1 else ''}")
            axis.set_ylabel(f"spread of {SYMBOL[quantity]} [MeV/$c$]")
            axis.set_xlabel(MOMENTUM[bins])
            if quantity == "pz" and bins == "pt":
                log_axis(axis)
            else:
                axis.set_ylim(0, 1.3 * axis.get_ylim()[1])
            below.axhline(1.0, color=BLACK, linewidth=1.0)
            below.axhline(1.05, color=GREY, linewidth=0.8, linestyle=":")
            clip_to(below, 0.7, 1.4)
            below.set_ylabel(f"spread of {SYMBOL[quantity]} / bound")
            below.set_xlabel(MOMENTUM[bins])
    axes[1][0].legend(loc="upper right")
    if study.before or count > 1:
        ratio_axes[0][0].legend(loc="best")
    page.keep(figure, "momentum_resolution", "Momentum resolution and the Cramér-Rao bound",
              "Spread of the residuals of pt (top) and pz (bottom) against the true momentum, and what no unbiased fit can go below: the Fisher information of the measurements "
              "and materials along each track, as the spread that errors of that size would have.")
    page.keep(ratio, "momentum_resolution_over_bound", "Momentum resolution over the bound",
              "The same as a ratio. Dotted: 1.05. Below 1 is where a fit knows more than the measurements say: the broad prior of q/pz where the field hardly bends the track; or "
              "where scattering is less than the formula that bound and fit share.")


def draw_shift(study, page):
    rule = study.document["definitions"]
    limit = rule["shift_share_of_spread"]
    figure, axes = plt.subplots(2, 2, figsize=(PAGE_WIDTH, 5.0), sharey="row")
    count = len(study.trackers)
    for j, quantity in enumerate(("pt", "pz")):
        for k, bins in enumerate(("pt", "pz")):
            axis = axes[j][k]
            axis.axhspan(-limit, limit, color="#E6E6E6", zorder=0, label=f"±{100 * limit:g} % of the spread")
            axis.axhline(0.0, color=BLACK, linewidth=0.8)
            shown = [(t, c, m, l, i) for i, (t, c, m, _, l) in enumerate(study.styled())]
            if study.before and "momentum_in_bins" in study.before:
                shown.insert(0, (study.before, GREY, "x", "before", (count - 1) / 2))
            for block, colour, marker, label, i in shown:
                rows, cells = momentum_rows(block, bins, quantity)
                if not rows:
                    continue
                middle, half = bins_of(rows, bins)
                spread, median, error = (numbers(c[key] for c in cells) for key in ("spread", "median", "median_error"))
                axis.errorbar(middle + aside(i, count, half), median / spread, xerr=half, yerr=error / spread, fmt=marker, color=colour, markersize=4.5, linewidth=1.0, label=label)
            axis.set_xlabel(MOMENTUM[bins])
        axes[j][0].set_ylabel(f"median of {SYMBOL[quantity]} / spread")
    axes[0][1].legend(loc="best", ncols=2)
    page.keep(figure, "momentum_shift", "Shift of the momentum", "Median of the residuals of pt (top) and pz (bottom) in units of their spread. Bars: standard error of the median.")

    figure, axes = plt.subplots(1, count, figsize=(min(PAGE_WIDTH, 1.2 + 4.2 * count), 4.0), squeeze=False)
    for axis, (tracker, *_, label) in zip(axes[0], study.styled()):
        grid, cells = grid_of(study, "wide_"), [dict(c["residual_pz"], pt=c["pt"], pz=c["pz"]) for c in tracker["momentum_in_bins"]["by_pt_and_pz"]]
        drawn = map_of(axis, grid, cells, "median_over_spread", lambda c: c["n"] > 20, vmin=-0.5, vmax=0.5, cmap="PuOr")
        for c in cells:
            if c["n"] <= 20:
                continue
            sigmas = abs(c["median"]) / c["median_error"]
            text_in_cell(axis, grid, c, f"{100 * c['median_over_spread']:+.0f} %\n{sigmas:.1f} σ, {c['n']}", "black" if abs(c["median_over_spread"]) < 0.3 else "white")
            if c["shifted"]:
                width = c["pz"][1] - c["pz"][0]
                axis.add_patch(Rectangle((c["pz"][0] + 0.02 * width, place(grid, c)[0] + 0.04), 0.96 * width, 0.92, fill=False, edgecolor=VERMILLION, linewidth=1.8, zorder=3))
        axis.set_title(label)
        axis.set_xlabel(MOMENTUM["pz"])
    axes[0][0].set_ylabel(MOMENTUM["pt"])
    figure.colorbar(drawn, ax=axes[0], label="median of $p_z$ / spread", extend="both")
    page.keep(figure, "momentum_shift_map", "Shift of pz in two dimensions",
              f"Median of the residuals of pz over their spread, its distance from zero in standard errors, and the number of tracks. Framed: more than {100 * limit:g} % of the spread with more "
              f"than {rule['shift_more_tracks_than']} tracks. The standard error of the median alone is 125 %/√n of the spread, 9 % with 200 tracks.")


def along_planes(study, names, series):
    """A column for each tracker, medians above spreads, named so; series of (label, colour, marker, numbers of a plane, only of the study before)."""
    figure, axes = plt.subplots(2, len(study.trackers), figsize=(PAGE_WIDTH, 4.8), squeeze=False, sharex="col", sharey="row")
    for column, (tracker, *_, title) in zip(axes.T, study.styled()):
        at = np.arange(len(tracker["planes"]))
        for axis, key, error in zip(column, ("median", "spread"), ("median_error", "spread_error")):
            for n, (label, colour, marker, numbers_of, is_before) in enumerate(series):
                planes = study.planes_before.get(tracker["tracker"], []) if is_before else tracker["planes"]
                cells = [numbers_of(p) for p in planes]
                if len(cells) != len(at) or any(c is None or not c["n"] for c in cells):
                    continue
                axis.errorbar(at + 0.12 * (n - 0.5 * (len(series) - 1)), numbers(c[key] for c in cells), yerr=numbers(c[error] for c in cells), fmt=marker, color=colour,
                              markersize=3.5, linewidth=0.9, label=label)
            for i, (p, q) in enumerate(zip(tracker["planes"], tracker["planes"][1:])):
                if p["station"] != q["station"]:
                    axis.axvline(i + 0.5, color="#AAAAAA", linewidth=0.7)
            axis.grid(False, axis="x")
        column[1].set_xticks(at, [f"{p['station']}.{p['plane']}" for p in tracker["planes"]])
        column[1].set_xlabel("station.plane, z grows to the right")
        column[0].set_title(title)
    for axis, name in zip(axes[:, 0], names):
        axis.set_ylabel(name)
    handles, labels = axes[0][0].get_legend_handles_labels()
    legend_below(figure, handles, labels)
    return figure, axes


def draw_plane_residuals(study, page):
    series = [("measured", PURPLE, "x", lambda p: p["measurement_residual_mm"], False)]
    if study.planes_before:
        series.insert(0, ("before", GREY, "o", series[0][3], True))
    figure, axes = along_planes(study, ("median of the residual [mm]", "its spread [mm]"), series)
    for axis in axes[0]:
        axis.axhline(0.0, color=BLACK, linewidth=0.9)
    page.keep(figure, "plane_residuals", "Residuals at every plane",
              "Median and spread of measured minus fitted, along what the plane measures, where the fit has gone without this measurement. Medians other than zero are planes "
              "that are not where they are believed to be.")


def draw_plane_pulls(study, page):
    shown = [("x", BLUE, "o"), ("tx", SKY, "v"), ("y", VERMILLION, "s"), ("ty", ORANGE, "^"), ("q_over_pz", GREEN, "D")]
    series = [(SYMBOL[name], colour, marker, lambda p, name=name: p["pulls"].get(name), False) for name, colour, marker in shown]
    series.append(("measurement", PURPLE, "x", lambda p: p["measurement_pull"], False))
    if study.planes_before:
        series.append(("measurement, before", GREY, "x", lambda p: p["measurement_pull"], True))
    figure, axes = along_planes(study, ("median of the pull", "spread of the pull"), series)
    for row, ideal in zip(axes, (0.0, 1.0)):
        for axis in row:
            axis.axhline(ideal, color=BLACK, linewidth=0.9)
    furthest = 2.0 if study.planes_before else 0.6
    axes[0][0].set_ylim(*np.clip(axes[0][0].get_ylim(), -furthest, furthest))
    page.keep(figure, "plane_pulls", "Pulls at every plane",
              "Median and spread of the pulls of the smoothed state against the truth, moved to the middle of each plane, and of the measurement against the fit without it. A measurement "
              "within a channel is uniform, not normal, and the spread of its pull is larger than one.")


def draw_occupancy(study, page):
    panels = [("digits_per_event", "digits per event"), ("clusters_per_event", "clusters per event"), ("space_points_per_event", "space points per event"),
              ("digit_npe", "light of a digit [photo-electrons]"), ("cluster_npe", "light of a cluster [photo-electrons]"), ("cluster_size", "digits per cluster")]
    figure, axes = plt.subplots(2, 3, figsize=(PAGE_WIDTH, 5.2))
    for axis, (key, label) in zip(axes.flat, panels):
        last, highest = 0.0, 0.0
        for tracker, colour, _, style, name in study.styled():
            d = tracker["digits"][key]
            if not d["n"]:
                continue
            steps(axis, d["histogram"], color=colour, linestyle=style, label=f"{name}: mean {d['mean']:.3g}, median {d['median']:.3g}")
            counts, edges = numbers(d["histogram"]["counts"]), edges_of(d["histogram"])
            highest = max(highest, counts.max())
            reached = np.flatnonzero(np.cumsum(counts) >= 0.999 * counts.sum())
            last = max(last, edges[reached[0] + 1] if len(reached) else edges[-1])
        axis.set_xlabel(label)
        axis.set_xlim(edges_of(study.trackers[0]["digits"][key]["histogram"])[0], last)
        if "per" in key or key == "cluster_size":
            axis.xaxis.set_major_locator(MaxNLocator(integer=True))
        if key == "cluster_size":
            axis.set_yscale("log")
            axis.set_ylim(0.5, 20 * highest)
        else:
            axis.set_ylim(0, 1.3 * highest)
        axis.legend(loc="upper right", handlelength=1.4, fontsize=7)
    for row, label in zip(axes, ("events", "digits or clusters")):
        row[0].set_ylabel(label)
    page.keep(figure, "occupancy", "Digits, clusters, space points and light",
              "Per event and tracker, over all events, those without a particle in the tracker too. A cluster belongs to one triplet at most.")

    figure, axes = plt.subplots(1, len(study.trackers), figsize=(min(PAGE_WIDTH, 1.0 + 4.5 * len(study.trackers)), 3.2), squeeze=False)
    for axis, (tracker, colour, _, _, label) in zip(axes[0], study.styled()):
        by_constant = {}
        for s in tracker["channel_sums"]:
            edges = edges_of(s["histogram"])
            by_constant[s["expected"]] = by_constant.get(s["expected"], 0) + numbers(s["histogram"]["counts"])
        for n, (constant, counts) in enumerate(sorted(by_constant.items())):
            stations = [str(s["station"]) for s in tracker["channel_sums"] if s["expected"] == constant]
            inside = counts[np.abs(0.5 * (edges[1:] + edges[:-1])) < 2.75].sum() / max(1.0, counts.sum())
            axis.stairs(counts, edges + constant, color=[colour, ORANGE, PURPLE][n % 3], linewidth=1.3, label=f"stations {', '.join(stations)}; {100 * inside:.1f} % within ±3")
            axis.axvline(constant, ymax=0.78, color=BLACK, linewidth=1.0, linestyle=":", label=f"expected {constant:g}")
        axis.set_yscale("log")
        axis.set_ylim(0.5, axis.get_ylim()[1] * 6)
        axis.set_xlabel("sum of the three channel numbers")
        axis.set_title(label)
        axis.legend(loc="upper right")
    axes[0][0].set_ylabel("triplets of clusters per half channel")
    page.keep(figure, "channel_sums", "Kuno's conjecture",
              "Sum of the channel numbers of one cluster in each of the three views of a station. For one particle the three coordinates add up to nothing, so the sum is that of the "
              "central channels. All triplets near it are counted, accidental ones too.")


def nearest_track(tracks, z, x, y):
    """The track that passes nearest to a point, its line there, and how far away."""
    best = (None, math.inf)
    for t in tracks:
        line = np.array(t["line"])
        i = int(np.argmin(np.abs(line[:, 0] - z)))
        apart = math.hypot(line[i, 1] - x, line[i, 2] - y)
        if apart < best[1]:
            best = (t, apart)
    return best


def draw_display(display, page, number_of_it):
    figure, (xy, zx, phi_z) = plt.subplots(1, 3, figsize=(PAGE_WIDTH, 3.3), width_ratios=(1.05, 1.2, 1.2))
    colours = [BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY]
    tracks, points = display["tracks"], display["space_points"]
    xy.add_patch(Circle((0, 0), display["active_radius"], fill=False, color=GREY, linewidth=0.8, linestyle=":"))
    for i, t in enumerate(tracks):
        line = np.array(t["line"])
        colour = colours[i % len(colours)]
        xy.plot(line[:, 1], line[:, 2], color=colour, linewidth=1.2)
        zx.plot(line[:, 0], line[:, 1], color=colour, linewidth=1.2, label="track")
        if "centre" in t:
            phi = np.unwrap(np.arctan2(line[:, 2] - t["centre"][1], line[:, 1] - t["centre"][0]))
            phi_z.plot(line[:, 0], phi, color=colour, linewidth=1.2)
    hits = {"marker": "s", "s": 26, "facecolors": "none", "linewidths": 1.0}
    truth = {"marker": "+", "s": 30, "color": BLACK, "linewidths": 0.9}
    for p in points:
        style = dict(hits, edgecolors=BLACK if p["clusters"] > 2 else GREY)
        xy.scatter(p["x"], p["y"], **style)
        zx.scatter(p["z"], p["x"], **style)
    crossings = [c for particle in display["particles"] for c in particle["crossings"]]
    if crossings:
        c = np.array(crossings)
        xy.scatter(c[:, 1], c[:, 2], **truth)
        zx.scatter(c[:, 0], c[:, 1], **truth)

    def on_phi(z, x, y, **style):
        t, apart = nearest_track(tracks, z, x, y)
        if t is None or "centre" not in t or apart > 15.0:
            return
        line = np.array(t["line"])
        phi = np.unwrap(np.arctan2(line[:, 2] - t["centre"][1], line[:, 1] - t["centre"][0]))
        there = float(np.interp(z, line[:, 0], phi))
        own = math.atan2(y - t["centre"][1], x - t["centre"][0])
        phi_z.scatter(z, there + math.remainder(own - there, 2 * math.pi), **style)

    for p in points:
        on_phi(p["z"], p["x"], p["y"], **dict(hits, edgecolors=BLACK if p["clusters"] > 2 else GREY))
    for z, x, y in crossings:
        on_phi(z, x, y, **truth)
    reach = display["active_radius"] * 1.08
    xy.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal", xlabel="$x$ [mm]", ylabel="$y$ [mm]")
    zx.set(xlabel="$z$ [mm]", ylabel="$x$ [mm]")
    phi_z.set(xlabel="$z$ [mm]", ylabel=r"$\phi$ about the centre of the helix [rad]")
    if not phi_z.has_data():
        phi_z.text(0.5, 0.5, "no helix", ha="center", va="center", transform=phi_z.transAxes, color=GREY)
    handles = [plt.Line2D([], [], color=BLUE, label="fitted track"), plt.Line2D([], [], marker="s", color=BLACK, markerfacecolor="none", linestyle="", label="space point of 3 clusters"),
               plt.Line2D([], [], marker="s", color=GREY, markerfacecolor="none", linestyle="", label="of 2"), plt.Line2D([], [], marker="+", color=BLACK, linestyle="", label="truth")]
    if not points:
        del handles[1:3]
    legend_below(figure, handles, [h.get_label() for h in handles])
    figure.suptitle(f"{display['title']}: event {display['event']}, tracker {display['tracker']}", fontsize=9)
    told = "; ".join(f"charge {t['charge']:+d}, pt {t['pt']:.1f}, pz {t['pz']:.1f} MeV/c, chi2/ndf {t['chi2']:.1f}/{t['ndf']}, p-value {t['p_value']:.2g}" for t in tracks[:3])
    true = "; ".join(f"charge {p['charge']:+d}, pt {p['pt']:.1f}, pz {p['pz']:.1f} MeV/c" for p in display["particles"][:3])
    more = [f" and {len(v) - 3} more" if len(v) > 3 else "" for v in (tracks, display["particles"])]
    page.keep(figure, f"event_{number_of_it}", f"Event display: {display['title']}", f"Fitted: {told or 'nothing'}{more[0]}. True: {true}{more[1]}.")


STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; color: #1a1a1a; background: #fff; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; margin-bottom: .2rem; } h2 { font-size: 1.15rem; margin: 2.2rem 0 .4rem; }
table { border-collapse: collapse; margin: .6rem 0; font-variant-numeric: tabular-nums; } caption { text-align: left; color: #555; padding-bottom: .3rem; }
th, td { padding: .18rem .7rem; border-bottom: 1px solid #ddd; text-align: right; } th:first-child, td:first-child { text-align: left; }
thead th { border-bottom: 2px solid #333; } figure { margin: .4rem 0; } img { max-width: 100%; height: auto; } figcaption, .note { color: #555; font-size: .9rem; }
"""


def cell(value):
    if value is None:
        return "–"
    if value == 0 or abs(value) >= 1e-3:
        return f"{value:.4g}"
    return f"{value:.2e}"


def table(caption, head, rows):
    out = [f"<table><caption>{html.escape(caption)}</caption><thead><tr>" + "".join(f"<th>{html.escape(h)}</th>" for h in head) + "</tr></thead><tbody>"]
    out += ["<tr>" + "".join(f"<td>{html.escape(c if isinstance(c, str) else cell(c))}</td>" for c in row) + "</tr>" for row in rows]
    return "".join(out) + "</tbody></table>"


def tables(study):
    d = study.document
    head = ["", "unit", "published", "bound"] + (["before"] if study.before else []) + ["measured"]
    yield table("Side by side. Spread: half the width of the central 68.27 % of reconstructed - true.", head,
                [[r["what"], r["unit"], r["published"], r["bound"]] + ([r["before"]] if study.before else []) + [r["measured"]] for r in d["comparison"]])
    yield ("<p class='note'>Published: simulation study of the MICE tracker reconstruction (MICE collaboration), whose widths need not be defined as here. Bound: "
           "Cramér-Rao bound where a spread has one, else the ideal value.</p>")
    blocks = d["trackers"] + ([dict(d["all"], name="all")] if len(d["trackers"]) > 1 else [])
    yield table("By tracker. Efficiency with its Wilson interval, 68.27 %.", ["", "expected", "found", "efficiency", "interval", "tracks", "ghosts", "of them duplicates", "ghosts per event"],
                [[b["name"], str(b["efficiency"]["expected"]), str(b["efficiency"]["found"]), b["efficiency"]["value"],
                  f"{number(b['efficiency']['low']):.4f} to {number(b['efficiency']['high']):.4f}", str(b["tracks"]), str(b["ghosts"]), str(b["duplicates"]), b["ghosts_per_event"]] for b in blocks])
    shifted = [(t, q, c) for t in d["trackers"] if "momentum_in_bins" in t for q in ("pt", "pz") for c in t["momentum_in_bins"]["by_pt_and_pz"] if c["residual_" + q]["shifted"]]
    tried = [c["residual_" + q] for t in d["trackers"] if "momentum_in_bins" in t for q in ("pt", "pz") for c in t["momentum_in_bins"]["by_pt_and_pz"]
             if c["residual_" + q]["n"] > d["definitions"]["shift_more_tracks_than"]]
    if tried:
        yield table(f"Bins of (pt, pz) with a shift of more than {100 * d['definitions']['shift_share_of_spread']:g} % of the spread: {len(shifted)} of {len(tried)} bins with more than "
                    f"{d['definitions']['shift_more_tracks_than']} tracks. So few tracks give {sum(c['shifted_by_chance'] for c in tried):.1f} such bins by chance, were there no shift at all.",
                    ["tracker", "of", "pt MeV/c", "pz MeV/c", "tracks", "median MeV/c", "± error", "spread MeV/c", "median/spread"],
                    [[t["name"], q, "{:g} to {:g}".format(*c["pt"]), "{:g} to {:g}".format(*c["pz"]), str(c["residual_" + q]["n"]), c["residual_" + q]["median"], c["residual_" + q]["median_error"],
                      c["residual_" + q]["spread"], c["residual_" + q]["median_over_spread"]] for t, q, c in shifted])


def write_page(study, page):
    d = study.document
    given, rule = d["input"], d["definitions"]
    files = ", ".join(f"{key.replace('_', ' ')} {value}" for key, value in given.items() if isinstance(value, str))
    body = [f"<h1>How well the tracks are reconstructed</h1><p class='note'>{html.escape(files)}; field {given['field_tesla']:g} T; {d['events']} events; scifi-study {html.escape(d['program'])}</p>",
            f"<p class='note'>A track is expected of a particle that crosses all planes of {rule['min_stations']} stations, the first among them, within the fiducial radius, with pt/|pz| below "
            f"{rule['max_pt_over_pz']:g} at the reference surface. Its track is the nearest within {rule['match_mm']:g} mm and {rule['match_MeV']:g} MeV/c; any other is a ghost, a duplicate where the "
            "particle has a nearer one. Residuals, pulls and chi2 are those of particles that cross every station.</p>"]
    body += tables(study)
    for name, title, caption in page.figures:
        data = base64.b64encode((page.folder / f"{name}.png").read_bytes()).decode("ascii")
        body.append(f"<h2>{html.escape(title)}</h2><figure><img alt='{html.escape(title)}' src='data:image/png;base64,{data}'><figcaption>{html.escape(caption)}</figcaption></figure>")
    text = ("<!DOCTYPE html><html lang='en'><head><meta charset='utf-8'><meta name='viewport' content='width=device-width'><title>Track reconstruction study</title>"
            f"<style>{STYLE}</style></head><body>" + "\n".join(body) + "</body></html>\n")
    (page.folder / "study.html").write_text(text, encoding="utf-8")


def main():
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    study = Study(json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8")))
    page = Page(pathlib.Path(sys.argv[2]))
    draw_efficiency(study, page)
    if study.document["all"]["residuals"]:
        draw_residuals(study, page)
        draw_pulls(study, page)
        draw_goodness(study, page)
    if "momentum_in_bins" in study.document["all"]:
        draw_resolution(study, page)
        draw_shift(study, page)
    if "planes" in study.trackers[0]:
        draw_plane_residuals(study, page)
        draw_plane_pulls(study, page)
    if "digits" in study.trackers[0]:
        draw_occupancy(study, page)
    for i, display in enumerate(study.document["displays"], 1):
        draw_display(display, page, i)
    write_page(study, page)
    return 0


if __name__ == "__main__":
    sys.exit(main())
