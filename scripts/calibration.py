#!/usr/bin/env python3
"""Writes the tables of docs/calibration.md from what the program found.

    hwsim validate --format json=validate.json
    hwsim validate --external --format md=external.md
    scripts/calibration.py validate.json external.md

Replaced are the tables of errors, of ratios, of other renderers and of the fitted parameters (from
configs/calibrated/calibration.json). Text around them is kept: read it again.
"""
import json
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "calibration.md"


def number(value):
    return f"{value:.3g}"


def error_row(name, s, simple=False):
    inside = "-" if simple else f"{s['coverage90_pct']:.0f}"
    width = "n/a" if simple else f"{s['width_ratio']:.2f}"
    worst = f"{s['worst']['ape_pct']:.0f} % {s['worst']['cell']}"
    return (f"| {name} | {s['cells']} | {s['mape_pct']:.1f} | {s['median_ape_pct']:.1f} | {s['kendall']:.2f} | {inside} | "
            f"{width} | {worst} |")


def error_rows(v):
    rows = []
    for split, figures in v["splits"].items():
        rows.append(error_row(split, figures))
        rows += [error_row(rule, by_split[split], True) for rule, by_split in v["baselines"].items()]
    rows += [error_row(name, figures) for part in ("papers", "gpus") for name, figures in v[part].items()]
    return rows


def ratio_rows(v):
    return [f"| {split} | {r['pairs']} | {r['median_ape_pct']:.1f} | {r['coverage90_pct']:.0f} | {r['width_ratio']:.1f} |"
            for split, s in v["splits"].items() for r in [s["ratios"]]]


def state(p):
    if not p["used"]:
        return "not used"
    if not p["credible"]:
        return "not credible"
    if p["at_bound"]:
        return "at bound, as documented"
    return "" if p["identified"] else "not identified"


def parameter_rows(calibration):
    return [f"| `{p['member']}.{p['name']}` | {p['unit']} | {number(p['start'])} | {number(p['range'][0])} to "
            f"{number(p['range'][1])} | {number(p['value'])} | {number(p['interval90'][0])} to {number(p['interval90'][1])} | "
            f"{state(p)} |" for p in calibration["parameters"]]


def with_rows(page, header, rows):
    """The page with the rows of the table under a header line that begins so."""
    found = re.search(re.escape(header) + r"[^\n]*\n\|[-:| ]+\|\n((?:\|[^\n]*\n)*)", page)
    if found is None:
        sys.exit(f"{PAGE}: no table begins with `{header}`")
    return page[:found.start(1)] + "".join(row + "\n" for row in rows) + page[found.end(1):]


def external_tables(path):
    """The tables of errors and of ratios that `hwsim validate --external --format md` begins with, as Markdown."""
    blocks = pathlib.Path(path).read_text(encoding="utf-8").split("\n\n")
    errors = [line for line in blocks[0].splitlines()[2:] if line]
    ratios = [line for line in blocks[1].splitlines()[2:] if line]
    return errors, ratios


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    validated = json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"))
    calibration = json.loads((ROOT / "configs/calibrated/calibration.json").read_text(encoding="utf-8"))
    errors, ratios = external_tables(sys.argv[2])
    page = PAGE.read_text(encoding="utf-8")
    page = with_rows(page, "| split | cells |", error_rows(validated))
    page = with_rows(page, "| split | pairs |", ratio_rows(validated))
    page = with_rows(page, "| external | rows |", errors)
    page = with_rows(page, "| ratio | pairs |", ratios)
    page = with_rows(page, "| parameter | unit |", parameter_rows(calibration))
    PAGE.write_text(page, encoding="utf-8")
    print("quantiles of the intervals:", ", ".join(f"{k} {q:.2f}" for k, q in calibration["quantile90"].items()))


main()
