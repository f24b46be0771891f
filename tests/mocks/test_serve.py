"""The simulated stand as a process, met on real TCP and pseudo-terminals."""

from __future__ import annotations

import struct
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pymodbus.client import ModbusSerialClient, ModbusTcpClient

from mocks.ledger import DROPPED, SPOILT, read_events, read_samples
from tests.mocks.serving import command, exchange, opened, process

CONFIG = """
seed = 5
[force_gauge]
drift_ppm = 30.0
[dial_gauge]
drift_ppm = -40.0
zero = 0.025
"""


@pytest.fixture(scope="module")
def stand(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, Any]]:
    folder = tmp_path_factory.mktemp("stand")
    (folder / "stand.toml").write_text(CONFIG)
    with process("serve", folder / "stand.toml", "--ledger", folder / "ledger") as announcement:
        yield announcement


@pytest.fixture(scope="module")
def link(stand: dict[str, Any]) -> Iterator[ModbusTcpClient]:
    host, _, port = stand["drive"]["tcp"].rpartition(":")
    client = ModbusTcpClient(host, port=int(port), retries=0)
    assert client.connect()
    yield client
    client.close()


def force_values(data: bytes) -> np.ndarray:
    """Values of the whole frames from the first one on."""
    start = next(i for i in range(8) if data[i] == 0xAA and data[i + 1] == 0x10 and data[i + 7] == 0x85)
    frames = np.frombuffer(data[start : start + (len(data) - start) // 8 * 8], np.uint8).reshape(-1, 8)
    assert np.all(frames[:, [0, 1, 7]] == (0xAA, 0x10, 0x85))
    return frames[:, 3:7].copy().view(">f4").ravel().astype(np.float64)


def dial_values(data: bytes) -> np.ndarray:
    """Values in m of the whole lines."""
    lines = data.split(b"\r")[1:-1]
    assert all(len(line) == 14 and line.startswith(b"%01$") for line in lines)
    return np.array([int(line[4:12]) for line in lines]) * 1e-7


def among(values: np.ndarray, ledger: np.ndarray) -> np.ndarray:
    """The ledger's rows that hold just these values, in this order."""
    for first in np.flatnonzero(np.isclose(ledger["value"], values[0], rtol=0, atol=1e-12)):
        rows = ledger[first : first + len(values)]
        if len(rows) == len(values) and np.allclose(rows["value"], values, rtol=0, atol=1e-12):
            return rows
    raise AssertionError("the ledger has no such stretch")


def until(found: Callable[[], Any], what: str) -> Any:
    """What `found` returns once it is something."""
    end = time.monotonic() + 10.0
    while (value := found()) is None:
        assert time.monotonic() < end, what
        time.sleep(0.02)
    return value


def until_written(stand: dict[str, Any], device: str, count: int | np.ndarray) -> np.ndarray:
    """The ledger once it holds so many rows, or values such as the last of these."""

    def rows() -> np.ndarray | None:
        if not (Path(stand["ledger"]) / f"{device}.bin").exists():
            return None
        found = read_samples(stand["ledger"], device)
        if isinstance(count, int):
            return found if len(found) >= count else None
        tail = found["value"][-len(count) - 4000 :]
        last = np.flatnonzero(np.isclose(tail, count[-1], rtol=0, atol=1e-12))
        return (
            found
            if any(np.allclose(tail[max(i - 9, 0) : i + 1], count[-10:], rtol=0, atol=1e-12) for i in last if i > 8)
            else None
        )

    found: np.ndarray = until(rows, f"the rows of {device} are not written")
    return found


@pytest.mark.parametrize(("gauge", "read", "size"), [("force_gauge", force_values, 8), ("dial_gauge", dial_values, 15)])
def test_every_sample_sent_is_in_the_ledger_and_none_leaves_early(
    stand: dict[str, Any], gauge: str, read: Any, size: int
) -> None:
    with opened(stand[gauge]["port"]) as port:
        values = read(port.read_bytes(1600 * size))
        rows = among(values, until_written(stand, gauge, values))
    assert np.all(np.diff(rows["counter"].astype(np.int64)) == 1)
    latency = stand["latency"][gauge] - stand["latency"]["port"]  # of the device alone
    earliest = rows["handed"] - rows["true_time"] - latency
    assert earliest.min() >= -1e-9
    assert earliest.min() < 5e-3


def test_the_gauges_samples_are_taken_2000_times_a_second_of_their_own_clocks(stand: dict[str, Any]) -> None:
    for gauge, drift in (("force_gauge", 30e-6), ("dial_gauge", -40e-6)):
        with opened(stand[gauge]["port"]) as port:
            port.read_bytes(2000)
        rows = until_written(stand, gauge, 200)
        rate = (rows["counter"][-1] - rows["counter"][0]) / (rows["true_time"][-1] - rows["true_time"][0])
        assert rate == pytest.approx(2000.0 * (1.0 + drift), rel=1e-9)


def test_at_rest_the_gauges_show_the_weights_pull_and_their_own_zero(stand: dict[str, Any]) -> None:
    with opened(stand["force_gauge"]["port"]) as port:
        assert force_values(port.read_bytes(4000)).mean() == pytest.approx(15.186, abs=3.2)
    with opened(stand["dial_gauge"]["port"]) as port:
        assert dial_values(port.read_bytes(6000)).mean() == pytest.approx(0.025, abs=2e-3)


def test_the_stream_goes_on_while_commands_are_answered(stand: dict[str, Any]) -> None:
    with opened(stand["force_gauge"]["port"]) as port:
        port.read_bytes(80)
        reply = bytes.fromhex("aa540044fa000085")
        data = port.ask(bytes.fromhex("aa908a85"), lambda d: reply in d and len(d) > 10 * len(reply))
        assert b"\xaa\x10\xb0" in data.replace(reply, b"")
    with opened(stand["dial_gauge"]["port"]) as port:
        port.read_bytes(150)
        assert b"%01$RMD+" in port.ask(b"%01#RMD**\r", lambda d: b"$RMD" in d and d.endswith(b"\r"))


def test_the_drive_moves_by_its_image_and_the_ring_follows(stand: dict[str, Any], link: ModbusTcpClient) -> None:
    for word in (0x06, 0x07, 0x0F):
        assert not link.write_registers(6000, [word, 1]).isError()
    assert not link.write_registers(6000, [0x0F, 1, 0, 30_800, *divmod(200_000, 65536)]).isError()
    link.write_register(6000, 0x3F)
    end = time.monotonic() + 5.0
    while not (image := link.read_holding_registers(5000, count=7).registers)[0] & 0x0400:
        assert time.monotonic() < end
    assert image[2] << 16 | image[3] == pytest.approx(30_800, abs=30)
    head = link.read_input_registers(2000, count=4).registers
    count, newest = head[0] << 16 | head[1], head[2] << 16 | head[3]
    assert newest * 0.1 == pytest.approx(30_800, abs=30)
    rows = until_written(stand, "drive", int(count))
    assert rows["value"][count - 1] == pytest.approx(newest * 1e-7, abs=1e-12)


def test_a_ring_read_is_of_the_moment_of_its_processing(stand: dict[str, Any], link: ModbusTcpClient) -> None:
    asked, counts, told = [], [], []
    for _ in range(60):
        asked.append(time.monotonic())
        head = link.read_holding_registers(2000, count=2).registers
        told.append(time.monotonic())
        counts.append(head[0] << 16 | head[1])
    rows = until_written(stand, "drive", counts[-1] + 2)
    newest, following = rows["true_time"][np.array(counts) - 1], rows["true_time"][np.array(counts)]
    assert np.all(newest <= np.array(told))
    assert np.all(following >= np.array(asked) - 51e-6)


def test_the_statusword_answers_the_published_telegram(stand: dict[str, Any]) -> None:
    answer = exchange(stand, bytes.fromhex("00000000000d002b0d0000006041000000" + "0002"))
    assert answer[:19] == bytes.fromhex("00000000000f002b0d0000006041000000" + "0002")
    assert len(answer) == 21


def test_an_object_is_written_little_endian_and_read_back(stand: dict[str, Any]) -> None:
    write = bytes.fromhex("000700000011012b0d0100006085000000" + "0004") + struct.pack("<I", 9_000_000)
    assert exchange(stand, write)[:8].hex() == "00070000000d012b"
    read = bytes.fromhex("00080000000d012b0d0000006085000000" + "0004")
    assert struct.unpack("<I", exchange(stand, read)[-4:]) == (9_000_000,)
    assert exchange(stand, bytes.fromhex("00090000000d012b0d0000001234000000" + "0002"))[7:] == b"\xab\x02"


def test_wrong_requests_are_refused(link: ModbusTcpClient) -> None:
    assert link.read_holding_registers(4000, count=1).exception_code == 2
    assert link.write_register(5000, 1).exception_code == 2
    assert link.read_coils(5000, count=1).exception_code == 1


def test_the_same_drive_answers_on_the_serial_bus(stand: dict[str, Any], link: ModbusTcpClient) -> None:
    serial = ModbusSerialClient(stand["drive"]["rtu"], baudrate=stand["drive"]["rtu_baud"], retries=0, timeout=2)
    assert serial.connect()
    registers = serial.read_holding_registers(5000, count=7).registers
    assert registers[2:4] == pytest.approx(link.read_holding_registers(5002, count=2).registers, abs=20)
    serial.close()


def test_faults_can_be_brought_about(stand: dict[str, Any]) -> None:
    with opened(stand["force_gauge"]["port"]) as port:
        port.read_bytes(400)
        assert command(stand, "drop force_gauge 3") == "ok"
        assert command(stand, "corrupt force_gauge 2") == "ok"
        port.read_bytes(len(port.data) + 8 * 1500)

    def counted() -> tuple[int, int] | None:
        flags = read_samples(stand["ledger"], "force_gauge")["flags"]
        found = int(np.count_nonzero(flags & DROPPED)), int(np.count_nonzero(flags & SPOILT))
        return found if found[1] else None

    assert until(counted, "nothing is spoilt") == (3, 2)


def test_an_overload_shows_in_the_frames_and_passes(stand: dict[str, Any]) -> None:
    with opened(stand["force_gauge"]["port"]) as port:
        assert command(stand, "overload force_gauge 0.1") == "ok"
        port.read_until(lambda: b"\xaa\x10\xb1" in port.data)
        port.data.clear()
        port.read_until(lambda: b"\xaa\x10\xb0" in port.data)


def test_a_silent_gauge_leaves_a_gap_and_comes_back(stand: dict[str, Any]) -> None:
    with opened(stand["dial_gauge"]["port"]) as port:
        port.read_bytes(300)
        assert command(stand, "silence dial_gauge 0.3") == "ok"
        port.read_bytes(len(port.data) + 15 * 400)

    def dropped() -> int | None:
        rows = read_samples(stand["ledger"], "dial_gauge")
        gap = np.flatnonzero(rows["flags"] & DROPPED)
        return len(gap) if len(gap) and gap[-1] < len(rows) - 1 else None

    assert until(dropped, "no gap") >= 599


def test_a_broken_line_hangs_up_and_the_port_returns(stand: dict[str, Any]) -> None:
    with opened(stand["dial_gauge"]["port"]) as port:
        port.read_bytes(300)
        assert command(stand, "disconnect dial_gauge 0.2") == "ok"
        with pytest.raises(OSError, match=r"hung up|Input/output error"):
            port.read_bytes(10**9)
    end = time.monotonic() + 3.0
    while not Path(stand["dial_gauge"]["port"]).exists():
        assert time.monotonic() < end
    with opened(stand["dial_gauge"]["port"]) as port:
        assert dial_values(port.read_bytes(600)).mean() == pytest.approx(0.025, abs=2e-3)


def test_a_drive_fault_is_in_the_statusword_and_in_the_events(stand: dict[str, Any], link: ModbusTcpClient) -> None:
    assert command(stand, "fault drive 0x7305") == "ok"
    assert link.read_holding_registers(5000, count=1).registers[0] & 0x4F == 0x08
    link.write_registers(6000, [0x00])
    link.write_registers(6000, [0x80])
    assert link.read_holding_registers(5000, count=1).registers[0] & 0x4F == 0x40

    def told() -> dict[str, Any] | None:
        return next((e for e in read_events(stand["ledger"]) if e["kind"] == "fault" and e["code"] == 0x7305), None)

    assert until(told, "the fault is not among the events")


def test_an_unknown_command_is_told_what_there_is(stand: dict[str, Any]) -> None:
    assert "drop GAUGE FRAMES" in command(stand, "explode")
    assert command(stand, "drop scale 3").startswith("error")


def test_the_vendors_library_reads_the_force_gauge(stand: dict[str, Any]) -> None:
    gsv86 = pytest.importorskip("gsv86lib").gsv86
    device = gsv86(stand["force_gauge"]["port"], 230_400)
    try:
        assert device.readDataRate() == pytest.approx(2000.0)
        device.StartTransmission()
        values: list[float] = []
        end = time.monotonic() + 10.0
        while len(values) < 300:
            assert time.monotonic() < end
            values += [frame[1]["channel0"] for frame in device.ReadMultiple()]
    finally:
        device.serialReadThread.stop()
        device.router.stop()
    assert np.mean(values) == pytest.approx(15.186, abs=3.2)


def test_a_wrong_configuration_is_refused_with_its_place(tmp_path: Path) -> None:
    (tmp_path / "stand.toml").write_text("[force_gauge]\nbaudrate = 9600\n")
    with (
        pytest.raises(AssertionError, match=r"force_gauge.baudrate: unknown key .got 9600.*There are baud"),
        process("serve", tmp_path / "stand.toml"),
    ):
        pass
