"""The server of the live view. It listens on the loopback address only. Its address holds a
random token, and requests that name another host are refused (DNS rebinding)."""

import hmac
import json
import re
import secrets
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

LOOPBACK = "127.0.0.1"
MOST_BYTES = 65536  # of a command
ALIVE_S = 10  # after which a silent page is sent a comment: a closed one is then noticed


class Server(ThreadingHTTPServer):
    """Serves one page, its pictures as server-sent events, and its commands."""

    daemon_threads = True

    def __init__(self, session, page, port=0):
        super().__init__((LOOPBACK, port), _Handler)
        self.session = session
        self.page = page
        self.token = secrets.token_urlsafe(24)
        number = self.server_address[1]
        self.hosts = (f"{LOOPBACK}:{number}", f"localhost:{number}")
        self.address = f"http://{LOOPBACK}:{number}/{self.token}/"

    def handle_error(self, request, client_address):
        """A page that was closed is no error."""


class _Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    timeout = 60

    def log_message(self, format, *args):  # noqa: A002
        """Prints nothing."""

    def _admitted(self):
        """Returns the path after the token; None, with an answer, if the request is refused."""
        host = self.headers.get("Host", "")
        origin = self.headers.get("Origin")
        token, _, path = self.path.lstrip("/").partition("/")
        known = hmac.compare_digest(token.encode(), self.server.token.encode())
        own = host in self.server.hosts and (origin is None or origin == f"http://{host}")
        if known and own:
            return path
        self.close_connection = True
        self._answer(HTTPStatus.FORBIDDEN, b"open the address that ./tress play printed\n",
                     "text/plain")
        return None

    def _answer(self, status, body, kind):
        self.send_response(status)
        self.send_header("Content-Type", f"{kind}; charset=utf-8")
        self.send_header("Content-Length", str(len(body)))
        self._guard_headers()
        self.end_headers()
        self.wfile.write(body)

    def _guard_headers(self):
        self.send_header("Cache-Control", "no-store")
        self.send_header("X-Content-Type-Options", "nosniff")
        self.send_header("Referrer-Policy", "no-referrer")

    def do_GET(self):  # noqa: N802
        """Answers with the page, or with the pictures."""
        path = self._admitted()
        if path == "":
            self._answer(HTTPStatus.OK, self.server.page, "text/html")
        elif path == "events":
            self._send_pictures()
        elif path is not None:
            self._answer(HTTPStatus.NOT_FOUND, b"no such page\n", "text/plain")

    def _send_pictures(self):
        session = self.server.session
        self.send_response(HTTPStatus.OK)
        self.send_header("Content-Type", "text/event-stream")
        self.send_header("Connection", "close")
        self._guard_headers()
        self.end_headers()
        self.close_connection = True
        session.add_looker(1)
        seen = 0
        try:
            while not session.ended:
                seen, state = session.look(seen, ALIVE_S)
                text = ": alive" if state is None else f"data: {json.dumps(state)}"
                self.wfile.write(f"{text}\n\n".encode())
        except OSError:
            pass  # the page was closed
        finally:
            session.add_looker(-1)

    def do_POST(self):  # noqa: N802
        """Executes a command."""
        path = self._admitted()
        if path is None:
            return
        length = self.headers.get("Content-Length", "")
        kind = self.headers.get("Content-Type", "").partition(";")[0]
        if (path != "command" or kind != "application/json" or not re.fullmatch("[0-9]+", length)
                or int(length) > MOST_BYTES):
            self.close_connection = True
            self._answer(HTTPStatus.BAD_REQUEST, b"no such command\n", "text/plain")
            return
        try:
            command = json.loads(self.rfile.read(int(length)))
            if not isinstance(command, dict):
                raise ValueError
            answer = self.server.session.do(command)
        except (ValueError, RecursionError):
            answer = {"refused": "the command is no JSON object"}
        except ConnectionError as error:
            answer = {"refused": str(error)}
        self._answer(HTTPStatus.OK, json.dumps(answer).encode(), "application/json")
