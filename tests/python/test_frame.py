"""A frame that was emulated once: pictures without copies, counts, times, derivatives, grids."""

import gc
import math

import numpy as np
import pytest

import hwsim


def test_pictures_are_views_of_the_emulators_memory(frame):
    assert frame.image.shape == (48, 64, 4) and frame.image.dtype == np.float32
    assert frame.shading_heat.shape == (48, 64) and frame.shading_heat.dtype == np.float32
    assert frame.flip_map.shape == (48, 64)
    assert frame.image_srgb.shape == (48, 64, 3) and frame.image_srgb.dtype == np.uint8
    assert np.shares_memory(frame.image, frame.image) and not frame.image.flags.owndata
    for picture in (frame.image, frame.shading_heat, frame.flip_map):
        with pytest.raises(ValueError):
            picture[0, 0] = 1


def test_a_picture_outlives_its_frame_and_lab(triangle):
    lab = hwsim.Lab(cache="", jobs=1)
    frame = lab.emulate(triangle, resolution=(32, 32))
    image, before = frame.image, frame.image.copy()
    del frame, lab
    gc.collect()
    assert np.array_equal(image, before) and image.std() > 0


def test_pictures_agree_with_each_other(frame, tmp_path):
    linear = np.clip(frame.image[..., :3].astype(float), 0, 1)
    srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    assert np.abs(np.round(255 * srgb) - frame.image_srgb).max() <= 1
    assert frame.shading_heat.sum() == frame.counters["ps.invocations"]
    assert frame.flip_map.mean() == pytest.approx(frame.error["flip_mean"], rel=1e-5)
    frame.save(tmp_path / "frame.png")
    assert (tmp_path / "frame.png").read_bytes() == frame._repr_png_()
    assert frame._repr_png_().startswith(b"\x89PNG")


def test_a_frame_without_pictures_says_so(lab, triangle):
    frame = lab.emulate(triangle, resolution=(64, 44), images=False)
    with pytest.raises(ValueError, match="without pictures"):
        frame.image
    assert frame._repr_png_() is None and frame.error is None
    compared = lab.emulate(triangle, resolution=(64, 44), images=False, reference_samples=1)
    assert compared.error is not None
    for without in (frame, compared):
        with pytest.raises(ValueError, match="without pictures"):
            without.flip_map
    assert lab.emulate(triangle, resolution=(64, 44)).flip_map is None, "it was compared with nothing"


def test_counters_are_those_of_the_passes(frame, lab):
    assert set(frame.counters) == set(lab.counters().column("id"))
    for name in ("stats.samples_passed", "ps.invocations"):
        assert frame.counters[name] == sum(p.counters[name] for p in frame.passes) > 0
    assert [p.name for p in frame.passes] == [p.name for p in frame.time().passes]
    assert frame.passes[0].counters == frame.time().passes[0].counters
    assert len(frame.counter_table()) > 10


def test_a_frame_is_timed_on_many_gpus(frame, lab):
    names = lab.gpus().column("id")
    timings = frame.times(names)
    assert [t.gpu for t in timings] == names
    for timing in timings:
        assert timing.time_ms == pytest.approx(sum(p.time_ms for p in timing.passes))
        assert timing.limiter in timing.passes[0].units
        assert (timing.interval_ms is None) == (timing.support == "uncalibrated")
        if timing.interval_ms:
            assert timing.interval_ms[0] <= timing.time_ms <= timing.interval_ms[1]
    assert len({t.time_ms for t in timings}) > 10


def test_a_gpu_of_other_features_is_emulated_for(frame, lab, triangle):
    gpu = lab.gpu("gtx980").but({"functional.post_transform_cache_entries": 16})
    assert not frame._core.is_work_of(gpu._core)
    alone = lab.emulate(triangle, "msaa4x", gpu, resolution=(64, 48))
    assert frame.time(gpu).time_ms == alone.time().time_ms
    assert frame.time(gpu).gpu == "gtx980 functional.post_transform_cache_entries=16"


def test_ratio_is_of_times(frame, lab):
    gpu = lab.gpu("gtx980")
    slow, fast = frame.time(gpu.scaled(core_clock_mhz=0.5)), frame.time(gpu)
    ratio = hwsim.ratio(slow, fast)
    assert float(ratio) == slow.time_ms / fast.time_ms > 1
    assert ratio.interval[0] < ratio.value < ratio.interval[1]
    widths = [high / low for low, high in (ratio.interval, slow.interval_ms)]
    assert widths[0] < widths[1], "what is wrong with both times cancels"
    assert hwsim.ratio(fast, fast).value == 1
    assert hwsim.ratio(frame.time("rtx3060"), fast).interval is None
    assert str(hwsim.Ratio(2.0, (1.5, 2.5))) == "2.000 [1.500, 2.500]"


