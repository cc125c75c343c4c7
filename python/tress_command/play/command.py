"""./tress play."""

import signal
import threading
from pathlib import Path

from ..command import Command
from ..messages import DONE, ROWS_FAILED, refuse, say
from ..place import shipped
from ..processes import STOPS
from ..scene_folder import existing, scene_folder
from ..tree import PROGRAMS, first_program
from .engine import Engine
from .server import Server
from .session import Session

VALUED = ("--port", "--threads", "--plugin")


def _options(words):
    """Returns the port and the options of simulate."""
    port, more, words = 0, [], list(words)
    while words:
        word = words.pop(0)
        if word == "--no-guard":
            more.append(word)
            continue
        if word not in VALUED:
            refuse(f"play: unknown option '{word}'; ./tress play --help shows the options")
        if not words:
            refuse(f"play: {word} without a value; give one")
        value = words.pop(0)
        if word != "--port":
            more += [word, value]
        elif value.isdecimal() and 1 <= int(value) <= 65535:
            port = int(value)
        else:
            refuse(f"play: --port {value} is no port; give a number from 1 to 65535")
    return port, more


def _server(session, page, port):
    try:
        return Server(session, page, port)
    except OSError as error:
        refuse(f"play: port {port}: {error.strerror}; give another --port, or none for a free one")


def _run(words, machine):
    scene_folder("play", words)  # refuses what is no scene file
    scene, (port, more) = existing(words[0]), _options(words[1:])
    program = first_program(machine, "simulate")
    page = Path(shipped("experiments/report/dist/live.html")).read_bytes()
    signal.signal(signal.SIGPIPE, signal.SIG_IGN)  # a page that is closed ends no server
    stop = threading.Event()
    for number in STOPS:
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, lambda *_: stop.set())
    session = Session(Engine([program, scene, "--live", *more]))
    try:
        with _server(session, page, port) as server:
            threading.Thread(target=server.serve_forever, daemon=True).start()
            say(f"open in a browser: {server.address}")
            say("Ctrl-C ends it")
            stop.wait()
            died = session.engine.process.poll() is not None
            session.end()
            server.shutdown()
    finally:
        session.end()
    if died:
        say("the simulation program had ended before")
    return ROWS_FAILED if died else DONE


COMMAND = Command(
    "play", "SCENE.toml [OPTIONS]",
    "runs a scene live in the browser: run, pause, step, pull a strand with the mouse, change "
    "a parameter. The server listens on the loopback address only. Ctrl-C ends it.",
    _run,
    example="./tress play scenes/hair_under_wind.toml",
    time="starts at once where simulate is built; a first build takes about a quarter of an "
         "hour of processor time.",
    options=(("--port N", "port of the server; a free one by default"),
             ("--threads N", "threads that share the strands (default 1)"),
             ("--plugin FILE", "shared library of further models, integrators and effects"),
             ("--no-guard", "continues after the guard reports an unphysical state"),
             ("--help", "this text")))
