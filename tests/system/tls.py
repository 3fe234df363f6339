#!/usr/bin/env python3
"""TLS: clients with no certificate, a foreign, expired, revoked or daemon's one, plain bytes, TLS on a plain port, handshakes that
stop half way: each is refused with the reason in the log, and others are served all the same. Keys made by hermesctl keys."""
import json
import os
import shutil
import signal
import socket
import ssl
import subprocess
import sys
import tempfile
import threading
import time
import warnings

from support import BINARIES, HERMESCTL, Daemon, Process, free_port, put, wait_for

NOT_AUTHORISED = -32001
HALF_GREETING = bytes([0x16, 3, 1, 2, 0, 1, 0, 1, 0xfc])


def keys(folder, *words, status=0):
    done = subprocess.run([HERMESCTL, "keys", *words], env={**os.environ, "HERMES_KEYS": folder}, capture_output=True, text=True, check=False)
    assert done.returncode == status, (words, done)
    return done.stdout if status == 0 else done.stderr


def issued(folder, name):
    return os.path.join(folder, "issued-for", name)


def context_of(keys_folder=None, authority=None):
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    context.verify_mode = ssl.CERT_NONE  # who the daemon is, is not what is tried here
    if keys_folder:
        context.load_cert_chain(os.path.join(keys_folder, "own.crt"), os.path.join(keys_folder, "own.key"))
    if authority:
        context.verify_mode = ssl.CERT_REQUIRED
        context.load_verify_locations(authority)
    return context


class Client(Daemon):
    """Over TLS."""

    def connect(self, host, port, timeout):
        return self.context.wrap_socket(socket.create_connection((host, port), timeout))

    def __init__(self, port, context):
        self.context = context
        super().__init__(port=port, timeout=10)


def is_refused(port, context):
    try:
        with Client(port, context) as stranger:
            stranger.call("daemon.info")
    except (OSError, ssl.SSLError, ConnectionError):
        return True
    return False


def wait_for_log(process, text):
    def found():
        with open(process.log_name, encoding="utf-8", errors="replace") as log:
            return text in log.read()
    try:
        wait_for(f"\"{text}\" in the log", found, 10)
    except AssertionError as error:
        raise AssertionError(f"{error}; it ends:\n{process.last_words()}") from None


def refused_alone(process, reason, try_it):
    """The log says one refusal a second; each reason gets its second."""
    time.sleep(1.1)
    assert try_it(), reason
    wait_for_log(process, reason)


def check_strangers(process, port, folder, foreign, expired):
    refused_alone(process, "did not present any certificate", lambda: is_refused(port, context_of()))
    refused_alone(process, "certificate", lambda: is_refused(port, context_of(foreign)))
    refused_alone(process, "expired", lambda: is_refused(port, context_of(expired)))

    def plain():
        with socket.create_connection(("127.0.0.1", port), 10) as stranger:
            stranger.sendall(b'{"jsonrpc":"2.0","id":1,"method":"daemon.info"}\n' * 5)
            stranger.settimeout(10)
            answer = b""
            try:
                while part := stranger.recv(1000):
                    answer += part
            except OSError:
                pass
            return b"jsonrpc" not in answer
    refused_alone(process, "wrong version number", plain)
    old = context_of(issued(folder, "anna"))
    old.minimum_version = ssl.TLSVersion.MINIMUM_SUPPORTED
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        old.maximum_version = ssl.TLSVersion.TLSv1_1
    old.set_ciphers("ALL:@SECLEVEL=0")
    assert is_refused(port, old), "TLS 1.1"


def check_half_handshakes(process, port, folder):
    """100 that say nothing, or half a greeting: others come in meanwhile, these are closed."""
    silent = [socket.create_connection(("127.0.0.1", port), 10) for _ in range(100)]
    for connection in silent[::2]:
        connection.sendall(HALF_GREETING)
    begun = time.monotonic()
    with Client(port, context_of(issued(folder, "anna"))) as anna:
        anna.call("daemon.info")
        took = time.monotonic() - begun
    assert took < 2, f"a handshake took {took:.1f} s beside 100 that were silent"
    for connection in silent:
        connection.settimeout(15)
        try:
            while connection.recv(1000):
                pass
        except ConnectionError:
            pass
        connection.close()
    assert time.monotonic() - begun < 12
    wait_for_log(process, "no handshake of TLS within 5 s")
    return took


