"""What the machine does to everyone: stalls, and the load of others."""
import os
import threading
import time

NAP_S = 0.004


class Lateness:
    """How late a thread without work is woken, on each processor, while this is open: what holds up a nap of a few milliseconds
    here holds up the program under test too. It also counts in times_over how often that was more than `limit_s`."""

    def __init__(self, limit_s=0.05):
        self.late_s, self.ends, self.limit_s, self.times_over = {}, False, limit_s, 0
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
        while not self.ends:
            due = time.monotonic() + NAP_S
            time.sleep(NAP_S)
            late, late_s = self.late_s, time.monotonic() - due
            late[processor] = max(late.get(processor, 0.0), late_s)
            self.times_over += late_s > self.limit_s
