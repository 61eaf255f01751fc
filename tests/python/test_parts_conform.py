"""Parts written in Python keep the contracts of their interfaces, and conform finds the broken twin of each."""

import pytest
from parts_examples import (
    ArrayTracer,
    Beam,
    DarkTracer,
    Matte,
    OddTent,
    Pinhole,
    Rayleigh,
    Soft,
    Tent,
    Tinted,
    UnboundedWaves,
    Waves,
    WrongBeam,
    WrongMatte,
    WrongPinhole,
    WrongRayleigh,
)

import etendue


def outcomes(cls, drawn):
    return etendue._core.conform_quickly([cls.__name__], drawn, 1)


@pytest.mark.parametrize("cls", [Waves, Soft, ArrayTracer, Matte, Beam, Pinhole, Tent, Rayleigh])
def test_it_conforms(cls):
    found = outcomes(cls, 1)
    assert [o for o in found if o[2] == "failed" and o[0] == cls.__name__] == []
    assert sum(o[2] == "passed" for o in found) >= 8


@pytest.mark.parametrize(
    "cls, check",
    [
        (UnboundedWaves, "the scalar is a mean of the colour's values"),
        (Tinted, "greys stay grey"),
        (DarkTracer, "the value of a furnace is the known one"),
        (WrongMatte, "a sample"),
        (WrongBeam, "the density integrates to 1"),
        (WrongPinhole, "rays and lens samples measure the same light"),
        (OddTent, ""),
        (WrongRayleigh, ""),
    ],
)
def test_the_broken_twin_does_not(cls, check):
    failed = [o[1] for o in outcomes(cls, 0) if o[2] == "failed"]
    assert any(check in f for f in failed), failed