def check_gone(process, port, folder):
    """No handshake is begun with strangers who have gone: whoever waits behind a thousand of them comes in."""
    def is_served():
        os.kill(process.process.pid, signal.SIGSTOP)
        try:
            for _ in range(1000):
                with socket.create_connection(("127.0.0.1", port), 10) as gone:
                    gone.sendall(HALF_GREETING)
            context = context_of(issued(folder, "anna"))
            late = context.wrap_socket(socket.create_connection(("127.0.0.1", port), 10), do_handshake_on_connect=False)
        finally:
            os.kill(process.process.pid, signal.SIGCONT)
        with late:
            late.do_handshake()
        return True
    refused_alone(process, "it had gone before its handshake", is_served)


STORM = """import socket, sys, time
end = time.monotonic() + 3
while time.monotonic() < end:
    connections = []
    for _ in range(50):
        connections.append(socket.create_connection(("127.0.0.1", int(sys.argv[1]))))
        connections[-1].sendall(bytes.fromhex(sys.argv[2]))
    for connection in connections:
        connection.close()
"""


def check_storm(process, port):
    """Strangers who connect as fast as they can hold nobody up."""
    storm = [subprocess.Popen([sys.executable, "-c", STORM, str(port), HALF_GREETING.hex()], stderr=subprocess.DEVNULL) for _ in range(2)]
    worst = 0
    with Daemon(port=process.port) as friend:
        while any(one.poll() is None for one in storm):
            begun = time.monotonic()
            friend.call("daemon.info")
            worst = max(worst, time.monotonic() - begun)
            time.sleep(0.005)
    assert worst < 0.5, f"a call took {worst:.2f} s beside a storm of connections"
    return worst


def check_roles(port, folder):
    for name, method, may in (("otto", "topics.list", True), ("otto", "trigger.fire", False), ("anna", "trigger.fire", True),
                              ("anna", "settings.reset", False), ("eva", "settings.reset", True), ("robot", "trigger.fire", False)):
        with Client(port, context_of(issued(folder, name))) as one:
            one.socket.sendall(json.dumps({"jsonrpc": "2.0", "id": 1, "method": method, "params": {"nonsense": 1}}).encode() + b"\n")
            error = json.loads(one.lines.readline())["error"]
            assert (error["code"] != NOT_AUTHORISED) == may, (name, method, error)


def check_revocation(process, port, folder):
    with Client(port, context_of(issued(folder, "anna"))) as anna, Client(port, context_of(issued(folder, "eva"))) as eva:
        anna.call("daemon.info")
        begun = time.monotonic()
        keys(folder, "revoke", "anna")
        try:
            while True:
                anna.call("daemon.info")
                time.sleep(0.01)
        except (OSError, ConnectionError):
            took = time.monotonic() - begun
        assert took < 1, f"revoked, and connected for {took:.2f} s more"
        eva.call("daemon.info")
    time.sleep(1.1)
    assert is_refused(port, context_of(issued(folder, "anna")))
    wait_for_log(process, "is revoked")
    with open(os.path.join(folder, "revoked"), "a", encoding="utf-8") as file:
        file.write("nonsense!\n")
    wait_for("refusal of everybody new", lambda: is_refused(port, context_of(issued(folder, "eva"))), 5)
    with open(os.path.join(folder, "revoked"), encoding="utf-8") as file:
        lines = file.readlines()[:-1]
    with open(os.path.join(folder, "revoked"), "w", encoding="utf-8") as file:
        file.writelines(lines)
    wait_for("entry", lambda: not is_refused(port, context_of(issued(folder, "eva"))), 5)
    return took


def check_hermesctl(port, folder):
    """The client of ours: as an engineer; against who has only a client's certificate; with the wrong authority."""
    def ctl(keys_folder, at, status):
        done = subprocess.run([HERMESCTL, "call", f"tls://127.0.0.1:{at}", "daemon.info"], env={**os.environ, "HERMES_KEYS": keys_folder},
                              capture_output=True, text=True, check=False)
        assert done.returncode == status, done
        return done.stdout + done.stderr
    eva = issued(folder, "eva")
    assert json.loads(ctl(eva, port, 0))["role"] == "engineer"
    serials = {entry["name"]: entry["serial"] for entry in json.loads(keys(folder, "list", "--json"))}
    with open(os.path.join(eva, "revoked"), "w", encoding="utf-8") as file:
        file.write(serials["robot"] + " stolen")  # and no line feed
    assert "is revoked" in ctl(eva, port, 1)
    os.remove(os.path.join(eva, "revoked"))
    server = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    server.load_cert_chain(os.path.join(issued(folder, "eva"), "own.crt"), os.path.join(issued(folder, "eva"), "own.key"))
    with socket.create_server(("127.0.0.1", 0)) as listener:
        heard = []

        def pretend():
            try:
                connection = server.wrap_socket(listener.accept()[0], server_side=True)
                connection.settimeout(10)
                heard.append(connection.recv(1000))
            except OSError:
                heard.append(b"")
        thread = threading.Thread(target=pretend, daemon=True)
        thread.start()
        assert "not of a daemon" in ctl(issued(folder, "eva"), listener.getsockname()[1], 1)
        thread.join(10)
        assert heard == [b""], "spoke to who is no daemon"


