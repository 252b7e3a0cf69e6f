"""Processes: how they end, and how many threads they use.

===========  =======================================================================================
room         responsibility
===========  =======================================================================================
``guard``    Ctrl-C while the command line is imported; nothing else is imported before it
``workers``  processes that end with their parent, and leave Ctrl-C to it
``threads``  `Team`: threads that share the loops of a solve; how many there are by default
``blas``     BLAS on one thread while we solve
``memory``   how much memory may still be taken
===========  =======================================================================================
"""

from ehlcontact.process import guard as guard
