#!/usr/bin/env python3
"""kill_saves.py BIN [COUNT [KIND ...]]: kills programs in the middle of their saves, COUNT times a kind (1000), at random moments.

What was under the name before has to be there whole, or what is new has to be: nothing between. Nothing is left that the next
save does not clear away. BIN has the programs (build/release/bin). Kinds `session` and `recording` need a display and
xdotool, and are left out, and said to be, where there is none. Fails at the first file that is neither.
"""
import hashlib
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

BIN = pathlib.Path(sys.argv[1]).resolve()
COUNT = int(sys.argv[2]) if len(sys.argv) > 2 else 1000
RANDOM = random.Random(37)


def start(words, folder, **more):
    environment = {**os.environ, "XDG_CACHE_HOME": str(folder / "cache"), "XDG_CONFIG_HOME": str(folder / "config"),
                   "XDG_STATE_HOME": str(folder / "state")}
    return subprocess.Popen([str(BIN / words[0]), *map(str, words[1:])], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, start_new_session=True, **more)


def run(words, folder):
    process = start(words, folder)
    said = process.communicate()[1].decode()
    if process.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}: ends with {process.returncode}\n{said}")


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.exists() else None


def parts(folder):
    return [path for path in folder.rglob("*") if path.name.endswith(".part")]


def killed_after(process, seconds, folder):
    """Kills it, and its helpers, after a time. True where the kill met a file that was being written."""
    try:
        process.wait(seconds)
    except subprocess.TimeoutExpired:
        pass
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    process.communicate()
    return bool(parts(folder))


def moment(folder, process, length):
    """[s] until the kill: half of the kills at any moment of the run, half once a file is being written."""
    if RANDOM.random() < 0.5:
        return RANDOM.random() * 1.1 * length
    end = time.monotonic() + 2 * length
    while time.monotonic() < end and process.poll() is None and not parts(folder):
        time.sleep(0.0002)
    return RANDOM.random() * 0.02 * length


def file_kind(kind, before, after, name, prepare=None):
    """A verb that writes one file over another: its words before, and after."""
    with tempfile.TemporaryDirectory() as where:
        folder = pathlib.Path(where)
        if prepare:
            run(prepare, folder)
        target = folder / name
        run(before, folder)
        old, old_bytes = digest(target), target.read_bytes()
        begin = time.monotonic()
        run(after, folder)
        length = time.monotonic() - begin
        new = digest(target)
        assert old != new, kind
        found = {old: 0, new: 0}
        met = 0
        for _ in range(COUNT):
            target.write_bytes(old_bytes)
            process = start(after, folder)
            met += killed_after(process, moment(folder, process, length), folder)
            state = digest(target)
            if state not in found:
                sys.exit(f"{kind}: {name} is neither what it was nor what it was to be, {target.stat().st_size} bytes")
            found[state] += 1
        run(after, folder)
        if digest(target) != new or parts(folder):
            sys.exit(f"{kind}: the next save leaves {parts(folder)}")
        print(f"{kind:10} {COUNT} kills: {found[old]} found the file as it was, {found[new]} the new one; {met} met a file being written",
              flush=True)


def cache_kind():
    """Layers of a heart, cached: what is read back after a kill is what is solved without a cache."""
    with tempfile.TemporaryDirectory() as where:
        folder = pathlib.Path(where)
        run(["cardiac", "convert", "--example", "ventricle", "--out", "heart.pts"], folder)
        words = ["cardiac", "trace", "heart.pts", "--layer", "0.5", "--seeds", "random:20", "--force", "--out", "fibres.csv"]
        run([*words, "--cache", "off"], folder)
        wanted = digest(folder / "fibres.csv")
        begin = time.monotonic()
        run([*words, "--cache", "always"], folder)
        length = time.monotonic() - begin
        met = 0
        for _ in range(COUNT):
            shutil.rmtree(folder / "cache", ignore_errors=True)
            process = start([*words, "--cache", "always"], folder)
            met += killed_after(process, moment(folder, process, length), folder)
            run([*words, "--cache", "always"], folder)
            if digest(folder / "fibres.csv") != wanted:
                sys.exit("cache: what is read back differs from what is solved")
            if parts(folder):
                sys.exit(f"cache: the next run leaves {parts(folder)}")
        print(f"cache      {COUNT} kills: all runs after them as without a cache; {met} met a file being written", flush=True)


