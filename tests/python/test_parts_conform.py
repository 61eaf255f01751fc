"""Parts written in Python keep the contracts of their interfaces, and conform finds the broken twin of each."""

import pytest
from parts_examples import (
    ArrayTracer,
    Beam,
    DarkTracer,
    OddTent,
    Pinhole,
    Rayleigh,
    Soft,
    Tent,
    Tinted,
    UnboundedWaves,
    Waves,
    WrongBeam,
    WrongPinhole,
    WrongRayleigh,
)

import etendue


def outcomes(cls, drawn):
    """Of the class alone, not of those that derive from it."""
    return [o for o in etendue.conform(cls, drawn=drawn) if o.class_name == cls.__name__]


@pytest.mark.parametrize("cls", [Waves, Soft, ArrayTracer, Beam, Pinhole, Tent, Rayleigh])
def test_it_conforms(cls):
    found = outcomes(cls, 1)
    assert [o for o in found if o.result == "failed"] == []
    assert sum(o.result == "passed" for o in found) >= 8


@pytest.mark.parametrize(
    "cls, check",
    [
        (UnboundedWaves, "the scalar is a mean of the colour's values"),
        (Tinted, "greys stay grey"),
        (DarkTracer, "the value of a furnace is the known one"),
        (WrongBeam, "the density integrates to 1"),
        (WrongPinhole, "rays and lens samples measure the same light"),
        (OddTent, "the filter is symmetric"),
        (WrongRayleigh, "the phase function integrates to 1"),
    ],
)
def test_the_broken_twin_does_not(cls, check):
    failed = [o.check for o in outcomes(cls, 0) if o.result == "failed"]
    assert any(check in f for f in failed), failed
