"""How a command ends: at once, with everything said and everything done that asked for it."""

import os
import subprocess
import sys

CODE = """
import atexit, sys
sys.argv = ["verify", "quantities", "--json"]
atexit.register(lambda: print("asked to be done at the end"))
class Left:
    def __del__(self):
        print("taken down")
left = Left()
from verify.__main__ import main
main()
"""


def run():
    command = [sys.executable, "-c", CODE]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_what_was_registered_is_done_and_all_is_written_but_nothing_is_taken_down():
    done = run()
    assert (done.returncode, done.stderr) == (0, "")
    assert len(done.stdout) > 2**16  # more than a pipe holds at once
    assert done.stdout.endswith("]\nasked to be done at the end\n")


def test_a_profiler_gets_the_long_way_and_writes_down_what_it_saw(tmp_path):
    seen = tmp_path / "seen.prof"
    command = [sys.executable, "-m", "cProfile", "-o", str(seen), "-m", "verify", "scenes"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0
    assert seen.stat().st_size > 1000


def test_what_no_longer_can_be_written_at_the_end_is_let_go():
    """The reader leaves between the last word of the command and its end."""
    code = "import atexit, os\nread, write = os.pipe()\nos.dup2(write, 1)\nos.close(read)\nos.close(write)\n"
    buffered = {key: value for key, value in os.environ.items() if key != "PYTHONUNBUFFERED"}
    code += "from verify import cli\ncli.status_of = lambda: print('late') or 3\ncli.main()\n"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, env=buffered)
    assert (done.returncode, done.stderr) == (3, "")
