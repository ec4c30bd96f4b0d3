#!/usr/bin/env python3
"""Draws the plots of the documents, with matplotlib (scripts/setup.sh --plots).

    scripts/plots.py engines build/study/engines.csv docs/engines.svg
    scripts/plots.py ratios page.html docs/images/ratios.png     # of any page that `hwsim report` wrote
"""
import argparse
import csv
import json
import re
import sys
from collections import defaultdict
from statistics import median

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

# Okabe and Ito's colors, which color-blind readers tell apart.
COLORS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"]
MARKERS = "osD^vP"


def draw_engines(source, target):
    """Error of each engine against its speed: a dot a frame and GPU, a ring the medians."""
    engines = defaultdict(list)
    with open(source, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            engines[row["engine"]].append((float(row["times_as_fast"]), abs(float(row["time_error_pct"]))))
    figure, axes = plt.subplots(figsize=(8, 4.5))
    for (engine, dots), color in zip(sorted(engines.items()), COLORS):
        xs, ys = zip(*dots)
        axes.scatter(xs, ys, s=6, alpha=0.3, color=color, linewidths=0, rasterized=True)
        axes.scatter([median(xs)], [median(ys)], s=90, facecolors="none", edgecolors=color, linewidths=2, label=engine)
    axes.set_xscale("log")
    axes.set_xlabel("times as fast as the whole event-driven simulation")
    axes.set_ylabel("error of the time, %")
    axes.legend(title="median", frameon=False)
    figure.savefig(target, bbox_inches="tight")


def page_data(page):
    with open(page, encoding="utf-8") as file:
        found = re.search(r'<script type="application/json" id="report-data">([^<]*)</script>', file.read())
    if not found:
        sys.exit(f"plots: {page} holds no data of a report; `hwsim report` with the page's script writes some")
    return json.loads(found[1])


def draw_ratios(source, target):
    """Published ratios of two techniques' times beside those of fits that had not seen the scene."""
    ratios = page_data(source)["published_ratios"]
    if not ratios:
        sys.exit(f"plots: {source} holds no published ratio: its configuration has no fit")
    papers = sorted({r["paper"] for r in ratios})
    figure, axes = plt.subplots(figsize=(6, 5.4), dpi=120)
    ends = [v for r in ratios for v in (r["published"], r["held_out"])]
    low, high = min(ends) / 1.3, max(ends) * 1.3
    for part in (0.2, 0.1):
        axes.fill_between([low, high], [low * (1 - part), high * (1 - part)], [low * (1 + part), high * (1 + part)],
                          color="#888888", alpha=0.15, linewidth=0)
    axes.plot([low, high], [low, high], color="#444444", linewidth=1)
    for paper, color, marker in zip(papers, COLORS, MARKERS):
        own = [r for r in ratios if r["paper"] == paper]
        axes.scatter([r["published"] for r in own], [r["held_out"] for r in own], s=22, marker=marker,
                     facecolors="none", edgecolors=color, label=f"{paper} ({len(own)})")
    axes.set(xscale="log", yscale="log", xlim=(low, high), ylim=(low, high), aspect="equal",
             xlabel="published ratio of two techniques' times", ylabel="predicted, the scene held out of the fit")
    axes.legend(frameon=False, loc="upper left")
    figure.savefig(target, bbox_inches="tight")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("plot", choices=["engines", "ratios"])
    parser.add_argument("source")
    parser.add_argument("target")
    args = parser.parse_args()
    {"engines": draw_engines, "ratios": draw_ratios}[args.plot](args.source, args.target)


if __name__ == "__main__":
    main()
