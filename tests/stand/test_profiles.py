"""Each published drive's profile against a controller of its map, over real TCP."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from stand.config import DriveConfig, Limits, TcpLink
from stand.drive.cia402 import State
from stand.drive.drive import Drive
from stand.drive.follow import follow
from stand.drive.profile import load_profile
from stand.errors import DeviceError
from stand.excitation.plan import plan
from stand.excitation.spec import Excitation, Shape
from stand.guardian.watch import Line, stop_drive
from tests.stand.controller import Controller

#: profile -> metres of one count, as its manual says
DRIVES = {"mr-je-c": 1e-6, "igus-d1": 1e-5, "lxm32m": 1e-6}
Pair = tuple[Drive, Controller]


@pytest.fixture(params=DRIVES)
def pair(request: pytest.FixtureRequest) -> Iterator[Pair]:
    profile = load_profile(request.param)
    with Controller(profile.encoding.backend, DRIVES[request.param]) as controller:
        link = TcpLink(port=controller.port, unit_id=profile.link.unit_id)
        drive = Drive(DriveConfig(profile=request.param, link=link, rate=1000.0), Limits())
        with drive:
            yield drive, controller


def test_it_is_enabled_moved_read_stopped_and_reset(pair: Pair) -> None:
    drive, controller = pair
    drive.enable()
    assert drive.status().state is State.ENABLED
    assert drive.move_to(0.012, speed=0.2) == pytest.approx(0.012, abs=1e-5)
    assert controller.axis.position * controller.axis.scale == pytest.approx(0.012, abs=1e-5)
    drive.quick_stop()
    assert drive.status().state is State.QUICK_STOP
    controller.axis.fault(0x2310)
    assert drive.status().fault_code == 0x2310
    with pytest.raises(DeviceError, match="0x2310"):
        drive.enable()
    drive.fault_reset()
    assert drive.status().state is State.DISABLED
    drive.enable()
    assert drive.status().travel == pytest.approx(0.012, abs=1e-5)


def test_it_follows_a_planned_motion_by_its_velocity(pair: Pair) -> None:
    drive, controller = pair
    motion = plan(Excitation(Shape.TRAPEZOIDAL, 4.0, 0.005, 0.12, cycles=1), Limits())
    quick = type(motion)(motion.excitation, motion.curve, motion.rest_travel, rest=0.05)
    done = follow(drive, quick)
    assert done.complete
    assert done.worst < 2e-3
    assert controller.axis.position * controller.axis.scale == pytest.approx(0.0, abs=1e-3)


def test_the_guardians_bare_telegram_stops_it(pair: Pair) -> None:
    drive, controller = pair
    drive.enable()
    line = Line({"kind": "tcp", "host": "127.0.0.1", "port": controller.port})
    telegram = drive.link.telegram(drive.backend.quick_stop(drive.profile.quickstop.value))
    assert stop_drive(line, [telegram], give_up=1.0)[1] is not None
    line.close()
    assert controller.axis.state.name == "QUICK_STOP"
