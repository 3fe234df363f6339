#!/usr/bin/env python3
"""A daemon for Hermes in plain Python 3: a fan with settings, a command, a topic and health. hermes-gui, hermesctl and
hermes-supervisor treat it like any other. What it speaks is docs/protocol.md, in hermes_daemon.py beside it."""
import time

from hermes_daemon import Daemon

fan = Daemon(
    "fan", "Fan",
    settings={  # what is checked, and what the window shows
        "speed": {"type": "number", "minimum": 0, "maximum": 1, "default": 0.3, "description": "Share of the full speed"},
        "period_s": {"type": "number", "minimum": 0.02, "maximum": 10, "unit": "s", "default": 0.1, "description": "Of messages"},
        "alarm_c": {"type": "number", "minimum": -20, "maximum": 120, "unit": "°C", "default": 60, "description": "Warns above"},
    },
    topics={"air": "Temperature and speed"})
temperature_c = 40.0
boost_until = 0.0


@fan.method("fan.boost", "Full speed for a while",
            duration_s={"type": "number", "minimum": 0.1, "maximum": 60, "unit": "s", "description": "How long"})
def boost(duration_s):
    global boost_until
    boost_until = time.time() + duration_s
    fan.log(f"full speed for {duration_s:g} s")
    return {"speed": 1}


def work():
    """One period: what the air does, and what there is to say of it."""
    global temperature_c
    speed = 1 if time.time() < boost_until else fan.settings["speed"]
    temperature_c += (80 - 50 * speed - temperature_c) * min(1, fan.settings["period_s"])
    fan.publish("air", {"temperature_c": temperature_c, "speed": speed})
    if temperature_c > fan.settings["alarm_c"]:
        fan.set_health("air", "warn", "too hot")
    else:
        fan.set_health("air", "ok", "cool enough")


if __name__ == "__main__":
    fan.run(work, port=7481)
