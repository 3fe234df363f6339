#!/usr/bin/env python3
"""Pairing: hermesctl keys pair and keys join against each other, then TLS with the keys; wrong codes, strangers, a joining side that is
killed, and a pretended other side that knows the code (the openssl program) and sends what is not in order."""
import contextlib
import json
import os
import shutil
import signal
import stat
import struct
import subprocess
import sys
import tempfile
import time

from pairing_sides import IDENTITY, SUITE, Half, Pair, ctl, framed, pretended, secret_of
from support import BINARIES, HERMESCTL, Process, free_port, text_of, wait_for


def state_of(folder, name):
    return [entry["state"] for entry in json.loads(ctl(folder, "keys", "list", "--json")) if entry["name"] == name]


def check_revoked(pair, error):
    assert "revoked" in error["message"] and "removed" in error["message"], error
    assert state_of(pair.folder, pair.name) == ["revoked"]
    assert not os.path.exists(os.path.join(pair.folder, "issued-for", pair.name))


def beside(folder):
    """What was made for it, whole or not."""
    where, name = os.path.split(folder)
    return {entry for entry in os.listdir(where) if entry.startswith(name)}


def check_nothing_in(folder):
    assert beside(folder) == set(), beside(folder)


def check_modes(folder):
    def mode(*name):
        return stat.S_IMODE(os.stat(os.path.join(folder, *name)).st_mode)
    modes = {name: oct(mode(name)) for name in os.listdir(folder)}
    assert mode() == 0o700 and set(modes.values()) == {oct(0o600)}, (oct(mode()), modes)
    assert {"authority.crt", "own.crt", "own.key"} <= set(os.listdir(folder)) <= {"authority.crt", "own.crt", "own.key", "revoked"}


def check_success(authority, scratch):
    """A robot and an engineer get their keys, and speak TLS with each other."""
    robot, eva = os.path.join(scratch, "deep", "robot"), os.path.join(scratch, "eva")
    with Pair(authority, "robot", "daemon") as pair:
        assert pair.told["port"] == pair.port and len(pair.code) == 11 and pair.code in pair.told["command"], pair.told
        joined = json.loads(ctl(robot, "keys", "join", f"127.0.0.1:{pair.port}", pair.code, "--json"))
        given = pair.end(0)
        assert given["serial"] == joined["serial"] and joined["role"] == "daemon" and joined["folder"] == robot, (given, joined)
    os.mkdir(eva, 0o755)  # an empty one is as good as none
    with Pair(authority, "eva", "engineer", "--days", "3") as pair:
        assert pair.code != joined
        typed = pair.code.lower()
        assert "eva" in pair.join(eva, f" {typed[:3]} {typed[3:5]}  {typed[6:]} ")
        pair.end(0)
    for name, folder in (("robot", robot), ("eva", eva)):
        check_modes(folder)
        assert state_of(authority, name) == ["valid"]
        assert not os.path.exists(os.path.join(authority, "issued-for", name)), "a second copy of the key"
    port = free_port(0)
    with Process(BINARIES, "softwaretrigger", free_port(0), scratch, {}, ["--listen", f"tls://127.0.0.1:{port}?keys={robot}"]) as process:
        process.connect().close()
        assert json.loads(ctl(eva, "call", f"tls://127.0.0.1:{port}", "daemon.info"))["role"] == "engineer"
    return eva


def check_wrong(authority, scratch):
    folder = os.path.join(scratch, "wrong")
    with Pair(authority, "wrong", "operator") as pair:
        wrong = ("Z" if pair.code[0] != "Z" else "Y") + pair.code[1:]
        for _ in range(3):
            assert "the code is wrong" in pair.join(folder, wrong, status=1)
            check_nothing_in(folder)
        assert "wrong 3 times" in pair.end(1)["message"]
        assert [note["note"][-1] for note in pair.notes[:-1]] == ["2", "1", "0"], pair.notes
        assert "cannot connect" in pair.join(folder, status=1)
    assert state_of(authority, "wrong") == []
    with Pair(authority, "second", "operator") as pair:
        pair.join(folder, wrong, status=1)
        pair.join(folder, wrong, status=1)
        pair.join(folder)
        pair.end(0)


