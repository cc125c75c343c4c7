"""The program that steps a scene: commands to it, a line each, and its answers."""

import json
import subprocess
import threading

from ..messages import Ended

END_S = 2.0  # a step under way may last; then the program is killed


class Engine:
    """simulate --live as a process. Ends with its exit code if it refuses the scene."""

    def __init__(self, command):
        # Of its own session: Ctrl-C reaches the server, which ends it.
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        text=True, start_new_session=True)
        self._turn = threading.Lock()
        try:
            first = self.process.stdout.readline()
            if not first:
                raise Ended(self.process.wait())
            self.first = json.loads(first)
        except BaseException:
            self.end()
            raise

    def ask(self, command):
        """Returns the answer to a command. Raises ConnectionError if the program has ended."""
        with self._turn:
            try:
                self.process.stdin.write(json.dumps(command) + "\n")
                self.process.stdin.flush()
                line = self.process.stdout.readline()
            except (OSError, ValueError):
                line = ""
        if not line:
            raise ConnectionError("the simulation program has ended; start ./tress play again")
        return json.loads(line)

    def end(self):
        """Ends the program."""
        self.process.terminate()
        try:
            self.process.wait(END_S)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
