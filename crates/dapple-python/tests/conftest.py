"""With `DAPPLE_NO_SKIP=1`, as our CI sets it, tests that are skipped fail, but for those that this list names."""

from __future__ import annotations

import os
import sys

import pytest

#: What may be skipped everywhere: parts of a file's name or of a test's, and of the reason.
ALLOWED = [
    ("test_blender.py", "bpy"),
    ("[blender]", "bpy"),
    ("[augmentation]", "torch"),
    ("test_bytes_are_those_of_the_command", "does not copy such files"),
    ("", "the command dapple is not on PATH"),
    ("", "the system has no fork"),
]


def is_allowed(name: str, reason: str) -> bool:
    """Whether a test may be skipped for this reason."""
    return any(part in name and why in reason for part, why in ALLOWED)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    report = yield
    fail_if_skipped(report)
    return report


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(collector):
    report = yield
    fail_if_skipped(report)
    return report


def fail_if_skipped(report):
    if not report.skipped or hasattr(report, "wasxfail") or os.environ.get("DAPPLE_NO_SKIP") != "1":
        return
    reason = str(report.longrepr[2])
    if not is_allowed(report.nodeid, reason):
        report.outcome = "failed"
        report.longrepr = f"{reason}: DAPPLE_NO_SKIP=1 lets nothing be skipped that conftest.py does not name"


def pytest_sessionfinish(session, exitstatus):
    session.config.status = exitstatus


def pytest_unconfigure(config):
    # Blender frees its memory after its threads are gone, and has been seen to wait for them for ever.
    if "bpy" in sys.modules:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(int(getattr(config, "status", 1)))
