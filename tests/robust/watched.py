"""Command lines run where nothing is lost: what they said, what they left behind, and what is wrong with that."""

import contextlib
import csv
import io
import json
import os
import re
import signal
import sys
import traceback
import warnings
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time

from msgspec import Struct

from verify.cli import status_of

LIMIT_S = 40
"""Processor seconds: twice what is begun without an estimate, since the first to step something compiles it."""
LONGEST = 4000
"""Characters of an error stream with one sentence; each further one has 300 more."""
TIMES = re.compile(r"[-+]?\d[\d.e+-]*\s*(?:ns|µs|us|ms|s|minutes|min)\b")
TIMED = re.compile(
    r"(?:seconds|_s$|_ms(?:_|$)|time|date|_spread$|^sentences$|^rounds$|^order$|^left_out$|^moved$|^load$)"
)
"""Names of what times go into; the sentences of a bench are all about them, its rounds
end with them, and what is left out for want of them leaves the next row another order."""
KEPT = re.compile(r"\d{4}-\d\d-\d\d_\d\d-\d\d-\d\d(?:-\d+)?")
"""The folder of a run."""
TELLS_TIMES = ("run", "table", "choose")
"""Commands whose tables have times below a head alone: of their words for a person no digits are compared."""


class TooLongError(BaseException):
    """The alarm."""


class Said(Struct):
    """What a command line came to."""

    status: int | None
    out: str
    err: str
    files: dict[str, bytes]
    thrown: str = ""


def said_by(line):
    """Run a line in a folder of its own."""
    home = os.getcwd()
    with TemporaryDirectory(prefix="line-") as name:
        folder = Path(name)
        for path, data in line.files.items():
            (folder / path).write_bytes(data)
        os.chdir(folder)
        try:
            return _called(line.words, folder)
        finally:
            os.chdir(home)