def client(pair, *options, identity=IDENTITY, secret=None):
    """The openssl program as the joining side."""
    return subprocess.Popen(["openssl", "s_client", "-connect", f"127.0.0.1:{pair.port}", "-psk_identity", identity, "-psk",
                             secret or secret_of(pair.code), "-quiet", *options], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                            stderr=subprocess.DEVNULL)


def check_strangers(authority, scratch):
    """More than are heard at a time say nothing; others say what is no pairing: none of these is an attempt."""
    folder = os.path.join(scratch, "strange")
    with contextlib.ExitStack() as stack:
        pair = stack.enter_context(Pair(authority, "strange", "operator"))
        silent = [stack.enter_context(pair.connect()) for _ in range(100)]
        begun = time.monotonic()
        for number, garbage in enumerate((b"GET / HTTP/1.1\r\n\r\n", os.urandom(5000), bytes(1000), bytes([0x16, 3, 1, 0xff, 0xff]),
                                          bytes([0x16, 3, 3, 0, 5, 1, 0xff, 0xff, 0xff, 0]), b'{"jsonrpc":"2.0"}\n' * 100)):
            stranger = stack.enter_context(pair.connect())
            with contextlib.suppress(ConnectionError):
                stranger.sendall(garbage)
            if number % 2:
                stranger.close()
        for options in (["-tls1_2", "-cipher", "PSK-CHACHA20-POLY1305"], ["-tls1_3"], ["-tls1_2", "-cipher", "ECDHE-ECDSA-CHACHA20-POLY1305"]):
            assert client(pair, *options).wait(10) != 0, options
        assert client(pair, "-tls1_2", "-cipher", SUITE, identity="somebody").wait(10) != 0
        silent[-1].settimeout(15)
        assert silent[-1].recv(10) == b"", "a silent one was heard"
        assert 4 < time.monotonic() - begun < 9, "5 s are for a handshake"
        late = [stack.enter_context(pair.connect()) for _ in range(50)]
        before = time.monotonic()
        pair.join(folder)
        took = time.monotonic() - before
        assert took < 3, f"joined after {took:.1f} s beside {len(late)} silent ones"
        pair.end(0)
        assert pair.notes == [], pair.notes
    return took


def check_refusals(authority, eva, scratch):
    none = os.path.join(scratch, "none")
    begun = time.monotonic()
    with Pair(authority, "late", "operator", "--timeout", "1") as pair:
        assert "within 1 s" in pair.end(1)["message"]
        assert 1 <= time.monotonic() - begun < 5
    assert state_of(authority, "late") == []
    with Pair(authority, "again", "operator") as pair:
        assert "already" in pair.join(eva, status=1)
        full = os.path.join(scratch, "full")
        os.mkdir(full)
        open(os.path.join(full, "notes"), "w", encoding="utf-8").close()
        assert "not empty" in pair.join(full, status=1)
        for code, what in (("ABCDE-FGHJ", "has 9"), (pair.code + "A", "has 11"), ("O" + pair.code[1:], "neither 0"), ("é" + pair.code[1:], "code")):
            assert what in pair.join(none, code, status=2), code
        other = subprocess.run([HERMESCTL, "keys", "pair", "third", "--role", "operator", "--port", str(pair.port)], capture_output=True, text=True,
                               env={**os.environ, "HERMES_KEYS": authority}, check=False, timeout=20)
        assert other.returncode == 1 and "--port" in other.stderr, other
        pair.join(none)
        pair.end(0)
        assert pair.notes == [], pair.notes
    for words, what in ((("localhost:0", "ABCDE-FGHJK"), "HOST:PORT"), (("localhost:70000", "ABCDE-FGHJK"), "HOST:PORT"), (("", "ABCDE-FGHJK"), "HOST"),
                        (("localhost",), "usage")):
        assert what in ctl(os.path.join(scratch, "free"), "keys", "join", *words, status=2), words
    assert "--role" in ctl(authority, "keys", "pair", "x", status=2)
    assert "expected" in ctl(authority, "keys", "pair", "../x", "--role", "operator", status=2)
    ctl(authority, "keys", "issue", "issued", "--role", "operator")
    assert "exists" in ctl(authority, "keys", "pair", "issued", "--role", "operator", status=1)
    assert "keys init" in ctl(os.path.join(scratch, "free"), "keys", "pair", "x", "--role", "operator", status=1)
    check_nothing_in(os.path.join(scratch, "free"))


