"""The operator's window beside the demo, where there is a display."""
import os
import subprocess
import sys

from processes import die_with


def has_display():
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


class Window:
    """A running hermes-gui that is connected to daemons of this machine."""

    def __init__(self, binaries, ports, folder, shows_all):
        self.log_name = os.path.join(folder, "gui.log")
        command = [os.path.join(binaries, "hermes-gui")]
        for port in ports:
            command += ["--connect", f"127.0.0.1:{port}"]
        command += ["--whole-map"] if shows_all else []
        print("  opening hermes-gui", flush=True)
        with open(self.log_name, "w", encoding="utf-8") as log:
            parent = os.getpid()
            self.process = subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                                            start_new_session=True, preexec_fn=lambda: die_with(parent))

    def stay(self, message):
        """Until the window is closed, or Ctrl-C; at once when it is closed already or could not be opened."""
        if self.process.poll() is None:
            print(message, flush=True)
            try:
                self.process.wait()
            except KeyboardInterrupt:
                pass
        if (self.process.poll() or 0) > 0:
            with open(self.log_name, encoding="utf-8", errors="replace") as log:
                print(f"  hermes-gui ended with status {self.process.returncode}: {log.read()[-500:].strip()}", file=sys.stderr)

    def stop(self):
        if self.process.poll() is None:
            self.process.terminate()
            self.process.wait()