@pytest.mark.parametrize("engine", ["queue", "roofline"])
def test_the_gradient_is_the_slope_of_the_time(lab, triangle, engine):
    frame = lab.emulate(triangle, "msaa8x", resolution=(64, 48), engine=engine)
    gpu = lab.gpu("gtx980")
    gradient = frame.gradient(gpu)
    assert len(gradient) > 20 and len(gradient.strongest(3)) == 3
    step = 1e-5
    reals = [(key, e) for key, e in gradient.strongest(20) if not isinstance(gpu[key], int)]
    for key, elasticity in reals[:4]:
        up, down = (frame.time(gpu.scaled({key: 1 + s})).time_ms for s in (step, -step))
        measured = (math.log(up) - math.log(down)) / (math.log(1 + step) - math.log(1 - step))
        assert elasticity == pytest.approx(measured, abs=1e-3), key
        slope = elasticity * frame.time(gpu).time_ms / gpu[key]
        assert gradient.slope_ms(key) == pytest.approx(slope)
    assert [row["key"] for row in gradient.table()][0] == gradient.strongest(1)[0][0]


def test_explain_agrees_with_time_and_gradient(frame):
    explanation = frame.explain()
    assert explanation.timing.time_ms == frame.time().time_ms
    elasticities = {row["parameter"]: row["elasticity"] for row in explanation.sensitivities}
    for key, elasticity in frame.gradient().strongest(5):
        assert elasticities["gpu." + key] == pytest.approx(elasticity, rel=1e-9)
    stack = sum(sum(p.values()) for p in explanation.stack_ms)
    assert stack == pytest.approx(explanation.timing.time_ms)
    assert explanation.headroom[0]["time_ms"] <= explanation.timing.time_ms


def test_a_sweep_is_the_time_of_each_point(frame, lab):
    gpu = lab.gpu("gtx980").but(l2_size_kib=4096)
    vary = {"core_clock_mhz": ["x0.5", "x1"], "dram_bandwidth_gb_s": np.array([100.0, 200.0, 300.0])}
    sweep = frame.sweep(vary, gpu)
    assert sweep.dims == ("core_clock_mhz", "dram_bandwidth_gb_s") and sweep.shape == (2, 3) == sweep.time_ms.shape
    for i, clock in enumerate(vary["core_clock_mhz"]):
        for k, bandwidth in enumerate(vary["dram_bandwidth_gb_s"]):
            timing = frame.time(gpu.but(core_clock_mhz=clock, dram_bandwidth_gb_s=float(bandwidth)))
            assert sweep.time_ms[i, k] == timing.time_ms
            assert (sweep.low_ms[i, k], sweep.high_ms[i, k]) == timing.interval_ms
            assert sweep.dram_mb[i, k] == pytest.approx(timing.dram_mb)
            assert sweep.support[i, k] == timing.support
    assert sweep.fastest()["core_clock_mhz"] == "x1"
    assert len(sweep) == 6 == len(sweep.table())


def test_a_sweep_tells_the_points_that_are_none(frame):
    with pytest.raises(hwsim.InputError) as caught:
        frame.sweep({"core_clock_mhz": [1000, -1], "no_such_key": [1]})
    assert set(caught.value.codes) == {"C012", "C014"}
    with pytest.raises(hwsim.InputError) as caught:
        frame.sweep({"functional.post_transform_cache_entries": [8, 16]})
    assert caught.value.codes[0] == "U040"


def test_answers_become_data_frames(frame):
    pandas = pytest.importorskip("pandas")
    sweep = frame.sweep({"core_clock_mhz": [900, 1000], "l2_size_kib": [1024, 2048, 4096]})
    data = sweep.to_dataframe()
    assert isinstance(data, pandas.DataFrame) and data.shape[0] == 6
    assert list(data["l2_size_kib"]) == [1024, 2048, 4096] * 2
    assert list(data["time_ms"]) == list(sweep.time_ms.ravel())
    assert frame.time().to_dataframe().shape[0] == len(frame.passes)
    assert frame.gradient().to_dataframe().shape == (len(frame.gradient()), 4)


def test_answers_show_themselves_in_notebooks(frame):
    sweep = frame.sweep({"core_clock_mhz": list(range(500, 600))})
    for answer in (frame.time(), frame.gradient(), frame.explain(), sweep, frame.counter_table()):
        assert "<table>" in answer._repr_html_()
        assert repr(answer)
    assert "the first 20" in sweep._repr_html_()
    assert hwsim.Table(["a"], [["<b>"]])._repr_html_().count("&lt;b&gt;") == 1