def study_kind():
    """A study that is simulated: after any number of kills it ends with the tables that it has without one."""
    with tempfile.TemporaryDirectory() as where:
        folder = pathlib.Path(where)
        make = ["flow", "study", "make", "NAME", "--tasks", "tracing2d", "--participants", "2", "--practice", "0", "--recorded", "4"]
        for name in ("whole", "cut"):
            run([name if word == "NAME" else word for word in make], folder)
        begin = time.monotonic()
        run(["flow", "study", "simulate", "whole"], folder)
        length = time.monotonic() - begin
        made = shutil.copytree(folder / "cut", folder / "made")

        def tables(name):
            return {path.relative_to(folder / name): digest(path) for path in (folder / name).rglob("*.tsv")}

        kills = 0
        while kills < COUNT:
            shutil.rmtree(folder / "cut")
            shutil.copytree(made, folder / "cut")
            for _ in range(5):  # each goes on where the one before was cut
                killed_after(start(["flow", "study", "simulate", "cut"], folder), RANDOM.random() * length, folder)
                kills += 1
            run(["flow", "study", "simulate", "cut"], folder)
            if tables("cut").keys() != tables("whole").keys():
                sys.exit(f"study: tables differ by {tables('cut').keys() ^ tables('whole').keys()}")
            run(["flow", "study", "analyse", "cut", "--force"], folder)
        print(f"study      {kills} kills: each study went on and was analysed whole", flush=True)


def window_length(words, folder):
    """[s] until a window of it is seen."""
    begin = time.monotonic()
    process = start(words, folder)
    while process.poll() is None and subprocess.run(["xdotool", "search", "--onlyvisible", "--name", "."], capture_output=True,
                                                    check=False).returncode != 0:
        time.sleep(0.02)
    length = time.monotonic() - begin
    killed_after(process, 0, folder)
    return length


def session_kind():
    """Ctrl+S, again and again, while the window is killed."""
    with tempfile.TemporaryDirectory() as where:
        folder = pathlib.Path(where)
        session = folder / "abc.palpate.toml"
        session.write_text("format = 1\nprogram = 'flow'\n[scene]\nexample = 'abc'\n")
        wait = window_length(["flow", "open", "--session", session], folder)
        saved = 0
        for _ in range(COUNT):
            before = digest(session)
            process = start(["flow", "open", "--session", session], folder)
            time.sleep(wait + 0.3)
            keys = subprocess.Popen(["xdotool", "search", "--onlyvisible", "--name", ".", "windowfocus", "key", "--repeat", "200",
                                     "--delay", "3", "ctrl+s"], stderr=subprocess.DEVNULL)
            killed_after(process, RANDOM.random() * 0.5, folder)
            keys.kill()
            keys.wait()
            saved += digest(session) != before
            run(["flow", "render", "--session", session, "--size", "32x24", "--force", "--out", "picture.png"], folder)
        print(f"session    {COUNT} kills: each session opened afterwards; {saved} had been saved anew", flush=True)


def recording_kind():
    """A recording over a recording: the earlier one is there whole, and the new one up to a second before the kill."""
    with tempfile.TemporaryDirectory() as where:
        folder = pathlib.Path(where)
        words = ["flow", "open", "--example", "abc", "--device", "simulated", "--record", "run.txt", "--force"]
        wait = window_length(words, folder)
        target, earlier = folder / "run.txt", folder / "run.txt~"
        cut = 0
        for _ in range(COUNT):
            old = digest(target)
            process = start(words, folder)
            killed_after(process, RANDOM.random() * (wait + 2), folder)
            if old and old not in (digest(target), digest(earlier)):
                sys.exit("recording: the one before it is gone")
            if target.exists() and digest(target) != old:
                cut += 1
        print(f"recording  {COUNT} kills: the one before was whole each time; {cut} had begun a new one", flush=True)


KINDS = {
    "lines": lambda: file_kind("lines", ["flow", "trace", "--example", "abc", "--seeds", "grid:2,2,2", "--out", "lines.vtp"],
                               ["flow", "trace", "--example", "abc", "--seeds", "grid:8,8,8", "--max-length", "60", "--force", "--out",
                                "lines.vtp"], "lines.vtp"),
    "tracts": lambda: file_kind("tracts", ["dtmri", "trace", "--example", "helix", "--seeds", "fa:0.8", "--out", "tracts.trk"],
                                ["dtmri", "trace", "--example", "helix", "--seeds", "fa:0.7", "--force", "--out", "tracts.trk"],
                                "tracts.trk"),
    "volume": lambda: file_kind("volume", ["grid", "clip", "--example", "shells", "--box", "0,0,0,0.3,0.3,0.3", "--out", "part.nrrd"],
                                ["grid", "clip", "--example", "shells", "--box", "-1,-1,-1,0.9,0.9,0.9", "--force", "--out", "part.nrrd"],
                                "part.nrrd"),
    "workbench": lambda: file_kind("workbench", ["workbench", "calibrate", "tracker", "poses.csv", "--seed", "2", "--out", "w.toml"],
                                   ["workbench", "calibrate", "tracker", "poses.csv", "--force", "--out", "w.toml"], "w.toml",
                                   ["workbench", "example", "tracker", "--out", "poses.csv"]),
    "cache": cache_kind,
    "study": study_kind,
    "session": session_kind,
    "recording": recording_kind,
}

for name in sys.argv[3:] or KINDS:
    if name in ("session", "recording") and not (os.environ.get("DISPLAY") and shutil.which("xdotool")):
        print(f"{name:10} left out: it needs a display and xdotool")
    else:
        KINDS[name]()
