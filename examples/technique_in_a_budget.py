#!/usr/bin/env python3
"""The best anti-aliasing for a scene of your own, within a budget of time and memory.

    examples/technique_in_a_budget.py scene.gltf [GPU] [BUDGET]

Ends with 1 when no technique is within the budget.
"""

import sys

import hwsim

TECHNIQUES = ["none+fxaa", "none+smaa", "msaa2x", "msaa4x", "msaa8x", "ssaa4x"]


def main(scene: str, gpu: str = "gtx980", budget: str = "aa_ms<=1.5, extra_mib<=64") -> int:
    view = hwsim.View(scene, resolution=(640, 360))
    for note in hwsim.scene(view).notes:
        print(note)
    ranking = hwsim.rank(view, TECHNIQUES, gpu, budget=budget, reference_samples=16)
    for row in ranking:
        print(f"{row['technique']:10} {row['verdict']:12} {row['frame_ms']:.3f} ms  FLIP {row['flip_mean']:.4f}")
    best = ranking.best
    if best is None:
        print(f"no technique is within {budget}")
        return 1
    frame = hwsim.emulate(view, best, gpu)
    frame.save("best.png")
    print(f"{best} is the best: see best.png")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(*sys.argv[1:]))
    except hwsim.InputError as error:
        sys.exit(str(error))
