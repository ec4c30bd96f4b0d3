#!/usr/bin/env python3
"""Shaded samples of SBAA's Table 3 and memory of its Table 2, published beside hwsim's, as a Markdown page.

scripts/counts.py [--hwsim build/release/bin/hwsim] [--jobs N] > docs/counts.md
"""
import argparse
import csv
import json
import os
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
# The paper's scenes, and the generated ones that stand in for them.
SCENES = {"SPONZA": "sponza_hall", "GRASS": "grass", "POWERPLANT": "powerplant", "DRAGON": "dragon"}
TECHNIQUES = {
    "Lauritzen2010-deferred-MSAA": "deferred_simple_complex:layout=gb_sbaa40,samples={msaa}",
    "SBAA-TOP": "sbaa_top:n={n},msaa={msaa}",
    "SBAA-MERGE": "sbaa_merge:n={n},msaa={msaa}",
}


def run(hwsim, jobs, scene, technique, more=()):
    with tempfile.TemporaryDirectory() as folder:
        command = [hwsim, "run", scene, "-t", technique, "-g", "hd5870", "--resolution", "1280x720", "--json",
                   "--no-image", "--quiet", "--jobs", str(jobs), "--out", os.path.join(folder, "run"), *more]
        done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{done.stderr}")
    return json.loads(done.stdout)


def lit_samples(result):
    return sum(p["counters"]["technique.lit_samples"] for p in result["passes"])


def technique_of(row):
    return TECHNIQUES[row["technique"]].format(msaa=row["msaa"], n=row["surfaces_or_aggregates"])


def label(row):
    name = {"SBAA-TOP": "TOP", "SBAA-MERGE": "MERGE"}.get(row["technique"], "REFER")
    return name + row["surfaces_or_aggregates"]


def rows(name):
    with open(os.path.join(ROOT, "configs", "published", name), newline="") as file:
        return list(csv.DictReader(file))


def shaded_table(args):
    print("| scene | MSAA | technique | published | hwsim | error % | published change % | hwsim change % |")
    print("|---|---|---|---|---|---|---|---|")
    errors, reference = [], {}
    for row in rows("sbaa_table3_shaded_samples.csv"):
        scene, key = SCENES[row["scene"]], (row["scene"], row["msaa"])
        ours = lit_samples(run(args.hwsim, args.jobs, scene, technique_of(row)))
        changes = "| | |"
        if row["quantity"] == "shaded_samples":
            published = float(row["value"])
            reference[key] = (published, ours)
        else:
            published = reference[key][0] * (1 + float(row["value"]) / 100)
            changes = f"| {float(row['value']):+.2f} | {100 * (ours / reference[key][1] - 1):+.2f} |"
        errors.append(100 * (ours / published - 1))
        print(f"| {row['scene']} | {row['msaa']}x | {label(row)} | {published:,.0f} | {ours:,} | {errors[-1]:+.1f} {changes}",
              flush=True)
    magnitudes = sorted(abs(e) for e in errors)
    mean = sum(magnitudes) / len(magnitudes)
    print(f"\n{len(errors)} counts: mean error {mean:.1f} %, median {magnitudes[len(magnitudes) // 2]:.1f} %, "
          f"largest {magnitudes[-1]:.1f} %.")


def memory_table(args):
    print("| MSAA | technique | published MiB | hwsim MiB |\n|---|---|---|---|")
    for row in rows("sbaa_table2_frame_time_memory.csv"):
        if row["quantity"] != "memory_mbytes":
            continue
        result = run(args.hwsim, args.jobs, "wires", technique_of(row), ["--no-shadows"])
        print(f"| {row['msaa']}x | {label(row)} | {row['value']} | {result['frame']['allocated_mib']:.1f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--hwsim", default=os.path.join(ROOT, "build", "release", "bin", "hwsim"))
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    args = parser.parse_args()
    print("# Counts beside published ones\n\nPrinted by `scripts/counts.py`. 1280x720, default cameras. "
          "The scenes are stand-ins for those of the paper.\n")
    print("## Shaded samples (SBAA, Table 3)\n")
    print("REFER: pixels, and the further samples of complex ones (Lauritzen 2010). TOP and MERGE: surfaces that were\n"
          "lit; a pixel without any counts once, as for REFER. Their published counts follow from the printed\n"
          "percentages.\n")
    shaded_table(args)
    print("\n## Memory (SBAA, Table 2)\n\nImages and buffers, none in another one's memory. Alive at once is less: `frame.memory_mib` of a run.\n")
    memory_table(args)


if __name__ == "__main__":
    main()
