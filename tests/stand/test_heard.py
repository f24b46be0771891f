"""When an answer came is the network's word, not that of a reader who was kept from reading."""

from __future__ import annotations

import socket
import threading
import time

import pytest

from stand.config import TcpLink
from stand.errors import DeviceError
from stand.transport.clients import PromptTcp
from stand.transport.heard import ask_for_stamps
from stand.transport.link import ModbusLink
from stand.transport.modbus import read_registers

ANSWER = bytes.fromhex("0001 0000 0005 01 03 02 1234")


def _drive(listener: socket.socket, sent: list[float], answer: bytes) -> None:
    link, _ = listener.accept()
    with link:
        question = link.recv(64)
        sent.append(time.monotonic())
        link.sendall(question[:2] + answer[2:] if answer else b"")


def _asked(answer: bytes) -> tuple[float, float, float]:
    """When the answer was sent, when it is said to have come, and when the reader was back, s."""
    sent: list[float] = []
    stamping = socket.socket()  # the kernel begins to stamp some time after the first socket asked for it
    ask_for_stamps(stamping)
    time.sleep(0.05)
    with socket.create_server(("127.0.0.1", 0)) as listener:
        drive = threading.Thread(target=_drive, args=(listener, sent, answer), daemon=True)
        drive.start()
        link = ModbusLink(TcpLink(host="127.0.0.1", port=listener.getsockname()[1], timeout=2.0))
        with link:
            try:
                _, _, received = link.stamped(read_registers(0, 1))
            finally:
                drive.join()
    stamping.close()
    return sent[0], received, time.monotonic()


def test_a_reader_that_comes_late_still_tells_when_the_answer_came(monkeypatch: pytest.MonkeyPatch) -> None:
    prompt = PromptTcp.recv

    def late(client: PromptTcp, size: int | None) -> bytes:
        time.sleep(0.05)
        return prompt(client, size)

    monkeypatch.setattr(PromptTcp, "recv", late)
    sent, received, back = _asked(ANSWER)
    assert back - sent > 0.045
    assert -1e-4 < received - sent < 0.03


def test_a_drive_that_hangs_up_is_told_as_such() -> None:
    with pytest.raises(DeviceError, match="the connection was closed"):
        _asked(b"")
