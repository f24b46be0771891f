"""The live stream's hub and what it sends."""

from __future__ import annotations

import asyncio
import json

import numpy as np

from api.decimate import Decimator
from api.hub import QUEUE_BLOCKS, Hub


def listen(publish, count: int):  # type: ignore[no-untyped-def]
    """Messages that one watcher gets, in batches, while `publish(hub)` runs first."""

    async def run() -> list[dict[str, object]]:
        hub = Hub()
        hub.bind(asyncio.get_running_loop())
        watcher = hub.join()
        publish(hub)
        found: list[dict[str, object]] = []
        while len(found) < count:
            found += [json.loads(text) for text in await watcher.next()]
        return found

    return asyncio.run(asyncio.wait_for(run(), 5.0))


def test_a_watcher_gets_blocks_in_order() -> None:
    found = listen(lambda hub: [hub.publish_block({"n": n}) for n in range(5)], 5)
    assert [message["n"] for message in found] == [0, 1, 2, 3, 4]


def test_a_slow_watcher_loses_the_oldest_blocks_and_is_told_how_many() -> None:
    found = listen(lambda hub: [hub.publish_block({"n": n}) for n in range(QUEUE_BLOCKS + 10)], QUEUE_BLOCKS + 1)
    blocks = [message["n"] for message in found if message["type"] == "block"]
    assert blocks == list(range(10, QUEUE_BLOCKS + 10))
    assert next(message for message in found if message["type"] == "dropped")["blocks"] == 10


def test_of_a_state_only_the_newest_counts() -> None:
    found = listen(lambda hub: [hub.publish_state("stand", {"n": n}) for n in range(3)], 1)
    assert found == [{"type": "stand", "n": 2}]


def test_who_joins_late_gets_the_newest_states_at_once() -> None:
    async def run() -> list[str]:
        hub = Hub()
        hub.bind(asyncio.get_running_loop())
        hub.publish_state("experiment", {"id": "a"})
        await asyncio.sleep(0)
        return await hub.join().next()

    assert [json.loads(text) for text in asyncio.run(run())] == [{"type": "experiment", "id": "a"}]


def test_who_joins_in_the_middle_of_a_run_sees_what_came_before() -> None:
    async def run() -> list[str]:
        hub = Hub()
        hub.bind(asyncio.get_running_loop())
        for n in range(200):
            hub.publish_block({"n": n})
        await asyncio.sleep(0)
        watcher = hub.join()
        hub.publish_block({"n": 200})
        return await watcher.next()

    assert [json.loads(text)["n"] for text in asyncio.run(run())][:200] == list(range(200))


def test_a_peak_of_one_sample_survives_decimation() -> None:
    values = np.zeros(64)
    values[37] = 250.0
    found = Decimator(8).push({"t": np.arange(64) / 2000, "F": values})
    assert found is not None
    assert found["F"] == [[0.0] * 8, [0, 0, 0, 0, 250.0, 0, 0, 0]]


def test_samples_that_fill_no_bucket_wait_for_the_next_block() -> None:
    decimator, t = Decimator(8), np.arange(20) / 2000
    assert decimator.push({"t": t[:5], "u": t[:5]}) is None
    found = decimator.push({"t": t[5:], "u": t[5:]})
    assert found is not None
    assert np.allclose(found["t"], [t[:8].mean(), t[8:16].mean()], atol=1e-5)


def test_what_is_no_number_is_sent_as_null() -> None:
    found = Decimator(2).push({"t": np.array([0.0, 1.0]), "u": np.array([np.nan, np.nan])})
    assert found is not None
    assert found["u"] == [[None], [None]]
