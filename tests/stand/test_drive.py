"""The drive's language, without a drive: states, images, telegrams, profiles."""

from __future__ import annotations

import struct

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pymodbus.pdu import ExceptionResponse
from pymodbus.pdu.register_message import WriteSingleRegisterResponse

from stand.config import RtuLink, TcpLink, load_stand
from stand.drive import cia402
from stand.drive.address import parse_address
from stand.drive.cia402 import State
from stand.drive.drive import quick_stop_telegrams
from stand.drive.image import parse_layout
from stand.drive.profile import load_profile, parse_profile, profile_names
from stand.errors import DeviceError, InputError
from stand.transport import modbus
from stand.transport.link import ModbusLink
from stand.transport.raw import RawRegisters
from stand.transport.ring import RingDecoder


@pytest.mark.parametrize(
    ("word", "state"),
    [
        (0x0240, State.DISABLED),
        (0x0231, State.READY),
        (0x0233, State.SWITCHED_ON),
        (0x1627 | 0x0010, State.ENABLED),
        (0x0217, State.QUICK_STOP),
        (0x021F, State.FAULT_REACTION),
        (0x0218, State.FAULT),
    ],
)
def test_a_statusword_shows_its_state(word: int, state: State) -> None:
    assert cia402.state_of(word) is state


def test_the_way_to_operation_enabled_is_shutdown_switch_on_enable_and_a_fault_has_none() -> None:
    way = [cia402.towards_enabled(s) for s in (State.DISABLED, State.READY, State.SWITCHED_ON)]
    assert way == [0x06, 0x07, 0x0F]
    assert cia402.towards_enabled(State.FAULT) is None
    assert cia402.fault_reset() == (0x00, 0x80)


def test_the_published_default_image_is_unpacked_where_the_manual_puts_it() -> None:
    profile = load_profile("nanotec-cia402")
    layout = parse_layout(profile.image.tx_map, profile.addresses, "big", "big", "tx")  # type: ignore[union-attr]
    assert layout.size == 12
    registers = [0x1627, 0x0003, *struct.unpack(">HH", struct.pack(">i", -30000)), 0, 500, 0xFFFF, 0xFFFE, 0, 0, 0, 7]
    values = layout.unpack(registers)
    assert values["statusword"] == 0x1627
    assert values["mode_display"] == 3
    assert values["position"] == -30000
    assert values["velocity"] == 500
    assert values["following_error"] == -2
    assert values["digital_inputs"] == 7


@settings(deadline=None)  # a busy machine
@given(
    position=st.integers(-(2**31), 2**31 - 1),
    mode=st.integers(-128, 127),
    word_order=st.sampled_from(["big", "little"]),
    byte_order=st.sampled_from(["big", "little"]),
)
def test_an_image_packed_in_any_order_is_unpacked_alike(
    position: int, mode: int, word_order: str, byte_order: str
) -> None:
    profile = load_profile("nanotec-cia402")
    layout = parse_layout(profile.image.rx_map, profile.addresses, word_order, byte_order, "rx")  # type: ignore[union-attr]
    values = {"controlword": 0x0F, "mode": mode, "target_position": position}
    back = layout.unpack(layout.pack(values))
    assert {name: back[name] for name in values} == values


def test_a_value_that_does_not_fit_is_refused_and_never_clipped() -> None:
    with pytest.raises(InputError, match="does not fit 8 bits"):
        parse_address("6060:0/i8").encode(200)


def test_the_vendors_sample_telegrams_come_out_byte_for_byte() -> None:
    link = ModbusLink(TcpLink(unit_id=0))
    read = link.telegram(modbus.read_object(0x6041, 0, 2))
    assert read[2:] == bytes.fromhex("00000000000d002b0d0000006041000000 0002".replace(" ", ""))[2:]
    write = link.telegram(modbus.write_object(0x6040, 0, b"\x06\x00"))
    assert write[2:] == bytes.fromhex("00000000000f002b0d01000060400000000002 0600".replace(" ", ""))[2:]
    reply = modbus.ObjectAnswer()
    reply.decode(bytes.fromhex("0d00000060410000000002 2716".replace(" ", "")))
    assert parse_address("6041:0/u16").decode(modbus.object_data(reply)) == 0x1627


def test_a_published_rtu_telegram_has_the_published_checksum() -> None:
    telegram = bytes.fromhex("07106200000810000100002710000027102710000000108d50")
    link = ModbusLink(RtuLink(kind="rtu", port="x", unit_id=7))
    values = [0x0001, 0x0000, 0x2710, 0x0000, 0x2710, 0x2710, 0x0000, 0x0010]
    assert link.telegram(modbus.write_registers(0x6200, values)) == telegram


def test_a_refusal_names_its_reason_and_a_strangers_answer_is_not_taken() -> None:
    asked = modbus.read_registers(1, 1)
    with pytest.raises(DeviceError, match="function 3 at register 1: illegal data address"):
        modbus.check_answer(asked, ExceptionResponse(3, 2), "drive")
    with pytest.raises(DeviceError, match="another question"):
        modbus.check_answer(asked, WriteSingleRegisterResponse(registers=[0]), "drive")


