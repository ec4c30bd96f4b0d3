"""The installed Python package finds its files and its image module, told nothing but where Python looks."""

import os
import sys
import tempfile

import hwsim

prefix = sys.argv[1]
assert os.path.realpath(hwsim.__file__).startswith(os.path.realpath(prefix)), hwsim.__file__
lab = hwsim.Lab(cache="", jobs=2)
gpu = lab.gpu("gtx980", calibrated=False)
file = gpu.origin("shader_cores").file
assert os.path.realpath(file).startswith(os.path.realpath(prefix)), file
frame = lab.emulate("grass:blades=100", "msaa4x", gpu, resolution=(32, 32))
with tempfile.TemporaryDirectory() as folder:
    frame.save(os.path.join(folder, "frame.png"))
checks = lab.doctor()
print(checks)
assert all(check["ok"] for check in checks)
