#!/usr/bin/env python3
"""Counts and memory that the papers print, beside hwsim's, as a Markdown page.

scripts/counts.py [--hwsim build/release/bin/hwsim] [--jobs N] > docs/counts.md
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


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


def label(row):
    name = {"SBAA-TOP": "TOP", "SBAA-MERGE": "MERGE"}.get(row["technique"], "REFER")
    return name + row["surfaces_or_aggregates"]


def reproduced(args, paper):
    """The paper's rows as hwsim maps them to runs (configs/published/mapping), published beside predicted."""
    command = [args.hwsim, "reproduce", paper, "--json", "--quiet", "--jobs", str(args.jobs)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{done.stderr}")
    return json.loads(done.stdout)


def summary(magnitudes):
    mean, median = statistics.mean(magnitudes), statistics.median(magnitudes)
    return f"{len(magnitudes)} counts: mean error {mean:.1f} %, median {median:.1f} %, largest {max(magnitudes):.1f} %."


def shaded_table(args, rows):
    print("| scene | MSAA | technique | published | hwsim | error % | published change % | hwsim change % | detected surfaces |")
    print("|---|---|---|---|---|---|---|---|---|")
    errors, reference = [], {}
    counted = [row for row in rows if row["table"] == "sbaa_table3_shaded_samples"]
    for row in counted:
        key, ours, published = (row["scene"], row["msaa"]), row["predicted"], row["published_absolute"]
        if ours is None:
            sys.exit(f"no count of {row['scene']} {label(row)}: {row['excluded_because']}")
        changes = "| | | |"
        if row["quantity"] == "shaded_samples":
            reference[key] = ours
        else:
            changes = (f"| {float(row['value']):+.2f} | {100 * (ours / reference[key] - 1):+.2f} "
                       f"| {detected(args, row):,} |")
        errors.append(100 * (ours / published - 1))
        print(f"| {row['scene']} | {row['msaa']}x | {label(row)} | {published:,.0f} | {ours:,.0f} | {errors[-1]:+.1f} {changes}")
    magnitudes = [abs(e) for e in errors]
    fair = [m for m, row in zip(magnitudes, counted) if row["use"] != "excluded"]
    print(f"\n{summary(magnitudes)} Without GRASS at 4x, whose printed counts contradict those at 8x\n"
          f"([why](published_tables.md#contradiction-16)): {summary(fair)}")


STAND_INS = {"SPONZA": "sponza_hall:detail=5", "GRASS": "grass", "POWERPLANT": "powerplant:sides=6", "DRAGON": "dragon"}


def detected(args, row):
    """Surfaces without the pixels that have none (the paper's Eq. 2 divides by detected ones)."""
    kind = "sbaa_top" if row["technique"] == "SBAA-TOP" else "sbaa_merge"
    technique = f"{kind}:n={row['surfaces_or_aggregates']},msaa={row['msaa']}"
    more = ["--no-shadows", "--set", "scene.lights=simple", "--set", "scene.light_range=1", "--set", "scene.metal_ambient=false"]
    return count(run(args.hwsim, args.jobs, STAND_INS[row["scene"]], technique, more), "slots_emitted_surfaces")


def memory_table(rows):
    print("| MSAA | technique | published MiB | hwsim MiB |\n|---|---|---|---|")
    for row in rows:
        if row["quantity"] == "memory_mbytes":
            print(f"| {row['msaa']}x | {label(row)} | {row['value']} | {row['predicted']:.1f} |")


READINGS = (("frame", "pixels, whole frame"), ("complex", "complex pixels"), ("waves", "waves, whole frame"),
            ("complex_waves", "waves with a complex pixel"))


def events(args, scene):
    done = subprocess.run([args.event_study, f"--jobs={args.jobs}", scene], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    return json.loads(done.stdout)


def event_table(args):
    print("| scene | mean over | of all % | simple/complex | AGAA c=2 | SBAA TOP S=6 | SBAA MERGE S=6 "
          "| AGAA / simple/complex % | AGAA / TOP % | AGAA / MERGE % |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    print("| published (Old City) | \"on average\" | | | | | | < 25 | 45 | 45 |")
    for scene in args.events.split():
        result = events(args, scene)
        shares = {"complex": result["complex_share"], "complex_waves": result["complex_wave_share"]}
        for key, name in READINGS:
            reference, agaa, top, merge = (result[t][key] for t in ("reference", "agaa", "top", "merge"))
            print(f"| {scene} | {name} | {100 * shares.get(key, 1.0):.1f} | {reference:.2f} | {agaa:.2f} | {top:.2f} | {merge:.2f} "
                  f"| {100 * agaa / reference:.1f} | {100 * agaa / top:.0f} | {100 * agaa / merge:.0f} |", flush=True)


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
    parser.add_argument("--events", default="old_city old_city:sides=24,bars_per_m=20,slats=28 bamboo metal")
    parser.add_argument("--event-study", help="default: beside hwsim")
    args = parser.parse_args()
    if not args.event_study:
        args.event_study = os.path.join(os.path.dirname(os.path.abspath(args.hwsim)), "event_study")
    print("# Counts beside published ones\n\nThis page puts the counts that papers print beside hwsim's: shaded samples, memory, shading "
          "events, primitives.\n`scripts/counts.py` prints it, at 1280x720 with the default cameras; SBAA's tables in it are those of "
          "`hwsim reproduce sbaa`. The scenes\nare stand-ins for those of the papers. No fit changes a count, but people chose scenes and "
          "layouts by some of the printed ones:\n[which](calibration.md#chosen-by-counts).\n")
    print("## Shaded samples (SBAA, Table 3)\n")
    print("REFER: pixels, and the further samples of complex ones (Lauritzen 2010, with that G-buffer). TOP and MERGE: surfaces that were\n"
          "lit; a pixel without any counts once, as for REFER (the last column leaves these out: the surfaces that Eq. 2\n"
          "divides by; DRAGON's published counts hold the empty pixels). Their published counts follow from the printed\n"
          "percentages. `sponza_hall:detail=5` and `powerplant:sides=6` have about the paper's facets of round and flat\n"
          "parts. With the generators' finer defaults TOP counts 14 to 21 % more, MERGE within 3 % the same: TOP\n"
          "alone tells facets of one surface apart, and DRAGON and GRASS meet its counts.\n")
    rows = reproduced(args, "sbaa")
    shaded_table(args, rows)
    print("\n## Memory (SBAA, Table 2)\n\nImages and buffers, none in another one's memory. Alive at once is less: `frame.memory_mib` of a run.\n")
    memory_table(rows)
    print("""
## Shading events (AGAA, section 5.2)

Lit samples, surfaces and aggregates of each pixel, pixels of sky counted once everywhere; 8x, simple and complex pixels set
up without loss (`z_scale=0,normal_dot_min=1`; `event_study`, whose sums are the counter `lit_samples`). The paper prints two shares
for Old City, "on average", and explains them: "the large pixel-to-pixel discrepancy in the shading rate (1-6 shading executions)
... entails a worst case execution at the SIMD granularity". So there are four readings: pixels or waves (the worst of 8x4 pixels), each
over the whole frame or where the reference calls pixels complex.

- **Under 25 % of simple/complex holds on old_city and bamboo over the whole frame**: 18.5 and 19.6 % of pixels' events, 22.5 and 23.4 %
  as waves execute them. The reference tells samples of one slanted plane apart, as "no quality degradation" asks, so 89 and 92 % of their
  pixels are complex. On metal 15 % are: there it holds in complex pixels and in waves that hold one, and over the whole frame it does not.
- **45 % of SBAA is met on metal alone**, in waves with a complex pixel: 44 % of TOP's events and 47 % of MERGE's. On bamboo these are
  48 and 53 %. On old_city, which the paper's share is of, they are 59 and 69 %, and 84 and 95 % over pixels. What is missing are surfaces
  in a pixel: of its 6, TOP uses 1.66 in old_city's complex pixels.
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