def check_killed(authority, scratch):
    """A long list of revoked certificates, of which a part arrives; then the joining side, or both, are killed."""
    folder, revoked = os.path.join(scratch, "killed"), os.path.join(authority, "revoked")
    with open(revoked, "a", encoding="utf-8") as file:
        file.writelines(f"{number:016x} somebody, operator\n" for number in range(5000))
    for name, stops in (("killed", False), ("both", True)):
        with Pair(authority, name, "operator") as pair:
            half = Half(pair.port, 50000)
            joining = subprocess.Popen([HERMESCTL, "keys", "join", f"127.0.0.1:{half.port}", pair.code], env={**os.environ, "HERMES_KEYS": folder},
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            assert half.isFull.wait(10)
            assert state_of(authority, name) == ["valid"]
            if stops:
                pair.process.send_signal(signal.SIGTERM)
            joining.kill()
            joining.wait()
            if stops:
                pair.process.communicate(timeout=20)
                assert state_of(authority, name) == ["revoked"]
                assert not os.path.exists(os.path.join(authority, "issued-for", name))
            else:
                check_revoked(pair, pair.end(1))
        check_nothing_in(folder)
    with Pair(authority, "unconfirmed", "operator") as pair:  # had all, and said nothing
        taker = client(pair, "-tls1_2", "-cipher", SUITE)
        size = struct.unpack(">I", taker.stdout.read(4))[0]
        assert set(json.loads(taker.stdout.read(size))) == {"authority", "certificate", "key", "revoked"}
        taker.kill()
        taker.communicate()
        check_revoked(pair, pair.end(1))
    with Pair(authority, "whole", "operator") as pair:  # a list of 200 KB arrives
        pair.join(folder)
        pair.end(0)
    assert serials_in(folder) == serials_in(authority) and len(serials_in(folder)) > 5000
    check_modes(folder)


def serials_in(folder):
    with open(os.path.join(folder, "revoked"), encoding="utf-8") as file:
        return sorted(line.split()[0].lower() for line in file if line.strip() and not line.startswith("#"))


def check_edited_list(authority, scratch):
    """What people have written beside the serial numbers stays where it is; a list that is none is noticed before keys are made."""
    folder, revoked = os.path.join(scratch, "edited"), os.path.join(authority, "revoked")
    with open(revoked, "a", encoding="utf-8") as file:
        file.write("# J\u00fcrgen's\r\n0123456789ABCDEF\tJ\u00fcrgen, left in May\r\n\n")
    with Pair(authority, "edited", "operator") as pair:
        pair.join(folder)
        pair.end(0)
    assert serials_in(folder) == serials_in(authority) and "0123456789abcdef" in serials_in(folder)
    assert set(text_of(os.path.join(folder, "revoked"))) <= set("0123456789abcdef\n")
    shutil.copy(revoked, revoked + ".right")
    with open(revoked, "a", encoding="utf-8") as file:
        file.write("J\u00fcrgen\n")
    for words in (("pair", "late"), ("issue", "late")):
        assert "not a serial number" in ctl(authority, "keys", *words, "--role", "operator", "--timeout", "1", status=1), words
    os.replace(revoked + ".right", revoked)
    assert state_of(authority, "late") == []


def check_others_folders(authority, eva, scratch):
    """What stands beside the place is not touched, whoever made it; who joins at the same time is not disturbed."""
    folder, precious = os.path.join(scratch, "twice"), os.path.join(scratch, "precious")
    os.mkdir(precious)
    open(os.path.join(precious, "thesis"), "w", encoding="utf-8").close()
    os.symlink(precious, folder + ".joining")
    port, code = free_port(0), "ABCDE-FGHJK"
    with pretended(port, code) as server:
        server.stdin.write(framed(bundle_of(eva)))
        server.stdin.flush()
        first = wait_for("a server that listens", lambda: waiting_join(folder, port, code))
        with Pair(authority, "twice", "operator") as pair:
            pair.join(folder)
            pair.end(0)
        assert len(beside(folder)) == 3, beside(folder)
        server.stdin.write(framed(b"accepted"))
        server.stdin.flush()
        assert "nothing was kept" in first.communicate(timeout=20)[1] and first.returncode == 1
    assert os.listdir(precious) == ["thesis"]
    assert beside(folder) == {"twice", "twice.joining"}, beside(folder)
    assert bundle_of(folder)["certificate"] != bundle_of(eva)["certificate"], "the first one's were kept"


def waiting_join(folder, port, code):
    """A join that has written its keys, and waits for the other side; None when there was no other side."""
    before = beside(folder)
    joining = subprocess.Popen([HERMESCTL, "keys", "join", f"127.0.0.1:{port}", code, "--timeout", "10"], env={**os.environ, "HERMES_KEYS": folder},
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    wait_for("keys, or the end", lambda: joining.poll() is not None or any(
        os.path.exists(os.path.join(os.path.dirname(folder), entry, "own.crt")) for entry in beside(folder) - before))
    if joining.poll() is None:
        return joining
    assert "cannot connect" in joining.communicate()[1]
    return None


def bundle_of(folder, **changes):
    bundle = {"revoked": ""}
    for name, file in (("authority", "authority.crt"), ("certificate", "own.crt"), ("key", "own.key")):
        bundle[name] = text_of(os.path.join(folder, file))
    return {**bundle, **changes}


def try_pretended(scratch, sent, expected):
    folder, port, code = os.path.join(scratch, "pretended"), free_port(0), "ABCDE-FGHJK"
    with pretended(port, code) as server:
        server.stdin.write(sent)
        server.stdin.flush()

        def joined():
            error = ctl(folder, "keys", "join", f"127.0.0.1:{port}", code, "--timeout", "10", status=1)
            return None if "cannot connect" in error else error
        error = wait_for("a server that listens", joined, 10)
        assert expected in error, (sent[:100], expected, error)
        check_nothing_in(folder)


def check_pretended(eva, scratch):
    foreign = os.path.join(scratch, "foreign")
    ctl(foreign, "keys", "init")
    own, other = bundle_of(eva), bundle_of(foreign)
    locked = subprocess.run(["openssl", "ec", "-aes128", "-passout", "pass:x"], input=own["key"], capture_output=True, text=True, check=True).stdout
    for sent, expected in ((struct.pack(">I", 0xffffffff), "bytes"), (framed(b"nonsense"), "an object"), (framed([]), "an object"),
                           (framed({}), "an object"), (framed({**own, "../../x": "y"}), "an object"),
                           (framed({**{name: own[name] for name in ("authority", "certificate", "key")}, "/etc/x": "y"}), "revoked is not a text"),
                           (framed({**own, "key": 3}), "key is not a text"), (framed({**own, "key": ""}), "the key is not valid"),
                           (framed({**own, "key": locked}), "the key is not valid"), (framed({**own, "key": other["key"]}), "not that of"),
                           (framed({**own, "authority": other["authority"]}), "not signed"), (framed({**own, "certificate": "x"}), "a certificate is not valid"),
                           (framed({**own, "certificate": own["certificate"] * 2}), "a certificate is not valid"),
                           (framed({**own, "certificate": own["authority"], "key": own["key"]}), "not that of"),
                           (framed({**own, "authority": own["certificate"]}), "cannot be read"),
                           (framed({**own, "revoked": "zz\n"}), "not a serial number"), (framed({**own, "revoked": "\x1b[2J"}), "not a text"),
                           (framed(own) + framed(b"rejected"), "does not accept")):
        try_pretended(scratch, sent, expected)


def main():
    if not shutil.which("openssl"):
        print("SKIP: no program openssl, which pretends to be the other side")
        return 77
    with tempfile.TemporaryDirectory() as scratch:
        authority = os.path.join(scratch, "authority")
        ctl(authority, "keys", "init")
        eva = check_success(authority, scratch)
        check_wrong(authority, scratch)
        took = check_strangers(authority, scratch)
        check_refusals(authority, eva, scratch)
        check_others_folders(authority, eva, scratch)
        check_killed(authority, scratch)
        check_edited_list(authority, scratch)
        check_pretended(eva, scratch)
    print(f"joined beside 50 silent ones within {took:.2f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
