"""Which build of an installed package is used: etendue/_installation.py, on packages made up for the test."""

import importlib.util
import pathlib
import shutil

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
OLD = "sse4_2 cx16 lahf_lm popcnt sse4_1 ssse3"
HASWELL = OLD + " avx avx2 bmi1 bmi2 f16c fma abm movbe xsave"
SKYLAKE = HASWELL + " avx512f avx512bw avx512cd avx512dq avx512vl"
ALL = ["x86-64-v2", "x86-64-v3", "x86-64-v4"]


@pytest.fixture
def package(tmp_path, monkeypatch):
    """Makes a package with builds for these architectures, on a processor with these flags."""

    def make(architectures, flags):
        folder = tmp_path / "etendue"
        shutil.rmtree(folder, ignore_errors=True)
        for architecture in architectures:
            (folder / "_prefix" / architecture).mkdir(parents=True)
        shared = folder / "_prefix" / "share" / "etendue"
        shared.mkdir(parents=True)
        shutil.copy(ROOT / "packaging" / "architectures.txt", shared)
        shutil.copy(ROOT / "python" / "etendue" / "_installation.py", folder)
        specification = importlib.util.spec_from_file_location("_installation", folder / "_installation.py")
        module = importlib.util.module_from_spec(specification)
        specification.loader.exec_module(module)
        monkeypatch.setattr(module, "_processor_flags", lambda: set(flags.split()))
        return module

    monkeypatch.delenv("ETENDUE_ARCHITECTURE", raising=False)
    return make


@pytest.mark.parametrize("flags, expected", [(OLD, "x86-64-v2"), (HASWELL, "x86-64-v3"), (SKYLAKE, "x86-64-v4")])
def test_the_best_build_that_the_processor_can_run_is_used(package, flags, expected):
    module = package(ALL, flags)
    assert module.architecture() == expected
    assert module.folder_of_build() == str(pathlib.Path(module.prefix()) / expected)
    assert module.available_architectures() == ["x86-64-v4", "x86-64-v3", "x86-64-v2"]


@pytest.mark.parametrize("flag", HASWELL.removeprefix(OLD).split())
def test_a_processor_that_lacks_one_flag_of_an_architecture_does_not_get_it(package, flag):
    assert package(ALL, SKYLAKE.replace(f" {flag} ", " ")).architecture() == "x86-64-v2"


def test_an_architecture_that_was_not_built_is_not_chosen(package):
    assert package(["x86-64-v2", "x86-64-v3"], SKYLAKE).architecture() == "x86-64-v3"
    assert package(["native"], OLD).architecture() == "native"


def test_a_processor_that_is_too_old_is_told_what_it_lacks(package):
    with pytest.raises(ImportError, match="older than x86-64-v2: it has no sse4_2"):
        package(ALL, OLD.replace("sse4_2 ", "")).architecture()


def test_the_environment_chooses_another_build(package, monkeypatch):
    module = package(ALL, SKYLAKE)
    monkeypatch.setenv("ETENDUE_ARCHITECTURE", "x86-64-v2")
    assert module.architecture() == "x86-64-v2"
    monkeypatch.setenv("ETENDUE_ARCHITECTURE", "native")
    with pytest.raises(ImportError, match="'native'; this package was built for x86-64-v4, x86-64-v3, x86-64-v2"):
        module.architecture()


def test_a_build_folder_has_one_build(package):
    module = package([], OLD)
    shutil.rmtree(module.prefix())
    assert module.prefix() is None
    assert module.folder_of_build() == module._package
    assert module.build_info()["architectures"] == []


def test_the_package_tells_how_it_was_built():
    import etendue

    information = etendue.build_info()
    assert information["version"] == etendue.__version__
    assert information["architecture"]
    assert pathlib.Path(information["program"]).is_file()