def check_advice(port, folder, foreign):
    """hermesctl says what is likely when it does not come to terms with a daemon, and what to do."""
    def ctl(keys_folder, address):
        done = subprocess.run([HERMESCTL, "call", address, "daemon.info", "--timeout", "5"], env={**os.environ, "HERMES_KEYS": keys_folder},
                              capture_output=True, text=True, check=False)
        assert done.returncode == 1, done
        return done.stderr
    text = ctl(foreign, f"tls://127.0.0.1:{port}")
    assert "the certificate there is not accepted" in text and "of different authorities" in text, text
    text = ctl(folder, f"127.0.0.1:{port}")
    assert f"name the daemon as tls://127.0.0.1:{port}" in text, text
    with Process(BINARIES, "softwaretrigger", free_port(0), foreign, {}) as plain:
        plain.connect().close()
        text = ctl(folder, f"tls://127.0.0.1:{plain.port}")
        assert f"speaks plain text, no TLS; name it as 127.0.0.1:{plain.port}" in text, text
    text = ctl(folder, f"tls://127.0.0.1:{free_port(0)}")
    assert "Connection refused" in text and "no daemon listens at tls://" in text, text
    keys(folder, "issue", "lost", "--role", "operator")
    keys(folder, "revoke", "lost")
    wait_for("that it is refused", lambda: is_refused(port, context_of(issued(folder, "lost"))), 5)
    text = ctl(issued(folder, "lost"), f"tls://127.0.0.1:{port}")
    assert "the daemon refuses your keys" in text and "hermesctl keys issue makes new ones" in text, text


def check_bad_keys(folder, scratch):
    """The daemon does not start, and names the file and the remedy."""
    def start(change, *expected):
        bad = os.path.join(scratch, "bad")
        shutil.copytree(issued(folder, "robot"), bad)
        change(bad)
        done = subprocess.run([os.path.join(BINARIES, "hermes-softwaretrigger"), "--listen", f"tls://127.0.0.1:0?keys={bad}"],
                              capture_output=True, text=True, check=False, timeout=20)
        shutil.rmtree(bad)
        assert done.returncode == 1 and all(text in done.stderr for text in expected), (done, expected)
    start(lambda bad: [shutil.copy(os.path.join(issued(folder, "eva"), name), bad) for name in ("own.crt", "own.key")], "of \"eva\"", "--role daemon")
    start(lambda bad: os.remove(os.path.join(bad, "own.key")), "own.key", "No such file", "hermesctl keys")
    start(lambda bad: os.remove(os.path.join(bad, "authority.crt")), "authority.crt", "No such file", "hermesctl keys")
    start(lambda bad: os.chmod(os.path.join(bad, "own.key"), 0o644), "own.key", "chmod 600")
    start(lambda bad: shutil.copy(os.path.join(issued(folder, "eva"), "own.key"), bad), "own.key", "is not the key of")
    start(lambda bad: shutil.copy(os.path.join(scratch, "foreign", "authority.crt"), bad), "own.crt", "not signed by")
    start(lambda bad: open(os.path.join(bad, "own.crt"), "w", encoding="utf-8").close(), "own.crt", "not a certificate")
    start(lambda bad: shutil.copy(os.path.join(scratch, "expired", "own.crt"), bad), "own.crt", "is valid from")
    start(lambda bad: os.replace(os.path.join(bad, "own.key"), os.path.join(bad, "x")) or os.mkfifo(os.path.join(bad, "own.key"), 0o600),
          "own.key")
    start(lambda bad: open(os.path.join(bad, "revoked"), "w", encoding="utf-8").write("zz\n") and None, "revoked", "not a serial number")


def check_unreachable_list(folder, scratch):
    """Where the list cannot be reached, nobody is let in; a full disk leaves no half line behind."""
    own = os.path.join(scratch, "of another daemon")
    shutil.copytree(issued(folder, "robot"), own)
    listed = os.path.join(own, "revoked")
    serial = {entry["name"]: entry["serial"] for entry in json.loads(keys(folder, "list", "--json"))}["anna"]
    put(listed, serial + " anna\n")
    port = free_port(0)
    eva, anna = context_of(issued(folder, "eva")), context_of(issued(folder, "anna"))

    def dangling():
        os.remove(listed)
        os.symlink("nowhere", listed)

    def cut():
        os.remove(listed)
        put(listed, serial[:8])
    with Process(BINARIES, "softwaretrigger", free_port(0), scratch, {},
                 ["--listen", f"tls://127.0.0.1:{port}?keys={own.replace(' ', '%20')}"]) as process:
        process.connect().close()
        assert is_refused(port, anna) and not is_refused(port, eva)
        for change in (lambda: os.truncate(listed, 0), dangling, cut, lambda: os.rename(own, own + " away")):
            change()
            wait_for("refusal of everybody", lambda: is_refused(port, eva), 5)
            assert is_refused(port, anna)
    shutil.rmtree(own + " away")


