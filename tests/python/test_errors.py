"""Mistakes: all of them at once, with code, place and remedy."""

import pickle

import pytest

import hwsim


def codes(question):
    with pytest.raises(hwsim.InputError) as caught:
        question()
    return caught.value.codes


def test_a_mistake_is_a_value_error_with_diagnostics(lab):
    with pytest.raises(ValueError) as caught:
        lab.gpu("gtx981")
    error = caught.value
    assert isinstance(error, hwsim.InputError)
    first = error.diagnostics[0]
    assert first.severity == "error" and first.code == error.codes[0]
    assert "gtx980" in first.hint
    assert first.code in str(error) and first.message in str(error)


def test_mistakes_have_a_place_in_their_file(lab, tmp_path):
    file = tmp_path / "wrong.toml"
    file.write_text('schema = 1\nkind = "gpu"\nid = "wrong"\nextends = "gtx980"\nl2_size_kibs = 8192\ncore_clock_mhz = -1\n')
    with pytest.raises(hwsim.InputError) as caught:
        lab.gpu(str(file))
    lines = {d.code: (d.file, d.line) for d in caught.value.diagnostics}
    assert lines == {"C012": (str(file), 5), "C014": (str(file), 6)}
    assert any("l2_size_kib" in d.hint for d in caught.value.diagnostics)


def test_each_wrong_word_is_told(lab, triangle):
    gpu = lab.gpu("gtx980")
    assert codes(lambda: gpu.but(no_such_key=1, core_clock_mhz=-1)) == ("C012", "C014")
    assert codes(lambda: gpu.over("no-such")) == ("U018",)
    assert codes(lambda: lab.emulate(triangle, "msaa5x", engine="queues")) == ("U006", "T001")
    assert codes(lambda: lab.emulate("no_such.gltf")) == codes(lambda: lab.scene("no_such.gltf"))
    assert codes(lambda: lab.emulate(triangle, resolution=(0, 48))) == ("C014",)
    assert codes(lambda: lab.emulate(triangle, camera="nowhere")) == ("U009",)
    assert codes(lambda: lab.emulate(triangle, settings={"scene.lights": "dim"})) == ("U003",)
    assert codes(lambda: lab.emulate(hwsim.View(str(triangle), lights="dim"))) == ("U003",)
    assert codes(lambda: lab.rank(triangle, ["none"], budget="beauty<=1")) == ("U022",)
    assert codes(lambda: lab.compare(triangle)) == ("U002",)
    assert codes(lambda: lab.validate("no_such_paper")) == ("U003",)


def test_a_value_of_no_type_is_a_type_error(lab):
    with pytest.raises(TypeError, match="bool, int, float or str"):
        lab.gpu("gtx980").but(core_clock_mhz=[1])
    with pytest.raises(TypeError):
        hwsim.View("grass", camra=1)


def test_an_error_crosses_processes(lab):
    with pytest.raises(hwsim.InputError) as caught:
        lab.gpu("gtx981")
    copy = pickle.loads(pickle.dumps(caught.value))
    assert copy.diagnostics == caught.value.diagnostics


def test_the_lab_goes_on_after_a_mistake(lab, triangle):
    codes(lambda: lab.emulate(triangle, "msaa5x"))
    assert lab.emulate(triangle, resolution=(16, 16)).time().time_ms > 0