def _called(words, folder):
    out, err, thrown, status = io.StringIO(), io.StringIO(), "", None
    before = signal.signal(signal.SIGPROF, _too_long)
    try:
        with warnings.catch_warnings(), contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            warnings.simplefilter("error")
            signal.setitimer(signal.ITIMER_PROF, LIMIT_S)
            status = status_of(words)
    except BaseException as error:
        thrown = f"{type(error).__name__}: {str(error)[:200]} at {_where(error)}"
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
    files = {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    return Said(status, out.getvalue(), err.getvalue(), files, thrown)


def _too_long(number, frame):
    raise TooLongError(f"more than {LIMIT_S} s")


def _where(error):
    frames = [one for one in traceback.extract_tb(error.__traceback__) if f"{os.sep}verify{os.sep}" in one.filename]
    return " < ".join(f"{Path(one.filename).name}:{one.lineno}" for one in frames[:-4:-1])


def faults(line, said):
    """A sentence for each thing that is wrong."""
    if said.thrown:
        return [f"it ends in {said.thrown}"]
    checks = (_status, _refusal, _streams, _data, _left_behind)
    return [fault for check in checks for fault in check(line, said)]


def _status(line, said):
    if said.status not in (0, 1, 2):
        yield f"its status is {said.status}"


def _refusal(line, said):
    if said.status != 2:
        return
    lines = said.err.splitlines()
    if lines and lines[0].startswith(("Usage: ", "Error: ")):
        return
    if said.out and "could not run" not in said.out and '"error": [' not in said.out:  # of several scenes one
        yield f"refused, and yet it prints {said.out[:80]!r}"
    if not lines or not all(one.startswith("verify: ") for one in lines):
        yield f"refused without a sentence: {said.err[:200]!r}"
    if len(said.err) > LONGEST + 300 * len(lines):
        yield f"refused in {len(said.err)} characters"


def _streams(line, said):
    for text in (said.out, said.err):
        if "Traceback (most recent call last)" in text:
            yield f"a traceback is printed: {text[-200:]!r}"
        if "the suite itself fails" in text:
            yield f"a gate fails by itself: {text[text.find('the suite itself') :][:300]!r}"
        if raw := [c for c in text if not c.isprintable() and c not in "\n\t" and not _of_the_file(line, c)]:
            yield f"the terminal is sent {raw[0]!r}"
    if line.words[0] not in ("quantities", "show", "compare") and said.status in (0, 1) and "--json" not in line.words:
        for told in re.findall(r"[^\n]*(?<![\w.])(?:nan|inf)(?!\w)[^\n]*", said.out):
            given = any(f'"{told.strip()}"'.encode() in data for data in line.files.values())  # a title, for one
            if not given and not told.startswith(
                ("report: ", "kept: ", "gate ", "cannot run: ")
            ):  # which show what was given
                yield f"a figure is no number: {told[:150]!r}"


def _of_the_file(line, character):
    """Whether `show` prints it as it stands in a file."""
    return line.words[0] == "show" and any(
        character.encode("utf-8", "surrogatepass") in one for one in line.files.values()
    )


def _data(line, said):
    if said.status not in (0, 1) or not _asks_for_json(line.words):
        return
    try:
        json.loads(said.out, parse_constant=_no_number)
    except ValueError as error:
        yield f"no strict JSON: {error}: {said.out[:80]!r}"


def _asks_for_json(words):
    """Whether --json stands where it is an option, and nothing else is asked for."""
    values = {
        words[i + 1] for i, word in enumerate(words[:-1]) if word in ("--reports", "--set", "--from", "--modes", "--to")
    }
    return "--json" in {*words} - values and not {"--help", "-h", "--version", "--csv", "--markdown"} & {*words}


def _no_number(word):
    raise ValueError(f"{word} is no number of JSON")


def _left_behind(line, said):
    for name, data in said.files.items():
        if name.endswith(".part") or name.startswith("tmp"):
            yield f"{name} is left behind"
        if name.endswith(".html") and not data.rstrip().endswith(b"</html>"):
            yield f"{name} is half a page"
    for name, data in line.files.items():
        if said.files.get(name) != data and "--force" not in line.words:
            yield f"its own {name} is changed"


def differences(line, first, second):
    """What a second run of the same line says otherwise, but for times."""
    if first.status != second.status:
        yield f"status {first.status}, then {second.status}: {second.err[:200]!r}"
        return
    told = line.words[0] in TELLS_TIMES
    for one, other in ((first.out, second.out), (first.err, second.err)):
        if (one := timeless(one, told)) != (other := timeless(other, told)):
            yield f"it says otherwise the second time: {_first_apart(one, other)}"
    names = [sorted(KEPT.sub("TIME", name) for name in said.files) for said in (first, second)]
    if names[0] != names[1]:
        yield f"files {names[0]}, then {names[1]}"


def timeless(text, told=False):
    """A text without the times in it: of data and columns by their names, of words by their units or all digits."""
    try:
        return json.dumps(_without_times(json.loads(text)))
    except ValueError:
        pass
    first = text.partition("\n")[0]
    for mark in ("|", ","):
        timed = {i for i, head in enumerate(first.split(mark)) if TIMED.search(head.strip())}
        if timed and mark in first:
            quoting = csv.QUOTE_MINIMAL if mark == "," else csv.QUOTE_NONE
            rows = csv.reader(io.StringIO(text, newline=""), delimiter=mark, quoting=quoting)
            return "\n".join(mark.join(cell for i, cell in enumerate(row) if i not in timed) for row in rows)
    plain = TIMES.sub("TIME", text)
    plain = re.sub(r"[-+]?\d[-+\d.e]*|–", "#", plain) if told else plain
    words = plain.replace("─", "").split()
    return " ".join(sorted(one for one in words if "#" not in one) if told else words)  # widths go with digits


def _without_times(data):
    if isinstance(data, dict):
        return {name: _without_times(value) for name, value in data.items() if not TIMED.search(name)}
    return [_without_times(one) for one in data] if isinstance(data, list) else data


def _first_apart(one, other):
    at = next((i for i, (a, b) in enumerate(zip(one, other, strict=False)) if a != b), min(len(one), len(other)))
    return f"{one[max(at - 60, 0) : at + 60]!r}, then {other[max(at - 60, 0) : at + 60]!r}"


def wrong_with(line):
    """Everything that is wrong with a line: run once, and again where it did something."""
    said = said_by(line)
    found = faults(line, said)
    if not found and said.status in (0, 1):
        again = said_by(line)
        found = [*faults(line, again), *differences(line, said, again)]
    return said, found


if __name__ == "__main__":
    from drawn_lines import drawn_line

    first, last = int(sys.argv[1]), int(sys.argv[2])
    for seed in range(first, last):
        line, begun = drawn_line(seed), process_time()
        said, found = wrong_with(line)
        took = round(process_time() - begun, 3)
        record = {
            "seed": seed,
            "status": said.status,
            "command": line.words[0],
            "took": took,
            "err": said.err[:150],
            "faults": found,
        }
        print(json.dumps(record), flush=True)
