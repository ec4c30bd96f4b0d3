"""The tutorial, the examples and the notebook run as they stand."""

import csv
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

SOURCE = Path(__file__).resolve().parents[2]
EXAMPLES = SOURCE / "examples"


def run(script, *arguments, cwd):
    command = [sys.executable, EXAMPLES / script, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, cwd=cwd)


def test_every_block_of_the_tutorial_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    page = SOURCE / "docs" / "python.md"
    blocks = list(re.finditer(r"^```python\n(.*?)^```$", page.read_text(), re.MULTILINE | re.DOTALL))
    assert len(blocks) >= 10
    names = {}
    for block in blocks:
        first_line = page.read_text()[: block.start(1)].count("\n")
        code = "\n" * first_line + block[1]  # so that an error names the page's line
        exec(compile(code, str(page), "exec"), names)
    assert (tmp_path / "frame.png").exists()


def test_example_what_if_rops(tmp_path, triangle):
    result = run("what_if_rops.py", triangle, cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    assert result.stdout.count("x the ROPs") == 12 and "GeForce GTX 980" in result.stdout


def test_example_technique_in_a_budget(tmp_path, triangle):
    result = run("technique_in_a_budget.py", triangle, cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    assert (tmp_path / "best.png").exists()
    none = run("technique_in_a_budget.py", triangle, "gtx980", "frame_ms<=1e-9", cwd=tmp_path)
    assert none.returncode == 1 and "no technique is within" in none.stdout
    missing = run("technique_in_a_budget.py", "missing.gltf", cwd=tmp_path)
    assert missing.returncode == 1 and "missing.gltf" in missing.stderr and "Traceback" not in missing.stderr


def test_example_sensitivities(tmp_path, triangle):
    result = run("sensitivities.py", triangle, cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    rows = list(csv.DictReader(result.stdout.splitlines()))
    assert {row["gpu"] for row in rows} == {"gtx470", "gtx980", "rtx3060", "rx7900xtx"}
    assert all(float(row["elasticity"]) for row in rows)


def test_the_notebook_runs():
    nbclient, nbformat = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    pytest.importorskip("ipykernel")
    notebook = nbformat.read(EXAMPLES / "first_look.ipynb", as_version=4)
    nbclient.NotebookClient(notebook, timeout=300, kernel_name="python3").execute()
    shown = {kind for cell in notebook.cells for out in cell.get("outputs", []) for kind in out.get("data", {})}
    assert {"image/png", "text/html"} <= shown


def test_the_notebook_is_kept_without_what_it_printed():
    text = (EXAMPLES / "first_look.ipynb").read_text()
    assert '"outputs": []' in text and "image/png" not in text


def test_every_example_is_listed_and_tested():
    listed = (EXAMPLES / "README.md").read_text()
    here = Path(__file__).read_text()
    names = [n for n in os.listdir(EXAMPLES) if n.endswith((".py", ".ipynb"))]
    assert len(names) == 4
    for name in names:
        assert name in listed and name in here, name
