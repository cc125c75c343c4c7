"""A live run: it plays in real time while a page looks at it."""

import threading
import time

PICTURE_S = 1 / 30  # between two pictures
ALL_STEPS = 1_000_000


class Session:
    """Runs, pauses and changes a run. Threads of pages wait for its pictures."""

    def __init__(self, engine):
        self.engine = engine
        self.keys = engine.first["keys"]
        self.stiffness = engine.first["stiffness_n_m"]
        self.frame = engine.first
        self.playing = False
        self.lookers = 0
        self.ended = False
        self.version = 1
        self.changed = threading.Condition()
        self._commands = threading.Lock()  # answers are shown in the order of the commands
        self.thread = threading.Thread(target=self._play, daemon=True)
        self.thread.start()

    def state(self):
        """Returns what a page shows."""
        return {**self.frame, "playing": self.playing, "keys": self.keys,
                "stiffness_n_m": self.stiffness}

    def _show(self, frame):
        with self.changed:
            self.frame = frame
            self.keys = frame.get("keys", self.keys)
            if frame["failed"]:
                self.playing = False
            self.version += 1
            self.changed.notify_all()

    def do(self, command):
        """Executes a command of a page. Returns {} or {"refused": reason}."""
        what = command.get("do")
        if what == "run" and self.frame["failed"]:
            return {"refused": "the run has failed; restart it"}
        if what in ("run", "pause"):
            with self.changed:
                self.playing = what == "run"
                self.version += 1
                self.changed.notify_all()
            return {}
        if what in ("step", "restart"):
            with self.changed:
                self.playing = False
        return self._ask(command)

    def _ask(self, command):
        with self._commands:
            answer = self.engine.ask(command)
            if "refused" in answer:
                return answer
            self._show(answer)
        return {}

    def _play(self):
        while True:
            with self.changed:
                # Without a page that looks, nothing runs.
                while not self.ended and not (self.playing and self.lookers > 0):
                    self.changed.wait()
                if self.ended:
                    return
            began = time.monotonic()
            before = self._time()
            dt = self.frame["picture"]["dt_s"] or PICTURE_S
            steps = max(1, round(PICTURE_S / dt))
            try:
                self._ask({"do": "step", "steps": min(steps, ALL_STEPS), "within_s": PICTURE_S})
            except ConnectionError as error:
                if not self.ended:
                    self._show({**self.frame, "failed": str(error)})
            # A simulation faster than time waits for it; commands come in between.
            time.sleep(max(0.001, self._time() - before - (time.monotonic() - began)))

    def _time(self):
        return self.frame["picture"]["times_s"][0]

    def look(self, seen, wait_s):
        """Waits for a version other than the one that was seen. Returns it and the state, or
        the same version and None."""
        with self.changed:
            self.changed.wait_for(lambda: self.ended or self.version != seen, wait_s)
            if self.ended or self.version == seen:
                return seen, None
            return self.version, self.state()

    def add_looker(self, number):
        """Counts a page that looks, or one that does not any more (-1)."""
        with self.changed:
            self.lookers += number
            self.changed.notify_all()

    def end(self):
        """Ends the run and its program."""
        with self.changed:
            self.ended = True
            self.changed.notify_all()
        self.engine.end()
