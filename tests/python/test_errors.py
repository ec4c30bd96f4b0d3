"""Mistakes: all of them at once, with code, place and remedy."""

import pickle

from fractions import Fraction

import numpy as np
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


class Itself:
    """Iterates over itself, for ever."""

    def __iter__(self):
        return self

    def __next__(self):
        return self


class Broken:
    """A number by its type alone."""

    def __index__(self):
        raise ValueError("no number after all")

    def __iter__(self):
        return 5


NO_VALUES = [np.array([1000.0, 2000.0]), np.array([1000]), np.ones((2, 2)), np.array([], int), np.array(None)]
NO_VALUES += [[1000.0], [[1000.0]], (1000,), {}, {"x": 1}, None, b"1000", 1j, np.complex128(1j), object(), int]
NO_VALUES += [np.datetime64("2020-01-01"), Itself(), Broken(), iter([1000]), np.array(["x2"])]


@pytest.mark.parametrize("value", NO_VALUES, ids=repr)
def test_what_is_no_value_is_a_type_error_that_names_the_key(lab, frame, triangle, value):
    gpu = lab.gpu("gtx980")
    for question in (
        lambda: gpu.but(core_clock_mhz=value),
        lambda: gpu.but({"features.native_msaa_max": value}),
        lambda: frame.sweep({"core_clock_mhz": [1000, value]}, gpu),
        lambda: lab.sweep(triangle, "none", gpu, {"gpu.core_clock_mhz": [value]}),
        lambda: lab.emulate(triangle, settings={"gpu.core_clock_mhz": value}),
    ):
        with pytest.raises(TypeError, match="gpu.(core_clock_mhz|features.native_msaa_max)` must be bool, int, float or str, not"):
            question()
    with pytest.raises(TypeError, match="`point_lights` must be bool, int, float or str, not"):
        lab.emulate(hwsim.View(triangle, point_lights=value))
    with pytest.raises(TypeError, match="the factor of `core_clock_mhz` must be a number"):
        gpu.scaled(core_clock_mhz=value)


def test_grids_of_arrays_are_type_errors(lab, frame, triangle):
    grid = np.ones((2, 2)) * 1000
    for question in (
        lambda: frame.sweep({"core_clock_mhz": grid}, "gtx980"),
        lambda: lab.sweep(triangle, "none", "gtx980", {"gpu.core_clock_mhz": grid}),
        lambda: lab.sweep(triangle, "none", "gtx980", {"gpu.functional.gs_max_scalars": grid}),
    ):
        with pytest.raises(TypeError, match="not numpy.ndarray"):
            question()


@pytest.mark.parametrize("kind", [np.float32, np.float64, np.longdouble, np.int32, np.uint64, np.int8, np.array, Fraction, str])
def test_numbers_of_other_types_are_numbers(lab, frame, kind):
    gpu = lab.gpu("gtx980")
    assert gpu.but(l2_size_kib=kind(100))["l2_size_kib"] == 100
    assert gpu.but({"features.native_msaa_max": kind(4)})["features.native_msaa_max"] == 4
    assert frame.sweep({"l2_size_kib": [kind(100), kind(120)]}).shape == (2,)
    if kind is not str:
        assert gpu.scaled(core_clock_mhz=kind(2)) == gpu.but(core_clock_mhz="x2")


def test_switches_of_numpy_are_switches(lab):
    for value in (True, np.bool_(True), False, np.bool_(False)):
        assert lab.gpu("gtx980").but({"features.float_atomics": value})["features.float_atomics"] is bool(value)


def test_numbers_beyond_all_ranges_are_told_as_such(lab):
    for value in (10**30, 10**400, 1e300, np.uint64(2**64 - 1), float("nan")):
        assert codes(lambda: lab.gpu("gtx980").but(core_clock_mhz=value)) == ("C014",), value


