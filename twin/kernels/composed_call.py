"""Calling a compiled hook by its address: causes are composed at run time, nothing is compiled for a composition.

A first-class function in numba carries two views of an array through every call (fourteen words); a C callback over two
bare pointers costs half of that and any number of them fits one int64 array.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic

_VECTOR = types.CPointer(types.float64)
#: hook of the dynamics: (work vector q, the cause's constants p)
DYNAMICS = types.void(_VECTOR, _VECTOR)
#: hook on a signal: (position y, force y, simulated [n, 5], about [n, dt, time of the first sample, run], p)
SENSOR = types.void(_VECTOR, _VECTOR, _VECTOR, _VECTOR, _VECTOR)
#: hook on the drive: (x, x', about [n, dt], p) over a whole run, in place
INPUT = types.void(_VECTOR, _VECTOR, _VECTOR, _VECTOR)


def _data(context: Any, builder: Any, kind: Any, value: Any) -> Any:
    return context.make_array(kind)(context, builder, value).data


def _row(context: Any, builder: Any, kind: Any, value: Any, row: Any) -> Any:
    array = context.make_array(kind)(context, builder, value)
    return builder.gep(array.data, [builder.mul(row, builder.extract_value(array.shape, 1))])


def _call(builder: Any, address: Any, pointers: list[Any]) -> None:
    signature = ir.FunctionType(ir.VoidType(), [p.type for p in pointers])
    builder.call(builder.inttoptr(address, signature.as_pointer()), pointers)


@intrinsic
def call_dynamics(typingctx: Any, address: Any, q: Any, p: Any, row: Any) -> Any:
    """Call the DYNAMICS hook at `address` with q and row `row` of p."""
    signature = types.void(types.int64, q, p, types.int64)

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        pointers = [
            _data(context, builder, sig.args[1], args[1]),
            _row(context, builder, sig.args[2], args[2], args[3]),
        ]
        _call(builder, args[0], pointers)
        return context.get_dummy_value()

    return signature, codegen


@intrinsic
def call_sensor(
    typingctx: Any, address: Any, position: Any, force: Any, simulated: Any, about: Any, p: Any, row: Any
) -> Any:
    """Call the SENSOR hook at `address` with row `row` of p."""
    signature = types.void(types.int64, position, force, simulated, about, p, types.int64)

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        pointers = [_data(context, builder, sig.args[k], args[k]) for k in range(1, 5)]
        pointers.append(_row(context, builder, sig.args[5], args[5], args[6]))
        _call(builder, args[0], pointers)
        return context.get_dummy_value()

    return signature, codegen


@intrinsic
def call_input(typingctx: Any, address: Any, x: Any, speed: Any, about: Any, p: Any, row: Any) -> Any:
    """Call the INPUT hook at `address` with row `row` of p."""
    signature = types.void(types.int64, x, speed, about, p, types.int64)

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        pointers = [_data(context, builder, sig.args[k], args[k]) for k in range(1, 4)]
        pointers.append(_row(context, builder, sig.args[4], args[4], args[5]))
        _call(builder, args[0], pointers)
        return context.get_dummy_value()

    return signature, codegen
