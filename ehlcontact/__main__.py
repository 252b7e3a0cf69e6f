"""``python -m ehlcontact``: the command line."""

from ehlcontact.cli import main

if __name__ == "__main__":
    main()