def test_arguments_of_the_wrong_type_are_named(lab, frame, triangle):
    gpu = lab.gpu("gtx980")
    for name, question in {
        "technique": lambda: lab.emulate(triangle, 42),
        "technique ": lambda: lab.emulate(triangle, ["none", "msaa4x"]),
        "scene": lambda: lab.emulate(42),
        "gpu": lambda: lab.emulate(triangle, "none", 42),
        "engine": lambda: lab.emulate(triangle, engine=["queue"]),
        "settings": lambda: lab.emulate(triangle, settings=["scene.lights"]),
        "a name in settings": lambda: lab.emulate(triangle, settings={1: 2}),
        "settings ": lambda: gpu.but(5),
        "overlay": lambda: gpu.over(["rops-x2"]),
        r"techniques\[1\]": lambda: lab.rank(triangle, ["none", 4]),
        "techniques": lambda: lab.rank(triangle, 4),
        "budget": lambda: lab.rank(triangle, "none", budget=1.5),
        "gpus": lambda: lab.compare(triangle, "none", gpu),
        r"gpus\[0\]": lambda: lab.compare(triangle, "none", [gpu]),
        "what_if": lambda: lab.compare(triangle, what_if=2),
        "papers": lambda: lab.validate(5),
        "vary": lambda: frame.sweep(["core_clock_mhz"]),
        "core_clock_mhz": lambda: frame.sweep({"core_clock_mhz": 1000}),
        "core_clock_mhz ": lambda: frame.sweep({"core_clock_mhz": "x2"}),
        "core_clock_mhz  ": lambda: frame.sweep({"core_clock_mhz": np.array(1000)}),
        "core_clock_mhz   ": lambda: frame.sweep({"core_clock_mhz": Broken()}),
        "scene.lights": lambda: lab.sweep(triangle, "none", "gtx980", {"scene.lights": "dim"}),
    }.items():
        with pytest.raises(TypeError, match=f"`{name.strip()}`"):
            question()


def test_lists_without_values_are_told_as_such(lab, frame, triangle):
    for name, question in {
        "core_clock_mhz": lambda: frame.sweep({"core_clock_mhz": []}),
        "gpu.core_clock_mhz": lambda: lab.sweep(triangle, "none", "gtx980", {"gpu.core_clock_mhz": np.array([])}),
        "resolution": lambda: lab.sweep(triangle, "none", "gtx980", {"resolution": ()}),
        "techniques": lambda: lab.sweep(triangle, []),
        "gpus": lambda: lab.sweep(triangle, "none", []),
    }.items():
        with pytest.raises(ValueError, match=f"`{name}` has no values: the list is empty"):
            question()
    with pytest.raises(ValueError, match="more than 1000000 values"):
        frame.sweep({"core_clock_mhz": Itself()})


def test_iterators_are_read_once(frame, lab, triangle):
    assert frame.sweep({"core_clock_mhz": (clock for clock in (900, 1000))}).coords == {"core_clock_mhz": [900, 1000]}
    view = hwsim.View(triangle, resolution=(16, 16))
    assert lab.sweep(view, iter(["none", "msaa4x"]), iter(["gtx980"]), {"camera": iter([0])}).shape == (2, 1, 1)


@pytest.mark.parametrize("wrong", [480, (160, 90, 4), (160,), "160", "160x90x4", "x", "axb", (1.5, 2), ("160", "90"), np.ones((2, 2)), None])
def test_a_resolution_is_two_whole_numbers(triangle, wrong):
    with pytest.raises((TypeError, ValueError), match=r"resolution is \(width, height\), e.g. \(640, 360\)"):
        hwsim.View(triangle, resolution=wrong)


@pytest.mark.parametrize("right", [(160, 90), [160, 90], "160x90", np.array([160, 90]), (np.int64(160), 90.0)])
def test_a_resolution_may_be_written_in_several_ways(lab, triangle, right):
    view = hwsim.View(triangle, resolution=right)
    assert view.resolution == (160, 90) and view == hwsim.View(triangle, resolution=(160, 90))
    assert lab.emulate(triangle, resolution=right, images=False).resolution == (160, 90)


def test_an_error_crosses_processes(lab):
    with pytest.raises(hwsim.InputError) as caught:
        lab.gpu("gtx981")
    copy = pickle.loads(pickle.dumps(caught.value))
    assert copy.diagnostics == caught.value.diagnostics


def test_the_lab_goes_on_after_a_mistake(lab, triangle):
    codes(lambda: lab.emulate(triangle, "msaa5x"))
    assert lab.emulate(triangle, resolution=(16, 16)).time().time_ms > 0
