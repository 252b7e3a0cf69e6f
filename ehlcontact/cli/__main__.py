"""``python -m ehlcontact.cli``."""

from ehlcontact.cli import main

main()
