"""Tasks of Dask that survive the loss of their machines."""

from __future__ import annotations

import dataclasses
import importlib
import queue
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Optional

from ._errors import Error

#: How often a task may lose its machine: more often, and the task is probably the reason.
_MOST_LOSSES = 10
_PARTS_PER_WORKER = 2  # one is rendered, and the next one is there when it ends


def dask(client: Any) -> Any:
    """The package distributed. Raises Error if it is missing, or if this is no client of it that can be used here."""
    try:
        package = importlib.import_module("distributed")
    except ImportError as e:
        raise Error(f"renders over many machines need Dask: pip install etendue[distributed] ({e})") from None
    if not isinstance(client, package.Client):
        raise Error(f"client is a dask.distributed.Client, not {client!r}")
    if client.asynchronous:
        raise Error("client is asynchronous: make it by Client(…) without asynchronous=True, outside of a coroutine")
    if client.status != "running":
        raise Error(f"the client is not connected to a scheduler: it is {client.status}")
    return package


@dataclass
class _Task:
    what: Any  # what the caller calls it by
    submit: Callable[[], Any]
    losses: int = 0


class Sent:
    """A dataclass, such as a SentJob, as the result of a task of its own, which each worker fetches once."""

    def __init__(self, client: Any, content: Any) -> None:
        self._client = client
        self._content = content
        self._future: Any = None

    def future(self) -> Any:
        # Workers that are lost while they have the content may take its task along.
        if self._future is None or self._future.status in ("error", "lost", "cancelled"):
            fields = [getattr(self._content, field.name) for field in dataclasses.fields(self._content)]
            self._future = self._client.submit(type(self._content), *fields, pure=False)
        return self._future


class Tasks:
    """Tasks under way. There are few for each worker, so that results do not pile up, and each result is released once it is here."""

    def __init__(self, client: Any) -> None:
        self._package = dask(client)
        self._client = client
        self._under_way: dict[Any, _Task] = {}
        self._done: queue.SimpleQueue[Any] = queue.SimpleQueue()

    @property
    def workers(self) -> int:
        """Processes, at least 1: without any the tasks wait for the first one to come."""
        return max(1, len(self._client.scheduler_info(n_workers=-1)["workers"]))

    @property
    def wanted(self) -> bool:
        """Whether the workers could do with one more."""
        return len(self._under_way) < _PARTS_PER_WORKER * self.workers

    def __len__(self) -> int:
        return len(self._under_way)

    def submit(self, what: Any, function: Callable[..., Any], sent: Sent, *arguments: Any) -> None:
        """Submits function(content, …)."""
        self._begin(_Task(what, lambda: self._client.submit(function, sent.future(), *arguments, pure=False)))

    def _begin(self, task: _Task) -> None:
        future = task.submit()
        self._under_way[future] = task
        future.add_done_callback(self._done.put)

    def next(self, seconds: float) -> Optional[tuple[Any, Any]]:
        """What was submitted, and its result; None: nothing has arrived for this time. Raises the task's exception."""
        try:
            future = self._done.get(timeout=seconds)
        except queue.Empty:
            return None
        task = self._under_way.pop(future)
        try:
            result = future.result()
        except self._package.KilledWorker:
            task.losses += 1
            if task.losses >= _MOST_LOSSES:
                raise Error(
                    f"{task.what}: every worker that began it was lost, {task.losses} times in a row: "
                    "their logs say why (memory is the usual reason)"
                ) from None
            self._begin(task)
            return None
        except ModuleNotFoundError as e:
            raise Error(f"a worker has no module {e.name}: install the package there, in the version of the client") from None
        except Exception as e:
            if type(e).__name__ in ("FutureCancelledError", "CancelledError"):
                raise Error("the parts under way were cancelled, or the scheduler was lost; what has arrived is kept") from None
            raise
        finally:
            future.release()
        return task.what, result

    def cancel(self) -> None:
        """Withdraws all that is under way; the workers abort it."""
        if self._under_way and self._client.status == "running":
            self._client.cancel(list(self._under_way))
        self._under_way.clear()
