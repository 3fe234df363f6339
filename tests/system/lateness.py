"""What the machine does to everyone: stalls, and the load of others."""
import contextlib
import os
import threading
import time

NAP_S = 0.004


class Lateness:
    """How late a thread without work is woken, on each processor, while this is open: what holds up a nap of a few milliseconds
    here holds up the program under test too. How often that was more than `limit_s` is in times_over. With `goes_first` these threads
    go before all others, where that is permitted: then only the machine itself holds them up, no program."""

    def __init__(self, limit_s=0.05, goes_first=False):
        self.late_s, self.ends, self.limit_s, self.goes_first, self.times_over = {}, False, limit_s, goes_first, 0
        self.threads = [threading.Thread(target=self.watch, args=(number,)) for number in os.sched_getaffinity(0)]

    def __enter__(self):
        for thread in self.threads:
            thread.start()
        return self

    def __exit__(self, *_):
        self.ends = True
        for thread in self.threads:
            thread.join()

    def take_longest(self):
        """In seconds, since this was called last."""
        late, self.late_s = self.late_s, {}
        return max(late.values(), default=0.0)

    def watch(self, processor):
        os.sched_setaffinity(0, {processor})  # of this thread alone
        if self.goes_first:
            with contextlib.suppress(PermissionError):
                os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(os.sched_get_priority_max(os.SCHED_FIFO)))
        while not self.ends:
            due = time.monotonic() + NAP_S
            time.sleep(NAP_S)
            late, late_s = self.late_s, time.monotonic() - due
            late[processor] = max(late.get(processor, 0.0), late_s)
            self.times_over += late_s > self.limit_s
