"""`verify` and `python -m verify`."""

import sys


def main() -> None:
    """Run the command line; an interrupt during the imports has the exit status of any other."""
    try:
        from verify.cli import main as run

        run()
    except KeyboardInterrupt:
        sys.stderr.write("verify: interrupted\n")
        sys.exit(130)


if __name__ == "__main__":
    main()
