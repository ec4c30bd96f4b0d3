#!/usr/bin/env python3
"""What if the GPU had more ROPs? Times of several techniques over their number, from one emulation each.

    examples/what_if_rops.py [SCENE] [GPU]
"""

import sys

import hwsim

TECHNIQUES = ["none", "msaa4x", "msaa8x"]
FACTORS = [0.5, 1, 2, 4]


def main(scene: str = "sponza_hall", gpu_name: str = "gtx980") -> None:
    gpu = hwsim.gpu(gpu_name)
    print(f"{gpu.title}: {gpu['crop_units']} color ROPs ({gpu.origin('crop_units')})\n")
    for technique in TECHNIQUES:
        frame = hwsim.emulate(scene, technique, gpu, resolution=(640, 360), images=False)
        base = frame.time(gpu)
        print(f"{technique}: {base.time_ms:.3f} ms, limited by {base.limiter}")
        for factor in FACTORS:
            timing = frame.time(gpu.scaled(crop_units=factor))
            ratio = hwsim.ratio(timing, base)
            print(f"  {factor:>4} x the ROPs: {timing.time_ms:.3f} ms, {ratio} of the time, limited by {timing.limiter}")


if __name__ == "__main__":
    main(*sys.argv[1:])
