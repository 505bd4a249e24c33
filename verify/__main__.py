"""`verify` and `python -m verify`: an interrupt is answered from the first import on."""

import sys

TYPE_CHECKING = False  # as in the package
if TYPE_CHECKING:
    from typing import NoReturn


def main() -> "NoReturn":
    """Run the command line; end quietly where it is interrupted before it is ready to answer."""
    try:
        from verify.cli import main as run

        run()
    except KeyboardInterrupt:
        sys.stderr.write("verify: interrupted; nothing half-written is left\n")
        sys.exit(130)


if __name__ == "__main__":
    main()
