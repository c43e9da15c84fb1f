"""The C core over NumPy arrays; see csrc/glue."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .chain.chain import Chain

_Real = NDArray[np.float64]
_Ports = tuple[NDArray[np.int32], _Real, _Real | None]
_Complex = NDArray[np.complex128]
_Integers = NDArray[np.int32]
_Plan = NDArray[np.uint8]
_Beside = tuple[_Real, float, _Real, _Real, float, float]
_Law = tuple[_Integers, _Real, _Integers, _Real]
_SmoothCalls = tuple[Callable[[Any, Any, Any], Any] | None, ...]
_SmoothLaws = tuple[_Integers, _Real, _SmoothCalls, NDArray[np.uint8]]
_Step = tuple[float, _Real, _Real, _Real, _Real, _Real, _Real]
_Failure = tuple[BaseException | None, int, float, float, float]
_Space = tuple[Any, ...]
_State = tuple[_Real, _Real, _Real, _Real, _Real]

def section(
    axial: float, torsion: float, bending: float, coupling: float, slope: float, /
) -> _Real: ...
def divide(
    station: _Real, elements: NDArray[np.int64], rope: NDArray[np.int64], rounding: float, /
) -> tuple[
    _Real,
    NDArray[np.int64],
    _Integers,
    NDArray[np.int64],
    _Integers,
    _Integers,
    _Integers,
    _Real,
]: ...
def invert(matrix: _Real, /) -> _Real: ...
def triples(chain: Chain, /) -> tuple[_Real, _Real, _Real]: ...
def shape(chain: Chain, node: int, s: float, /) -> _Real: ...
def local(chain: Chain, node: int, s: float, p: float, /) -> _Real: ...
def assemble(chain: Chain, /) -> tuple[_Real, _Real, _Real, _Real, _Real, _Real, _Real]: ...
def deflection(chain: Chain, force: _Real, /) -> tuple[_Real, float]: ...
def modes(
    chain: Chain, wanted: int, below: float, scale: float, /
) -> tuple[tuple[_Real, _Real, _Real], int]: ...
def frf(
    chain: Chain, factor: NDArray[np.complex128], drives: _Ports, responses: _Ports, /
) -> tuple[NDArray[np.complex128], _Real, _Real, int]: ...
def count(chain: Chain, eigenvalue: _Real, /) -> _Real: ...
def certify(
    chain: Chain, wanted: int, upper: float, shaped: bool, /
) -> tuple[_Real, _Real, _Real, _Real, _Real, int, int, int]: ...
def steps(chain: Chain, factor: _Complex, /) -> int: ...
def scales(chain: Chain, factor: _Complex, /) -> _Real: ...
def sweep(
    chain: Chain,
    factor: _Complex,
    drives: _Ports,
    responses: _Ports,
    between: tuple[_Complex, _Real, _Real] | None = None,
    /,
) -> tuple[_Complex, _Real, int]: ...
def sweep_between(chain: Chain, nodes: _Complex, /) -> _Real: ...
def damped(
    chain: Chain,
    constant: _Complex,
    linear: _Complex,
    middle: float,
    radius: float,
    edge: float,
    horizon: float,
    guess: _Complex,
    /,
) -> tuple[_Complex, _Real, int, float, int, bool, int]: ...
def mixed(
    chain: Chain, factor: _Complex, drives: _Ports, responses: _Ports, /
) -> tuple[_Complex, _Real, int]: ...
def mixed_deflection(chain: Chain, force: _Real, /) -> tuple[_Real, _Real]: ...
def triple(
    chain: Chain, element: int, factor: _Complex, /
) -> tuple[_Complex, _Complex, _Complex]: ...
def energy(chain: Chain, shape: _Real, eigenvalue: _Real, /) -> tuple[_Real, _Real, _Real]: ...
def carried(chain: Chain, shape: _Real, motion: _Real, eigenvalue: _Real, /) -> _Real: ...
def carried_slopes(
    chain: Chain, shape: _Real, motion: _Real, eigenvalue: _Real, /
) -> tuple[_Real, _Real]: ...
def pair_slopes(
    chain: Chain, factor: _Complex, field: _Complex, pair: _Integers, slip: _Integers, /
) -> tuple[_Complex, _Complex, _Complex, _Complex]: ...
def carried_pair_slopes(
    chain: Chain, factor: _Complex, field: _Complex, pair: _Integers, slip: _Integers, /
) -> tuple[_Complex, _Complex]: ...
def tip(chain: Chain, k: int, factor: _Complex, /) -> _Complex: ...
def sensitivity(
    chain: Chain, shape: _Real, motion: _Real, eigenvalue: _Real, /
) -> tuple[_Real, _Real, _Real, _Real]: ...
def eliminate(A: NDArray[Any], columns: int, /) -> None: ...
def substitute(A: NDArray[Any], x: NDArray[Any], /) -> None: ...
def recurrence(
    change: _Real,
    gain: _Real,
    read: _Real,
    local: _Real,
    kind: NDArray[np.int32],
    sample: _Real,
    state: _Real,
    /,
) -> tuple[_Real, _Real]: ...
def balance(
    transfer: _Complex, by_u: _Complex, by_v: _Complex | None, omega: _Real, /
) -> _Real: ...
def first_crossing(
    rate: _Complex, c: _Complex, d: _Complex, a: _Real, scale: _Real, end: float, /
) -> tuple[float, int] | None: ...
def stopped(
    stiffness: float, gap: float, side: float, step: _Real, u: _Real, v: _Real, /
) -> _Real: ...
def collocate(
    step: _Step,
    laws: _SmoothLaws,
    begin: _Real,
    known: _Real,
    force: _Real,
    state: _Real,
    size: _Real,
    /,
) -> tuple[_Real, _Real, _Real, _Real, int, int, float, _Failure | None]: ...
def volterra(
    laws: tuple[_Integers, _Real, _SmoothCalls],
    begin: float,
    h: float,
    kernel: _Real,
    linear: _Real,
    force: _Real,
    motion: _Real,
    size: _Real,
    first: int,
    until: int,
    /,
) -> tuple[int, float, _Failure | None]: ...
def modal_steps(
    step: tuple[float, float, _Real, _Real],
    laws: tuple[_Integers, _Real, _SmoothCalls],
    coupling: tuple[_Real, _Real, _Real | None, _Real, float],
    known: _Real,
    state: _Real,
    pushed: _Real,
    force: _Real,
    largest: _Real,
    size: _Real,
    /,
) -> tuple[int, float, _Failure | None]: ...
def closed_modes(
    kind: str, number: _Real, jacobian: _Real | None, modes: int, /
) -> tuple[_Real, _Real, _Real | None, NDArray[np.bool_]]: ...
def closed_response(
    number: _Real, factor: _Complex, drag: float, drive: _Real, response: _Real, /
) -> tuple[_Complex, _Real, NDArray[np.bool_]]: ...
def closed_count(kind: str, number: _Real, omega: float, /) -> NDArray[np.int64]: ...
def closed_chain_modes(
    kind: str, numbers: _Real, hinge: NDArray[np.uint8], jacobian: _Real | None, number: int, /
) -> tuple[_Real, _Real, _Real | None, NDArray[np.bool_]]: ...
def closed_chain_count(
    kind: str, numbers: _Real, hinge: NDArray[np.uint8], omega: float, /
) -> NDArray[np.int64]: ...
def space_triples(
    rates: _Complex,
    series: _Real,
    length: float,
    equal: int,
    halvings: int,
    doublings: int,
    gentle: float,
    /,
) -> tuple[_Complex, int, bool]: ...
def space_factor(
    D: _Complex,
    G: _Complex,
    Q: _Complex,
    N: _Complex,
    fixed: NDArray[np.uint8],
    closed: bool,
    /,
) -> tuple[_Real, _Integers, int]: ...
def space_solve(factors: _Real, pivots: _Integers, right: _Real, /) -> _Real: ...
def space_respond(
    D: _Complex,
    G: _Complex,
    Q: _Complex,
    N: _Complex,
    fixed: NDArray[np.uint8],
    closed: bool,
    right: _Complex,
    /,
) -> _Complex: ...
def space_apply(
    D: _Complex,
    G: _Complex,
    Q: _Complex,
    N: _Complex,
    fixed: NDArray[np.uint8],
    closed: bool,
    vectors: _Complex,
    /,
) -> _Complex: ...
def space_iterate(
    D: _Complex,
    G: _Complex,
    Q: _Complex,
    N: _Complex,
    fixed: NDArray[np.uint8],
    closed: bool,
    factors: _Real,
    pivots: _Integers,
    vectors: _Real,
    times: int,
    /,
) -> tuple[_Real, _Real]: ...
def space_count(
    rope: _Space, component: _Integers, eigenvalue: _Real, scale: _Real, /
) -> _Real: ...
