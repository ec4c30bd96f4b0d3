"""The package as a whole: its functions, its stub, what it imports."""

import inspect
import os
import subprocess
import sys
from pathlib import Path

import pytest

import hwsim

SOURCE = Path(__file__).resolve().parents[2]
CONFIG = str(SOURCE / "tests" / "python" / "mypy.ini")
ALLOWED = str(SOURCE / "tests" / "python" / "stubtest_allowed.txt")


def python(code):
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip()


def test_the_functions_take_what_the_methods_take():
    names = [n for n in hwsim.__all__ if inspect.isfunction(getattr(hwsim, n)) and hasattr(hwsim.Lab, n)]
    assert len(names) >= 14
    for name in names:
        method = inspect.signature(getattr(hwsim.Lab, name))
        parameters = [p for p in method.parameters.values() if p.name != "self"]
        assert inspect.signature(getattr(hwsim, name)).parameters == {p.name: p for p in parameters}, name


def test_everything_public_says_what_it_is():
    for name in hwsim.__all__:
        thing = getattr(hwsim, name)
        if inspect.isclass(thing) or inspect.isfunction(thing):
            assert thing.__doc__, name
        if inspect.isclass(thing):
            for member, value in vars(thing).items():
                if inspect.isfunction(value) and not member.startswith("_"):
                    assert value.__doc__, f"{name}.{member}"


def test_import_reads_no_file_of_the_configuration_and_no_pandas():
    assert python("import sys, hwsim; print('pandas' in sys.modules, 'tqdm' in sys.modules)") == "False False"
    assert python("import hwsim; print(hwsim._default is None)") == "True"


def test_version_is_that_of_the_build():
    assert hwsim.__version__.split(".")[0].isdigit()


def test_functions_ask_the_default_lab(monkeypatch, lab, triangle):
    monkeypatch.setattr(hwsim, "_default", lab)
    assert hwsim.default_lab() is lab
    frame = hwsim.emulate(triangle, "msaa4x", hwsim.gpu("gtx980"), resolution=(64, 48))
    assert frame.time().time_ms == lab.emulate(triangle, "msaa4x", resolution=(64, 48)).time().time_ms
    hwsim.show_progress(False)


def mypy(*arguments, **environment):
    pytest.importorskip("mypy")
    command = [sys.executable, "-m", *arguments]
    where = os.environ | environment
    result = subprocess.run(command, capture_output=True, text=True, cwd=Path(hwsim.__file__).parents[1], env=where)
    return result.stdout + result.stderr if result.returncode else ""


def test_the_stub_is_that_of_the_module():
    assert mypy("mypy.stubtest", "hwsim._core", "--mypy-config-file", CONFIG, "--allowlist", ALLOWED, MYPYPATH=".") == ""


def test_types_hold():
    assert mypy("mypy", "--config-file", CONFIG, "hwsim") == ""
