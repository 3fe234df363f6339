#!/usr/bin/env python3
"""An emergency stop outlives the motor control: killed, restarted, with other settings, on a full disk, with a file that nobody can
read; until it is released."""
import contextlib
import glob
import os
import subprocess
import tempfile

from support import BINARIES, DaemonError, Process, free_port, simulated_hall, small_disk, release, wait_for


def started(folder, port, link, others={}):
    url = f"serial://{link}?baud=115200"
    settings = {"controllers.1.url": url, "controllers.2.url": url, "insecure": "true", **others}
    process = Process(BINARIES, "motorcontrol", port, folder, settings)
    motor = process.connect()
    wait_for("the controllers' answer", lambda: motor.call("motor.state")["ready"])
    return process, motor


def latches(folder):
    return [file for file in glob.glob(os.path.join(folder, "hermes", "estop", "*")) if not file.endswith(".new")]


def killed(process):
    process.process.kill()
    process.process.wait()


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.environ["XDG_STATE_HOME"] = folder
        os.environ.pop("STATE_DIRECTORY", None)
        simulator, link = simulated_hall(folder)
        simulator.connect()
        port = free_port(0)
        process, motor = started(folder, port, link)

        def is_refused():
            try:
                motor.call("control.acquire")
            except DaemonError as error:
                return "emergency stop by Anna" in str(error)
            return False

        assert not motor.call("motor.state")["latched"]
        motor.call("motor.estop", client="Anna")
        for end in ("kill", "terminate"):
            getattr(process.process, end)()
            process.process.wait()
            process, motor = started(folder, port, link)
            assert is_refused(), "the robot drives though an emergency stop was latched when its motor control ended"
            files = latches(folder)
            assert len(files) == 1, files
        again = os.path.join(folder, "again")  # the same line by another name
        os.symlink(link, again)
        for line, others in ((link, {"frame.layout": "differential"}), (again, {})):
            killed(process)
            process, motor = started(folder, port, line, others)
            assert is_refused(), f"the robot drives with other settings though an emergency stop was latched: {line}, {others}"
        release(motor)
        assert not latches(folder), "the released stop is kept"
        killed(process)
        process, motor = started(folder, port, link)
        assert not motor.call("motor.state")["latched"], "a released stop is latched again"
        killed(process)
        os.mkdir(files[0])  # nobody knows what it was
        process, motor = started(folder, port, link)
        assert "nothing is known" in motor.call("motor.state")["latched"]["estop"], motor.call("motor.state")["latched"]
        process.stop()
        disk = small_disk(folder)
        if disk:
            os.environ["XDG_STATE_HOME"] = disk
            process, motor = started(folder, port, link)
            with open(os.path.join(disk, "full"), "wb", buffering=0) as full:
                with contextlib.suppress(OSError):
                    while full.write(bytes(4096)):
                        pass
            motor.call("motor.estop", client="Anna")
            wait_for("the latch", lambda: latches(disk))
            killed(process)
            process, motor = started(folder, port, link)
            assert is_refused(), "the robot drives though an emergency stop was latched when the disk was full"
            process.stop()
            subprocess.run(["umount", "-l", disk], check=True)
        else:
            print("skipped: a stop on a full disk; no disk can be mounted here")
        os.environ["XDG_STATE_HOME"] = os.path.join(link, "no folder")
        process, motor = started(folder, port, link)
        told = wait_for("the health of the stop",
                        lambda: next((item for item in motor.call("daemon.status")["health"] if item["name"] == "stop"), None))
        assert told["level"] == "warn" and "does not outlive this program" in told["message"], told
        process.stop()
        simulator.stop()
    print("an emergency stop is kept until it is released")


if __name__ == "__main__":
    main()
