"""Processes that end as they should: with their parent, and in one line on Ctrl-C during their imports.

===========  =======================================================================================
room         responsibility
===========  =======================================================================================
``guard``    Ctrl-C while the command line is imported; nothing else is imported before it
``workers``  processes that end with their parent, and leave Ctrl-C to it
===========  =======================================================================================
"""

from ehlcontact.process import guard as guard
