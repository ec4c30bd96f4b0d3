#!/usr/bin/env python3
"""What matters on which GPU: the exact gradient of a frame's time, as CSV for a plot.

    examples/sensitivities.py [SCENE] [TECHNIQUE] > sensitivities.csv
"""

import csv
import sys

import hwsim

GPUS = ["gtx470", "gtx980", "rtx3060", "rx7900xtx"]


def main(scene: str = "sponza_hall", technique: str = "msaa8x") -> None:
    frame = hwsim.emulate(scene, technique, "gtx980", resolution=(640, 360), images=False)
    out = csv.writer(sys.stdout)
    out.writerow(["gpu", "time_ms", "key", "value", "elasticity"])
    for name in GPUS:
        gpu = hwsim.gpu(name)
        time_ms = frame.time(gpu).time_ms
        for key, elasticity in frame.gradient(gpu).strongest(12):
            out.writerow([name, f"{time_ms:.6g}", key, gpu[key], f"{elasticity:.4f}"])


if __name__ == "__main__":
    main(*sys.argv[1:])
