#!/usr/bin/env python3
"""An emergency stop outlives the motor control: killed, restarted, with a file that nobody can read; until it is released."""
import glob
import os
import tempfile

from support import BINARIES, DaemonError, Process, free_port, simulated_hall, release, wait_for


def started(folder, port, link):
    url = f"serial://{link}?baud=115200"
    process = Process(BINARIES, "motorcontrol", port, folder, {"controllers.1.url": url, "controllers.2.url": url, "insecure": "true"})
    motor = process.connect()
    wait_for("the controllers' answer", lambda: motor.call("motor.state")["ready"])
    return process, motor


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
            files = glob.glob(os.path.join(folder, "hermes", "estop", "*"))
            assert len(files) == 1, files
        release(motor)
        assert not glob.glob(os.path.join(folder, "hermes", "estop", "*")), "the released stop is kept"
        process.process.kill()
        process.process.wait()
        os.mkdir(files[0])  # nobody knows what it was
        process, motor = started(folder, port, link)
        assert "nothing is known" in motor.call("motor.state")["latched"]["estop"], motor.call("motor.state")["latched"]
        process.stop()
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
