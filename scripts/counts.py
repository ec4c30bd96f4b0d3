#!/usr/bin/env python3
"""Counts and memory that the papers print, beside hwsim's, as a Markdown page.

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
# Triangles of round parts as the paper's have: TOP counts every one of a surface, the other techniques few.
SCENES = {"SPONZA": "sponza_hall:detail=5", "GRASS": "grass", "POWERPLANT": "powerplant:sides=6", "DRAGON": "dragon"}
TECHNIQUES = {
    "Lauritzen2010-deferred-MSAA": "deferred_simple_complex:layout=gb_sbaa40,samples={msaa}",
    "SBAA-TOP": "sbaa_top:n={n},msaa={msaa}",
    "SBAA-MERGE": "sbaa_merge:n={n},msaa={msaa}",
}


def run(hwsim, jobs, scene, technique, more=(), gpu="hd5870"):
    with tempfile.TemporaryDirectory() as folder:
        command = [hwsim, "run", scene, "-t", technique, "-g", gpu, "--resolution", "1280x720", "--json",
                   "--no-image", "--quiet", "--jobs", str(jobs), "--out", os.path.join(folder, "run"), *more]
        done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{done.stderr}")
    return json.loads(done.stdout)


def count(result, name):
    return sum(p["counters"]["technique." + name] for p in result["passes"])


def lit_samples(result):
    return count(result, "lit_samples")


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


# "Configured to ensure no quality degradation" (AGAA, section 5): pixels of more than one surface are complex.
NO_LOSS = "deferred_simple_complex:samples=8,normal_dot_min=0.999999,compare_all=on"
PIXELS = 1280 * 720


def event_table(args):
    print("| scene | simple/complex | complex pixels % | AGAA c=2 | SBAA TOP S=6 | SBAA MERGE S=6 "
          "| AGAA / simple/complex % | AGAA / TOP % | AGAA / MERGE % | AGAA in complex pixels | of 8 % | / TOP % |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|")
    print("| published (Old City) | | | | | | < 25 | 45 | 45 | <= 2 | <= 25 | |")
    for scene in args.events.split():
        lit = [lit_samples(run(args.hwsim, args.jobs, scene, t, gpu="gtx980")) / PIXELS
               for t in (NO_LOSS, "agaa:c=2,msaa=8", "sbaa_top:n=6,msaa=8", "sbaa_merge:n=6,msaa=8")]
        reference, agaa, top, merge = lit
        complex_share = (reference - 1) / 7
        within = [1 + (events - 1) / complex_share for events in (agaa, top)]
        print(f"| {scene} | {reference:.3f} | {100 * complex_share:.1f} | {agaa:.3f} | {top:.3f} | {merge:.3f} "
              f"| {100 * agaa / reference:.0f} | {100 * agaa / top:.0f} | {100 * agaa / merge:.0f} "
              f"| {within[0]:.2f} | {100 * within[0] / 8:.0f} | {100 * within[0] / within[1]:.0f} |", flush=True)


def primitive_table(args):
    print("| count | published | hwsim | error % |\n|---|---|---|---|")
    dragon = run(args.hwsim, args.jobs, "dragon", "sbaa_top:n=2,msaa=8", ["--no-shadows"])
    drawn = sum(p["counters"]["stats.input_assembly_primitives"] for p in dragon["passes"] if p["name"] == "visibility")
    mean = drawn / count(dragon, "slots_emitted_first_surfaces")
    print(f"| DRAGON: primitives drawn for a covered pixel (SBAA, Fig. 2) | 6 | {mean:.2f} | {100 * (mean / 6 - 1):+.1f} |")
    for camera in ("close_up", "distant"):
        done = [count(run(args.hwsim, args.jobs, "car_body", "sss_gs:early_exit=" + on, ["--camera", camera], "gtx470"),
                      "sss_processed_primitives") for on in ("off", "on")]
        print(f"| car_body, {camera}: triangles sampled without and with the early exit (SSS 4.1) | not printed "
              f"| {done[0]:,} and {done[1]:,} ({100 * (done[1] / done[0] - 1):+.0f} %) | |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--hwsim", default=os.path.join(ROOT, "build", "release", "bin", "hwsim"))
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--events", default="old_city old_city:leaf_cards=1 bamboo metal")
    args = parser.parse_args()
    print("# Counts beside published ones\n\nPrinted by `scripts/counts.py`. 1280x720, default cameras. "
          "The scenes are stand-ins for those of the paper.\n")
    print("## Shaded samples (SBAA, Table 3)\n")
    print("REFER: pixels, and the further samples of complex ones (Lauritzen 2010). TOP and MERGE: surfaces that were\n"
          "lit; a pixel without any counts once, as for REFER. Their published counts follow from the printed\n"
          "percentages. `sponza_hall:detail=5` and `powerplant:sides=6` have about the paper's facets of round and flat\n"
          "parts. With the generators' finer defaults TOP counts 14 to 21 % more, REFER and MERGE within 3 % the same: TOP\n"
          "alone tells facets of one surface apart, and DRAGON and GRASS meet its counts.\n")
    shaded_table(args)
    print("\n## Memory (SBAA, Table 2)\n\nImages and buffers, none in another one's memory. Alive at once is less: `frame.memory_mib` of a run.\n")
    memory_table(args)
    print("""
## Shading events (AGAA, section 5.2)

Lit samples, surfaces and aggregates of a pixel, pixels of sky counted once everywhere; 8x, simple and complex pixels set
up without loss. The paper prints two shares for Old City, whole frame and "on average". **Over the whole frame hwsim misses
both shares.** They may be meant within complex pixels: by Table 1 the reference's shading takes 3.04 times as long at 32x as
at 8x; were time proportional to events, a fifth of the pixels would be complex, and a quarter of so few events less than
one a pixel. That reading is ours, and not tested; two aggregates of eight samples agree with it. The columns on the right count that: what exceeds one event a pixel, over the
complex pixels. It is an upper bound, for AGAA also splits some pixels that are simple (two triangles of one plane farther
apart than its threshold; leaves that alpha to coverage covers in part, where the other techniques test alpha).
""")
    event_table(args)
    print("""
## Primitives and triangles
""")
    primitive_table(args)
    print("\nFur Ball: up to 32 triangles a pixel (AGAA, Fig. 2); the generator's reach 29 "
          "(`pipeline_tests --gtest_filter='SceneCounts*'`).")


if __name__ == "__main__":
    main()