def check_keys_commands(folder):
    assert "already" in keys(folder, "init", status=1)
    assert "expected" in keys(folder, "issue", "bob\n", "--role", "observer", status=2)
    assert "--role" in keys(folder, "issue", "x", "--role", "king", status=2)
    assert "expected" in keys(folder, "issue", "../x", "--role", "operator", status=2)
    assert "exists" in keys(folder, "issue", "eva", "--role", "operator", status=1)
    assert "no certificate" in keys(folder, "revoke", "nobody", status=2)
    names = {entry["name"]: entry for entry in json.loads(keys(folder, "list", "--json"))}
    assert {"robot", "anna", "eva", "otto"} <= set(names) and names["anna"]["state"] == "valid", names
    for path, _, files in os.walk(folder):
        for file in files:
            if file.endswith(".key"):
                assert os.stat(os.path.join(path, file)).st_mode & 0o077 == 0, file


def make_expired(scratch, folder):
    """An hour of yesterday, signed by the same authority: by the openssl program."""
    expired = os.path.join(scratch, "expired")
    shutil.copytree(issued(folder, "eva"), expired)
    request, database = os.path.join(scratch, "request"), os.path.join(scratch, "database")
    os.mkdir(database)
    for name, content in (("index", ""), ("serial", "4000000000000001"), ("config", f"""[ca]
default_ca = a
[a]
database = {database}/index
serial = {database}/serial
new_certs_dir = {database}
default_md = sha256
policy = p
[p]
commonName = supplied
organizationalUnitName = supplied
""")):
        put(os.path.join(database, name), content)
    run = {"check": True, "capture_output": True}
    subprocess.run(["openssl", "req", "-new", "-key", os.path.join(expired, "own.key"), "-subj", "/CN=eva/OU=engineer", "-out", request], **run)
    subprocess.run(["openssl", "ca", "-batch", "-config", os.path.join(database, "config"), "-in", request, "-cert",
                    os.path.join(folder, "authority.crt"), "-keyfile", os.path.join(folder, "authority.key"), "-startdate", "200101000000Z",
                    "-enddate", "200102000000Z", "-notext", "-out", os.path.join(expired, "own.crt")], **run)
    return expired


def main():
    if not shutil.which("openssl"):
        print("SKIP: no program openssl, which makes an expired certificate")
        return 77
    with tempfile.TemporaryDirectory() as scratch:
        folder, foreign = os.path.join(scratch, "keys"), os.path.join(scratch, "foreign")
        keys(folder, "init")
        keys(foreign, "init")
        for name, role in (("robot", "daemon"), ("anna", "operator"), ("eva", "engineer"), ("otto", "observer")):
            keys(folder, "issue", name, "--role", role)
        expired = make_expired(scratch, folder)
        check_keys_commands(folder)
        check_bad_keys(folder, scratch)
        port, own = free_port(0), os.path.join(scratch, "of the daemon")
        shutil.copytree(issued(folder, "robot"), own)
        with open(os.path.join(folder, "revoked"), "w", encoding="utf-8"):
            os.symlink(os.path.join(folder, "revoked"), os.path.join(own, "revoked"))
        with Process(BINARIES, "softwaretrigger", free_port(0), scratch, {},
                     ["--listen", f"tls://0.0.0.0:{port}?keys={own.replace(' ', '%20')}"]) as process:
            process.connect().close()
            with Client(port, context_of(issued(folder, "eva"), os.path.join(folder, "authority.crt"))) as steady:
                check_strangers(process, port, folder, foreign, expired)
                check_roles(port, folder)
                beside = check_half_handshakes(process, port, folder)
                check_gone(process, port, folder)
                worst = check_storm(process, port)
                check_hermesctl(port, folder)
                check_unreachable_list(folder, scratch)
                took = check_revocation(process, port, folder)
                check_advice(port, folder, foreign)
                steady.call("daemon.info")  # not affected by anything
                assert steady.call("daemon.status")["health"], "no health"
    print(f"beside a storm of connections a call took {worst * 1000:.0f} ms at most; a handshake beside 100 silent ones {beside:.2f} s; revoked clients were gone after {took:.2f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
