#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""Draws the table of examples/06_tracker_design: the best possible resolution against field, station spacing and channel width.

usage: plot_tracker_design.py TABLE.csv PICTURE.png
"""

import argparse
import collections
import csv

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend is chosen first)

SCANS = {"field_tesla": ("magnetic field / T", 3.0), "station_stretch": ("station spacing / that of MICE", 1.0),
         "channel_width_mm": ("channel width / mm", 1.4945)}
RESOLUTIONS = {"sigma_x_mm": "$\\sigma(x)$ / mm", "sigma_pt_MeV": "$\\sigma(p_T)$ / (MeV/$c$)", "sigma_pz_MeV": "$\\sigma(p_z)$ / (MeV/$c$)"}
STYLES = [("#0072B2", "o", "-"), ("#D55E00", "s", "--"), ("#009E73", "^", ":")]  # Okabe and Ito 2008


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table")
    parser.add_argument("picture")
    arguments = parser.parse_args()
    points = collections.defaultdict(list)
    with open(arguments.table, newline="", encoding="utf-8") as stream:
        for row in csv.DictReader(stream):
            points[row["scan"], float(row["pt_MeV"])].append(row)
    momenta = sorted({pt for _, pt in points})
    figure, grid = plt.subplots(len(RESOLUTIONS), len(SCANS), figsize=(10.5, 8.0), sharex="col", sharey="row", layout="constrained")
    for column, (scan, (label, usual)) in enumerate(SCANS.items()):
        for row, (name, title) in enumerate(RESOLUTIONS.items()):
            axes = grid[row][column]
            for pt, (colour, marker, line) in zip(momenta, STYLES):
                rows = points[scan, pt]
                axes.plot([float(r["value"]) for r in rows], [float(r[name]) for r in rows], line, color=colour, marker=marker,
                          markersize=4, label=f"$p_T$ = {pt:g} MeV/$c$")
            axes.axvline(usual, color="#999999", linewidth=0.8, zorder=0)
            axes.set_yscale("log" if name == "sigma_pz_MeV" else "linear")
            axes.grid(True, which="both", linewidth=0.3)
            if column == 0:
                axes.set_ylabel(title)
        grid[-1][column].set_xlabel(label)
    for row, name in enumerate(RESOLUTIONS):  # the axis is shared: its range is known when all columns are drawn
        if name != "sigma_pz_MeV":
            grid[row][0].set_ylim(bottom=0.0)
    grid[0][1].legend(fontsize="small", loc="lower right")
    figure.suptitle("Cramer-Rao bound at the reference surface, muons of $p_z$ = 200 MeV/$c$ in the MICE tracker (grey line: as built)", fontsize="medium")
    figure.savefig(arguments.picture, dpi=130)


main()
