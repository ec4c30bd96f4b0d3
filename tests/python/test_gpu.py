"""GPUs as mappings."""

import pytest

import hwsim


def test_a_gpu_is_a_mapping_of_typed_values(lab):
    gpu = lab.gpu("gtx980")
    assert set(gpu) == set(hwsim.gpu_keys())
    assert len(gpu) == len(dict(gpu)) > 60
    assert gpu["core_clock_mhz"] > 1000 and isinstance(gpu["core_clock_mhz"], float)
    assert gpu["features.float_atomics"] in (True, False)
    assert isinstance(gpu["features.native_msaa_max"], int) and isinstance(gpu["raster_engines"], int)
    assert "no_such_key" not in gpu
    with pytest.raises(KeyError):
        gpu["no_such_key"]
    with pytest.raises(KeyError):
        gpu.origin("no_such_key")


def test_values_lie_in_the_ranges_of_their_keys(lab):
    gpu = lab.gpu("gtx980")
    for name, key in hwsim.gpu_keys().items():
        assert key.description
        value = gpu[name]
        if not isinstance(value, (bool, str)):
            assert key.low <= value <= key.high, name


def test_origins_name_their_source(lab):
    gpu = lab.gpu("gtx980", calibrated=False)
    cores = gpu.origin("shader_cores")
    assert cores.provenance == "published" and cores.file.endswith("gtx980.toml") and cores.line > 0
    clock = gpu.but(core_clock_mhz=1000).origin("core_clock_mhz")
    assert clock.layer == "setting"
    assert str(cores) == cores.text


def test_variants_leave_the_gpu_as_it_is(lab):
    gpu = lab.gpu("gtx980")
    clock = gpu["core_clock_mhz"]
    assert gpu.scaled(core_clock_mhz=1.5)["core_clock_mhz"] == pytest.approx(1.5 * clock)
    assert gpu.but(core_clock_mhz="x0.5")["core_clock_mhz"] == pytest.approx(0.5 * clock)
    assert gpu.but({"features.native_msaa_max": 4})["features.native_msaa_max"] == 4
    assert gpu["core_clock_mhz"] == clock
    both = gpu.but(core_clock_mhz=900).but(l2_size_kib=4096)
    assert (both["core_clock_mhz"], both["l2_size_kib"]) == (900, 4096)
    assert both.label == "gtx980 core_clock_mhz=900 l2_size_kib=4096"


def test_difference_holds_both_values(lab):
    gpu = lab.gpu("gtx980")
    assert gpu.difference(gpu.but(l2_size_kib=4096)) == {"l2_size_kib": (gpu["l2_size_kib"], 4096)}
    assert gpu.difference(gpu) == {}
    assert set(gpu.difference(gpu.over("dram-x2"))) == {"dram_bandwidth_gb_s"}


def test_equal_numbers_make_equal_gpus(lab):
    gpu = lab.gpu("gtx980")
    assert gpu == gpu.but(core_clock_mhz=gpu["core_clock_mhz"])
    assert gpu != gpu.but(core_clock_mhz=900)
    assert len({gpu, gpu.scaled(core_clock_mhz=1), gpu.over("rops-x2")}) == 2
    assert gpu != "gtx980"


def test_a_file_is_a_gpu_and_toml_reads_back(lab, tmp_path):
    file = tmp_path / "fat.toml"
    file.write_text('schema = 1\nkind = "gpu"\nid = "fat"\nextends = "gtx980"\nl2_size_kib = 8192\n')
    fat = lab.gpu(str(file))
    assert fat.id == "fat" and fat["l2_size_kib"] == 8192
    copy = tmp_path / "copy.toml"
    copy.write_text(fat.to_toml())
    assert lab.gpu(str(copy)) == fat
    assert fat.to_toml(origins=True).count("#") > 20


def test_notebooks_show_a_gpu(lab):
    gpu = lab.gpu("gtx980")
    assert "core_clock_mhz" in gpu._repr_html_()
    assert repr(gpu.over("rops-x2")) == "<hwsim.Gpu gtx980 rops-x2>"
