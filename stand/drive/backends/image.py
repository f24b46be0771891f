"""A process image for what is fast, function 43/13 for the rest (Nanotec)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from pymodbus.pdu import ModbusPDU

from stand.drive.address import Address, parse_address
from stand.drive.backends import mei13
from stand.drive.image import ImageLayout, parse_layout
from stand.drive.profile import DriveProfile
from stand.errors import DeviceError
from stand.transport import modbus
from stand.transport.link import ModbusLink


class ImageBackend:
    """The `image` back-end."""

    def __init__(self, profile: DriveProfile, link: ModbusLink) -> None:
        assert profile.image is not None, "checked when the profile was read"
        self.profile, self.link, self.image = profile, link, profile.image
        self.objects = mei13.make(profile, link)
        self.tx = self._layout(self.image.tx_map, "tx_map")
        self.rx = self._layout(self.image.rx_map, "rx_map")
        self._rx_values: dict[str, int] = {}

    def _layout(self, entries: tuple[str, ...], key: str) -> ImageLayout:
        encoding, where = self.profile.encoding, f"{self.profile.profile.name}: image.{key}"
        return parse_layout(entries, self.profile.addresses, encoding.word_order, encoding.byte_order, where)

    def setup(self) -> list[str]:
        """Write the mappings, find the orders, and take over what the drive holds now."""
        if self.image.configure_mapping:
            self._map(self.image.tx_mapping, self.tx)
            self._map(self.image.rx_mapping, self.rx)
        found = self._probe() if self.profile.encoding.probe else []
        self._rx_values = {n: self.objects.read(n) for n in self.rx.names if n != "controlword"}
        self._rx_values["controlword"] = 0
        return found

    def _map(self, index: str, layout: ImageLayout) -> None:
        def write(sub: int, value: int, bits: int) -> None:
            place = mei13.object_place(parse_address(f"{index}:{sub:x}/u{bits}"))
            self.link.transact(place.write(value))

        write(0, 0, 8)
        for sub, (_, address) in enumerate(layout.entries, start=1):
            write(sub, address.mapping, 32)
        write(0, len(layout.entries), 8)

    def _probe(self) -> list[str]:
        """Read one 32-bit and one 8-bit object both ways; the orders under which they agree are the drive's."""
        self.objects.write("mode", 1)
        probe = parse_address(self.profile.encoding.probe.object if self.profile.encoding.probe else "6064:0/i32")
        name = next((n for n, a in self.tx.entries if (a.index, a.sub) == (probe.index, probe.sub)), "")
        registers = self._read_tx()
        place = mei13.object_place(probe)
        true = {"32": place.decode(self.link.transact(place.ask)), "8": self.objects.read("mode_display")}
        word = _agreeing(self.tx, registers, name, true["32"], "word_order", probe)
        byte = _agreeing(self.tx, registers, "mode_display", true["8"], "byte_order", probe)
        self.tx, self.rx = self.tx.reordered(word, byte), self.rx.reordered(word, byte)
        return [f"word order {word}, byte order {byte}"]

    def _read_tx(self) -> Sequence[int]:
        return modbus.registers(self.link.transact(modbus.read_registers(self.image.tx, self.tx.size)))

    def has(self, name: str) -> bool:
        """Whether the profile knows the object."""
        return self.objects.has(name)

    def read(self, name: str) -> int:
        """From the image where it is mapped, else by function 43/13."""
        return self.snapshot()[name] if name in self.tx.names else self.objects.read(name)

    def write(self, name: str, value: int) -> None:
        """Through the image where it is mapped, else by function 43/13."""
        if name in self.rx.names:
            self._rx_values[name] = value
            self.link.transact(modbus.write_registers(self.image.rx, self.rx.pack(self._rx_values)))
        else:
            self.objects.write(name, value)

    def snapshot(self) -> Mapping[str, int]:
        """The whole Tx image, one request."""
        return self.tx.unpack(self._read_tx())

    def command(self, values: Mapping[str, int]) -> Mapping[str, int]:
        """The whole Rx image written and the Tx image read in one request (FC 23) where the drive has it."""
        if unmapped := set(values) - self.rx.names:
            raise DeviceError("not mapped", where="image.rx_map", value=sorted(unmapped), remedy="Map it")
        self._rx_values.update(values)
        data = self.rx.pack(self._rx_values)
        if modbus.READ_WRITE not in self.profile.link.fc:
            self.link.transact(modbus.write_registers(self.image.rx, data))
            return self.snapshot()
        request = modbus.exchange_registers(self.image.tx, self.tx.size, self.image.rx, data)
        return self.tx.unpack(modbus.registers(self.link.transact(request)))

    def quick_stop(self, value: int) -> ModbusPDU:
        """The request that writes the controlword alone."""
        if self.rx.entries[0][0] == "controlword":
            return modbus.write_register(self.image.rx, value)
        return self.objects.quick_stop(value)


def _agreeing(layout: ImageLayout, registers: Sequence[int], name: str, true: int, key: str, probe: Address) -> str:
    """The order under which the image shows the true value, or comes nearest to it (it may be moving)."""
    orders = {"word_order": layout.word_order, "byte_order": layout.byte_order}
    off = {}
    for order in (orders[key], "big", "little"):
        trial = layout.reordered(**{**orders, key: order})
        off[order] = abs(trial.unpack(registers)[name] - true)
    best = min(off, key=lambda o: (off[o], o != orders[key]))
    if off[best] > 1000:
        raise DeviceError("the image does not show the object", where=name, value=true, remedy="Check image.tx_map")
    return best


def make(profile: DriveProfile, link: ModbusLink) -> ImageBackend:
    """The back-end on a link."""
    return ImageBackend(profile, link)
