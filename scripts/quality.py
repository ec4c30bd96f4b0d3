#!/usr/bin/env python3
"""Turns what benchmarks/quality_study printed into one table a figure, scenes beside techniques.

scripts/quality.py FIGURE FILE...    (FIGURE: PSNR dB, RMSE, SSIM, FLIP, RMSE of highlights, of `none`)
"""
import re
import sys


def tables(paths):
    scene, header = None, None
    for path in paths:
        for line in open(path, encoding="utf-8"):
            cells = [c.strip() for c in line.strip().strip("|").split("|")]
            if line.startswith("### "):
                scene, header = re.sub(r",.*", "", line[4:].strip()), None
            elif line.startswith("| technique"):
                header = cells
            elif line.startswith("| `") and header:
                yield scene, dict(zip(header, cells))


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    figure, found, techniques = sys.argv[1], {}, []
    for scene, row in tables(sys.argv[2:]):
        if figure not in row:
            continue
        found.setdefault(scene, {})[row["technique"]] = row[figure]
        if row["technique"] not in techniques:
            techniques.append(row["technique"])
    if not found:
        sys.exit(f"no column `{figure}` in {', '.join(sys.argv[2:])}")
    print("| technique | " + " | ".join(found) + " |")
    print("|---" * (len(found) + 1) + "|")
    for technique in techniques:
        print(f"| {technique} | " + " | ".join(found[s].get(technique, "") for s in found) + " |")


main()
