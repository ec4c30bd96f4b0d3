"""The lab: what there is, rankings, comparisons, sweeps over everything, threads and interruptions."""

import logging
import os
import signal
import sys
import threading
import time

import pytest

import hwsim


def test_what_there_is(lab):
    assert "gtx980" in lab.gpus().column("id")
    assert {"none", "msaa4x", "sbaa_top"} <= set(lab.techniques().column("name"))
    assert "sponza_hall" in lab.scenes().column("name")
    assert "rops-x2" in lab.overlays().column("name")
    assert "ps.invocations" in lab.counters().column("id")
    with pytest.raises(KeyError):
        lab.gpus().column("no_such_column")


def test_a_scene_names_its_cameras(lab, triangle):
    scene = lab.scene(triangle)
    assert scene.name == "triangle" and len(scene.cameras) >= 1 and scene.content_hash
    assert all(isinstance(note, hwsim.Diagnostic) for note in scene.notes)


def test_the_reference_is_what_frames_are_compared_with(lab, triangle):
    view = hwsim.View(str(triangle), resolution=(40, 30))
    truth = lab.reference(view, samples=64)
    assert truth.shape == (30, 40, 4)
    aliased = lab.emulate(view, "none", reference_samples=64)
    smooth = lab.emulate(view, "ssaa16x", reference_samples=64)
    assert 0 < smooth.error["flip_mean"] < aliased.error["flip_mean"]


def test_a_view_carries_what_the_request_does_not_say(lab, triangle):
    view = hwsim.View(str(triangle), resolution=(40, 30), lights="complex")
    assert lab.emulate(view).resolution == (40, 30)
    assert lab.emulate(view, resolution=(32, 20)).resolution == (32, 20)
    by_setting = lab.emulate(triangle, resolution=(40, 30), settings={"scene.lights": "complex"})
    assert by_setting.counters == lab.emulate(view).counters
    assert by_setting.counters != lab.emulate(triangle, resolution=(40, 30)).counters


def test_rank_puts_techniques_in_order_and_names_the_best(lab, triangle):
    ranking = lab.rank(triangle, ["msaa4x", "ssaa64x"], budget="extra_mib<=1", reference_samples=4, resolution=(64, 48))
    verdicts = {row["technique"]: row["verdict"] for row in ranking}
    assert verdicts["ssaa64x"] == "over memory" and set(verdicts) == {"none", "msaa4x", "ssaa64x"}
    assert ranking.best == ranking[0]["technique"] == "msaa4x"
    assert lab.rank(triangle, "none", budget="frame_ms<=1e-9", reference_samples=4, resolution=(64, 48)).best is None


def test_compare_shows_what_a_what_if_changes(lab, triangle):
    comparison = lab.compare(triangle, "msaa8x", what_if=["rops-x2", "dram-x0.5"], resolution=(64, 48))
    assert len(comparison.frames) == 3
    gpu = lab.gpu("gtx980")
    frame = lab.emulate(triangle, "msaa8x", resolution=(64, 48))
    own = hwsim.compare_timings({"baseline": frame.time(gpu), "slow": frame.time(gpu.over("dram-x0.5"))})
    times = [row["time_ms"] for row in comparison.frames]
    assert [row["time_ms"] for row in own.frames] == [times[0], times[2]]
    assert len(own.passes) and not len(own.counters)
    assert own.to_dict()["baseline"]["label"] == "baseline"
    assert own.matrix.columns[-1] == "dram-x0.5" and comparison.matrix.columns[-1] == "dram-x0.5"
    assert own.matrix[0]["dram-x0.5"] == comparison.matrix[0]["dram-x0.5"]
    with pytest.raises(ValueError):
        hwsim.compare_timings({})


def test_a_sweep_draws_once_for_each_work_and_times_the_rest(lab, triangle):
    told = []
    lab.progress = lambda done, what: told.append(what)
    view = hwsim.View(str(triangle), resolution=(64, 48))
    vary = {"gpu.core_clock_mhz": [600, 1200], "resolution": [(32, 24), (64, 48)], "scene.lights": ["simple", "complex"]}
    gpus = ["gtx980", lab.gpu("rtx3060").but(l2_size_kib=6144)]
    sweep = lab.sweep(view, ["none", "msaa4x"], gpus, vary)
    lab.progress = False
    assert sweep.dims == ("technique", "gpu", *vary) and sweep.shape == (2, 2, 2, 2, 2)
    assert told
    row = sweep.point((1, 1, 0, 0, 1))
    alone = lab.emulate(triangle, "msaa4x", gpus[1], resolution=(32, 24), settings={"scene.lights": "complex"})
    assert row["gpu"] == "rtx3060 l2_size_kib=6144" and row["resolution"] == (32, 24)
    assert row["time_ms"] == alone.time(gpus[1].but(core_clock_mhz=600)).time_ms
    assert row["support"] == "uncalibrated" and str(sweep.support[0, 0, 0, 0, 0]) != "uncalibrated"


def test_a_sweep_over_features_draws_for_each(lab, triangle):
    view = hwsim.View(str(triangle), resolution=(64, 48))
    sweep = lab.sweep(view, "msaa4x", "gtx980", {"gpu.functional.post_transform_cache_entries": [8, 32]})
    assert sweep.shape == (1, 1, 2)