def test_the_quick_stop_is_one_complete_telegram_on_either_link() -> None:
    stand = load_stand()
    (tcp,) = quick_stop_telegrams(stand)
    assert tcp == bytes.fromhex("000100000006010617700002")
    rtu = stand.model_copy(update={"drive": stand.drive.model_copy(update={"link": RtuLink(kind="rtu", port="x")})})
    (serial,) = quick_stop_telegrams(rtu)
    assert serial[:-2] == bytes.fromhex("010617700002")
    assert serial == ModbusLink(RtuLink(kind="rtu", port="x")).telegram(modbus.write_register(6000, 2))


def test_every_profile_in_the_folder_loads_and_can_stop_its_drive() -> None:
    stand = load_stand()
    assert {"nanotec-cia402", "mr-je-c", "igus-d1", "lxm32m"} <= set(profile_names())
    for name in profile_names():
        assert load_profile(name).profile.source
        drive = stand.drive.model_copy(update={"profile": name})
        assert quick_stop_telegrams(stand.model_copy(update={"drive": drive}))


def test_a_bad_profile_is_refused_with_its_key() -> None:
    with pytest.raises(InputError, match=r"mine\.toml: encoding\.backend"):
        parse_profile('[profile]\nname="a"\nvendor="b"\nsource="c"\n[encoding]\nbackend="psychic"\n', "mine.toml")


def _poll(head: int, samples: dict[int, int], order: str = "big") -> RawRegisters:
    """A read of the ring after `head` samples; samples: by number, 0 where it is none of them."""
    cells = [0] * 60
    for k in range(head - 60, head):
        cells[k % 60] = max(-32768, min(32767, samples.get(k, 0) - samples.get(k - 1, 0)))
    text = struct.pack(">Ii60h", head % 2**32, samples.get(head - 1, 0), *cells)
    words = np.frombuffer(text, ">u2").astype(np.uint16).reshape(-1, 2)
    return RawRegisters("drive", (words if order == "big" else words[:, ::-1]).reshape(-1), 1.0, 1.001)


@pytest.mark.parametrize("order", ["big", "little"])
def test_the_ring_gives_each_counted_sample_once_and_survives_the_counters_wrap(order: str) -> None:
    decoder = RingDecoder(load_profile("nanotec-cia402"))
    decoder.swap = order == "little"
    top = 2**32
    samples = {top - 3: 310_000, top - 2: 300_000, top - 1: 299_999, top: 300_007}
    decoder.decode(_poll(top - 2, samples, order))
    block = decoder.decode(_poll(top + 1, samples, order))
    assert block is not None
    assert block.ticks is not None
    assert block.ticks.tolist() == [top - 2, top - 1, top]
    assert block.values.tolist() == pytest.approx([0.03, 0.0299999, 0.0300007])
    assert block.request == 1.0
    assert decoder.decode(_poll(top + 1, samples, order)) is None


def test_a_jump_of_the_drives_zero_spoils_no_sample_after_it() -> None:
    decoder = RingDecoder(load_profile("nanotec-cia402"))
    samples = {k: 900_000 + k for k in range(200)} | {k: k for k in range(200, 260)}
    decoder.decode(_poll(190, samples))
    for head in (205, 230, 255):
        block = decoder.decode(_poll(head, samples))
        assert block is not None
        assert block.ticks is not None
        after = block.ticks >= 200
        assert block.values[after] == pytest.approx(block.ticks[after] * 1e-7)


def test_a_ring_whose_slots_hold_positions_is_read_as_such() -> None:
    profile = load_profile("nanotec-cia402")
    plain = profile.trace.model_copy(update={"newest": None, "base": 2002, "depth": 31, "record": "i32"})
    decoder = RingDecoder(profile.model_copy(update={"trace": plain}))
    cells = [0] * 31
    for k in range(70, 100):
        cells[k % 31] = 300_000 - k
    words = np.frombuffer(struct.pack(">I31i", 100, *cells), ">u2").astype(np.uint16)
    decoder.head = 70
    block = decoder.decode(RawRegisters("drive", words, 1.0, 1.001))
    assert block is not None
    assert block.values == pytest.approx((300_000 - np.arange(70, 100)) * 1e-7)


def test_plain_slots_of_16_bits_keep_their_places_where_longer_numbers_are_turned() -> None:
    profile = load_profile("nanotec-cia402")
    plain = profile.trace.model_copy(update={"newest": None, "base": 2002, "depth": 4, "record": "i16"})
    decoder = RingDecoder(profile.model_copy(update={"trace": plain}))
    decoder.swap, decoder.head = True, 65_537
    words = np.array([3, 1, 400, 100, 200, -300], np.int16).view(np.uint16)  # head 1 << 16 | 3, its low word first
    block = decoder.decode(RawRegisters("drive", words, 1.0, 1.001))
    assert block is not None
    assert block.values == pytest.approx([100e-7, 200e-7])


def test_samples_that_the_ring_overwrote_are_counted() -> None:
    decoder = RingDecoder(load_profile("nanotec-cia402"))
    decoder.decode(_poll(100, {}))
    block = decoder.decode(_poll(179, {}))
    assert block is not None
    assert len(block) == 60
    assert decoder.overrun == 19
