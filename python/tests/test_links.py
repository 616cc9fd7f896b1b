"""Links to other sites: the list that CI asks every night is that of the pages. No test needs a network."""

import sys
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from urllib.parse import urlsplit

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tools"))

from links import listed, missing, named  # noqa: E402


def test_the_list_has_each_link_of_the_pages_once() -> None:
    links = listed()
    assert set(links) == named(), "write docs/links.txt again"
    assert links == sorted(links)
    # With and without a stroke at the end it would be the same page.
    assert len({link.rstrip("/").lower() for link in links}) == len(links)


def test_links_have_the_form_of_a_public_page() -> None:
    for link in listed():
        parts = urlsplit(link)
        assert parts.scheme == "https", link
        assert parts.hostname and "." in parts.hostname and parts.netloc == parts.hostname, f"{link}: a host in lower case, without port or user"
        assert not parts.query, f"{link}: a query does not last"


class Site(BaseHTTPRequestHandler):
    """Has one page, and one that has moved."""

    def do_GET(self) -> None:
        self.send_response({"/there": 200, "/moved": 301}.get(self.path, 404))
        if self.path == "/moved":
            self.send_header("Location", "/there")
        self.end_headers()

    def log_message(self, *_: object) -> None:
        """Say nothing."""


@pytest.fixture
def site() -> Iterator[str]:
    with HTTPServer(("127.0.0.1", 0), Site) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()


def test_a_page_that_is_gone_is_told(site: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("no_proxy", "*")
    assert missing([f"{site}/there", f"{site}/moved"]) == {}
    told = missing([f"{site}/gone", f"{site}/there"])
    assert list(told) == [f"{site}/gone"] and "404" in told[f"{site}/gone"]
    site_of_nobody = "http://127.0.0.1:1/"
    assert list(missing([site_of_nobody], seconds=1)) == [site_of_nobody]