def test_a_sweep_is_checked_before_it_draws(lab, triangle):
    with pytest.raises(hwsim.InputError) as caught:
        lab.sweep(triangle, ["none", "msaa4x"], "gtx980", {"scene.lights": ["simple", "dim"]})
    assert caught.value.codes == ("U003",)


def test_one_lab_answers_several_threads(lab, triangle):
    times, errors = [], []

    def ask(technique):
        try:
            times.append(lab.emulate(triangle, technique, resolution=(64, 48), images=False).time().time_ms)
        except Exception as error:  # noqa: BLE001
            errors.append(error)

    threads = [threading.Thread(target=ask, args=(t,)) for t in ("none", "msaa2x", "msaa4x", "none")]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not errors and len(times) == 4 and len(set(times)) == 3


def counted_meanwhile(work):
    """How often another thread got the interpreter's lock while ``work`` ran.

    The thread does not get it but where the lock is given up: nobody is made to give it up within a minute.
    """
    count, working = [0], threading.Event()
    working.set()

    def tick():
        while working.is_set():
            count[0] += 1
            time.sleep(0.001)

    interval = sys.getswitchinterval()
    sys.setswitchinterval(60)
    thread = threading.Thread(target=tick)
    thread.start()
    before = count[0]
    work()
    during = count[0] - before
    working.clear()
    thread.join()
    sys.setswitchinterval(interval)
    return during


def test_python_goes_on_while_a_lab_works(triangle):
    lab = hwsim.Lab(cache="", jobs=1)
    assert counted_meanwhile(lambda: lab.emulate(triangle, "ssaa16x", resolution=(512, 512))) > 5


def test_python_goes_on_while_a_frame_is_timed(lab, triangle):
    frame = lab.emulate(triangle, "msaa8x", resolution=(256, 256), engine="detailed")
    gpu = lab.gpu("gtx980")
    assert counted_meanwhile(lambda: [frame.time(gpu) for _ in range(3)]) > 5
    assert counted_meanwhile(lambda: [frame._core.facts() for _ in range(100)]) <= 1, "it would count anyway"


def test_ctrl_c_ends_the_work_and_the_lab_goes_on(triangle):
    lab = hwsim.Lab(cache="", jobs=1)
    asked = []

    def interrupt(done, what):
        if not asked:
            asked.append(what)
            os.kill(os.getpid(), signal.SIGINT)

    frame = lab.emulate(triangle, resolution=(64, 48))
    lab.progress = interrupt
    with pytest.raises(KeyboardInterrupt):
        frame.sweep({"core_clock_mhz": [500 + i / 100 for i in range(100_000)]})
    assert asked
    lab.progress = False
    assert frame.sweep({"core_clock_mhz": [500, 1000]}).shape == (2,)


def test_what_a_progress_function_raises_comes_out(lab, triangle):
    def refuse(done, what):
        raise RuntimeError("enough")

    lab.progress = refuse
    with pytest.raises(RuntimeError, match="enough"):
        lab.emulate(triangle, "msaa2x", resolution=(48, 48))
    lab.progress = False
    assert lab.emulate(triangle, "msaa2x", resolution=(48, 48)).time().time_ms > 0


def test_progress_may_be_a_bar(lab, triangle, capsys):
    pytest.importorskip("tqdm")
    lab.progress = True
    lab.emulate(triangle, "msaa2x", resolution=(40, 48))
    lab.progress = False
    assert "%" in capsys.readouterr().err


def test_notes_go_to_logging(triangle, caplog):
    with caplog.at_level(logging.DEBUG, logger="hwsim"):
        hwsim.Lab(cache="", jobs=1).emulate(triangle, resolution=(16, 16))
    assert any("camera" in record.message for record in caplog.records), "the triangle has no camera"


def test_a_lab_has_its_own_folders(triangle, tmp_path):
    with pytest.raises(hwsim.InputError) as caught:
        hwsim.Lab(configs=tmp_path).gpu("gtx980")
    assert caught.value.codes == ("U012",)
    first = hwsim.Lab(cache=tmp_path / "cache", jobs=1).emulate(triangle, resolution=(16, 16))
    second = hwsim.Lab(cache=tmp_path / "cache", jobs=1).emulate(triangle, resolution=(16, 16))
    assert (first.from_cache, second.from_cache) == (False, True)
    assert (first.image == second.image).all() and first.counters == second.counters


def test_the_lab_says_that_it_works(lab):
    assert all(row["ok"] for row in lab.doctor())


def test_a_report_is_one_page_that_says_what_made_it(lab, triangle, tmp_path):
    page = lab.report(tmp_path / "page.html", triangle, ["none", "msaa4x"], what_if="dram-x2", resolution=(64, 48))
    text = page.read_text()
    assert page.stat().st_size < 5_000_000 and text.startswith("<!doctype html>")
    assert "msaa4x on gtx980" in text and "dram-x2" in text and "hwsim.report(" in text
    with pytest.raises(FileExistsError):
        lab.report(page, triangle)
    assert "none on gtx980" in lab.report(page, triangle, resolution=(64, 48), force=True).read_text()
    with pytest.raises(hwsim.InputError) as caught:
        lab.report(tmp_path / "other.html", triangle, "msaa5x")
    assert not (tmp_path / "other.html").exists() and caught.value.codes


def test_a_report_of_what_the_program_wrote_names_what_it_cannot_read(lab, tmp_path):
    with pytest.raises(hwsim.InputError) as caught:
        lab.report_of(tmp_path / "page.html", tmp_path)
    assert caught.value.codes == ("U020",)
