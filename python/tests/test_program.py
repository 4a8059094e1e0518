"""The command: what it says where something is missing, and where it keeps what it builds. `make newcomer NAMES=program` builds it from a wheel."""

import os

import pytest
from stickslip import _program


def test_what_is_missing_is_named_with_what_to_install(monkeypatch, tmp_path, capsys):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    with pytest.raises(SystemExit) as ended:
        _program.main(["scene.yaml"])
    said = capsys.readouterr().err
    assert ended.value.code == 1
    assert "needs pkg-config, mpicc" in said and "apt install pkg-config libopenmpi-dev" in said, said
    assert not list(tmp_path.rglob("stickslip/*/stickslip"))


def test_a_program_that_is_there_is_taken_and_gets_the_arguments(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    folder = _program._folder(_program._sources())
    folder.mkdir(parents=True)
    made = folder / "stickslip"
    made.write_text("#!/bin/sh\n")
    made.chmod(0o755)
    became = []
    monkeypatch.setattr(os, "execv", lambda path, arguments: became.append((path, arguments)))
    _program.main(["scene.yaml", "-output_dir", "d"])
    assert became == [(str(made), [str(made), "scene.yaml", "-output_dir", "d"])]


def test_other_sources_are_another_program(tmp_path):
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "main.c").write_text(name)
    one, two = (_program._folder(tmp_path / name) for name in ("one", "two"))
    assert one != two and one == _program._folder(tmp_path / "one")
