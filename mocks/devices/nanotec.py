"""A Nanotec drive as Modbus shows it: CiA 402, images at 5000 and 6000, NanoJ ring at 2000."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocks.devices.axis import BRAKE, Axis
from mocks.devices.cia402 import Command, State, after, command, statusword
from mocks.devices.dictionary import Dictionary
from mocks.devices.modes import MICRO, SPECIFIC_13, Modes
from mocks.devices.ring import Ring
from mocks.wire.canopen import ObjectError

Float = NDArray[np.float64]
Event = Callable[..., None]

RING, INPUTS, TX, RX = 2000, 3000, 5000, 6000
TX_MAP, RX_MAP = 0x3602, 0x3502
DEFAULT_TX = [0x60410010, 0x00050008, 0x60610008, 0x60640020, 0x60440010, 0x60FD0020]
DEFAULT_RX = [0x60400010, 0x00050008, 0x60600008, 0x607A0020, 0x60810020, 0x60830020, 0x60840020]
FOLLOWING_ERROR, OVERTRAVEL = 0x8611, 0x7500
_SETTINGS = (
    # index, sub, kind, value at power-up (um, um/s, um/s^2)
    (0x605A, 0, "i16", 2), (0x6060, 0, "i8", 0), (0x6065, 0, "u32", 5_000), (0x6066, 0, "u16", 10),
    (0x607A, 0, "i32", 0), (0x607C, 0, "i32", 0), (0x607D, 1, "i32", 0), (0x607D, 2, "i32", 100_000),
    (0x6081, 0, "u32", 100_000), (0x6083, 0, "u32", 1_000_000), (0x6084, 0, "u32", 1_000_000),
    (0x6085, 0, "u32", 12_000_000), (0x608F, 1, "u32", 2_000), (0x608F, 2, "u32", 1), (0x6091, 1, "u32", 1),
    (0x6091, 2, "u32", 1), (0x6092, 1, "u32", 1_000), (0x6092, 2, "u32", 1), (0x6098, 0, "i8", 35),
    (0x6099, 1, "u32", 50_000), (0x6099, 2, "u32", 5_000), (0x609A, 0, "u32", 500_000), (0x60FF, 0, "i32", 0),
    (0x60FE, 1, "u32", 0), (0x6042, 0, "i16", 0), (0x2028, 0, "u32", 1), (0x202A, 0, "u32", 115_200),
    (0x202C, 0, "u32", 1), (0x202D, 0, "u32", 0), (0x1010, 1, "u32", 0),
)  # fmt: skip
_IDENTITY = ((0x1000, 0, 0x0402_0192), (0x1018, 1, 0x26C), (0x1018, 2, 0x4D), (0x1018, 3, 0x0103), (0x1018, 4, 4711))


class NanotecDrive:
    """One drive; callers hold the stand's lock and have advanced the plant to now. event(kind, **facts) is told all."""

    def __init__(self, axis: Axis, ring: Ring, objects: Dictionary, event: Event) -> None:
        self.axis, self.ring, self.objects, self.event = axis, ring, objects, event
        self.state, self.word, self.error = State.DISABLED, 0, 0
        self.modes = Modes(axis, objects)
        self._moving = False
        self._define()

    def _define(self) -> None:
        add, live = self.objects.add, self.objects.live
        for index, sub, kind, value in _SETTINGS:
            add(index, kind, value, sub)
        for index, sub, value in _IDENTITY:
            add(index, "u32", value, sub, writable=False)
        add(0x6040, "u16")
        for index, kind, read in self._live():
            live(index, kind, read)
        for k in range(32):
            add(0x2400, "i32", 0, k + 1)
            live(0x2500, "u32", lambda k=k: self._output(k), k + 1)  # type: ignore[misc]
        self.objects.add_mapping(TX_MAP, DEFAULT_TX)
        self.objects.add_mapping(RX_MAP, DEFAULT_RX)

    def _live(self) -> tuple[tuple[int, str, Callable[[], int]], ...]:
        axis = self.axis
        return (
            (0x603F, "u16", lambda: self.error),
            (0x6041, "u16", self.statusword),
            (0x6061, "i8", lambda: self.mode),
            (0x6062, "i32", lambda: self._counts(axis.demand.state(axis.now)[0])),
            (0x6064, "i32", lambda: self._counts(float(self.ring.measure(np.array([axis.actual]))[0]))),
            (0x6044, "i16", lambda: max(-32768, min(32767, round(axis.velocity * 1e3)))),
            (0x606C, "i32", lambda: round(axis.velocity / MICRO)),
            (0x60F4, "i32", lambda: round(axis.error / MICRO)),
            (0x60FD, "u32", lambda: axis.switches),
        )

    def _counts(self, travel: float) -> int:
        return round((travel - self.modes.origin) / MICRO)

    def _output(self, k: int) -> int:
        return self.ring.count & 0xFFFFFFFF if k == 0 else int(self.ring.cells[k - 1])

    @property
    def mode(self) -> int:
        """Mode of operation."""
        return self.objects[0x6060]

    def statusword(self) -> int:
        """6041h."""
        bits = self.modes.bits(self.mode, self.word) if self.state in (State.ENABLED, State.QUICK_STOP) else 0
        bits |= SPECIFIC_13 if self.error == FOLLOWING_ERROR else 0
        return statusword(self.state, self.word, bits=bits)

    def targets(self, times: Float) -> Float:
        """What the plant's servo follows."""
        return self.axis.targets(times)

    def moved(self, times: Float, position: Float) -> None:
        """The plant's answer: ring, supervision, modes."""
        travel = self.axis.moved(times, position)
        self.ring.record(times, travel - self.modes.origin)
        if self.state is State.ENABLED:
            self._supervise()
        if self.state is State.ENABLED:
            self.modes.tick(self.mode)
        self._settle()

    def _supervise(self) -> None:
        if abs(self.axis.error) > self.modes.value(0x6065):
            self.fault(FOLLOWING_ERROR)
        elif self.axis.overrun and not self.modes.homing:
            self.fault(OVERTRAVEL)

    def _settle(self) -> None:
        moving = not self.axis.standing
        if self._moving and not moving:
            self.event("standstill")
            if self.state is State.FAULT_REACTION:
                self._go(State.FAULT)
        if not moving and self.state is State.QUICK_STOP and self.objects[0x605A] in (0, 1, 2):
            self._go(State.DISABLED)
        if not moving and self.state is State.FAULT_REACTION:
            self._go(State.FAULT)
        self._moving = moving

    def fault(self, code: int) -> None:
        """A fault: quick stop, then fault state until it is reset."""
        if self.state in (State.FAULT, State.FAULT_REACTION):
            return
        self.error = code
        self.event("fault", code=code)
        self.axis.demand.stop(self.axis.now, self.modes.rate(0x6085))
        self._go(State.FAULT_REACTION)

    def _go(self, state: State) -> None:
        self.event("state", was=self.state.name, now=state.name)
        if state is State.ENABLED or self.state is State.FAULT:
            self.modes.reset()
        self.state = state

    def control(self, word: int) -> None:
        """A controlword was written."""
        rising, falling, self.word = word & ~self.word, self.word & ~word, word
        self.event("controlword", value=word)
        if self.state is State.FAULT and rising & 0x80:
            self.error = 0
            self.axis.demand.hold(self.axis.now, self.axis.actual)
            self._go(State.DISABLED)
            return
        state = after(self.state, word)
        if state is not self.state:
            self._change(state, word)
        if self.state is State.ENABLED:
            self.modes.command(self.mode, word, rising, falling)

    def _change(self, state: State, word: int) -> None:
        option = self.objects[0x605A]
        if self.state is State.QUICK_STOP and state is State.ENABLED and option < 5:
            return
        if command(word) is Command.QUICK_STOP and self.state is State.ENABLED and option:
            self.axis.demand.stop(self.axis.now, self.modes.rate(0x6084 if option in (1, 5) else 0x6085))
        elif state is not State.ENABLED and not self.axis.standing:
            self.axis.demand.stop(self.axis.now, BRAKE)
        self._go(state)
        self._settle()

    def write_objects(self, items: list[tuple[Any, int]]) -> None:
        """Objects that arrived together are taken over, then the controlword acts. ObjectError where one is refused."""
        controlword = self.objects.entries[0x6040, 0]
        last_mode, word = self.mode, self.word
        for entry, value in items:
            entry.put(value)
            word = value if entry is controlword else word
        if self.mode != last_mode:
            self.event("mode", value=self.mode)
            self.modes.reset()
        if any(entry is controlword for entry, _ in items):
            self.control(word)
        elif self.state is State.ENABLED:
            self.modes.command(self.mode, self.word, 0, 0)

    def access(self, index: int, sub: int, data: bytes | None, length: int) -> bytes:
        """Function 43/13."""
        entry = self.objects.find(index, sub)
        if data is None:
            return entry.encode("little")
        if len(data) != entry.size:
            raise ObjectError(f"{index:04X}:{sub} has {entry.size} bytes, not {len(data)}")
        self.write_objects([(entry, entry.decode(data, "little"))])
        return b""

    def read_block(self, base: int) -> list[int] | None:
        """The live registers of the block that begins at `base`; None where they are as they were written."""
        if base == RING:
            return self.ring.registers(self.objects.word_order)
        if base == TX:
            return self.objects.image(TX_MAP)
        return self.objects.image(RX_MAP) if base == RX else None

    def write_block(self, base: int, first: int, values: list[int]) -> None:
        """Registers written at `first` of a block; ObjectError for one that is read only."""
        if base in (RING, TX):
            raise ObjectError("read only")
        if base == RX:
            self.write_objects(self.objects.take_image(RX_MAP, first, values))
