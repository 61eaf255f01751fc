"""Shaders written in Python keep the contract of shaders, and conform finds the broken twin: millions of calls, some minutes."""

from parts_examples import Matte, WrongMatte

import etendue


def failed(cls):
    return [o.check for o in etendue.conform(cls, drawn=0) if o.class_name == cls.__name__ and o.result == "failed"]


def test_a_shader_conforms():
    assert failed(Matte) == []


def test_its_broken_twin_does_not():
    found = failed(WrongMatte)
    assert "the density integrates to at most 1" in found and "samples follow the density" in found
